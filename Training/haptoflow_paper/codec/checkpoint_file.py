"""Reads weights from untrusted files: no code is unpickled, every name and shape is checked."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import torch
from torch import Tensor, nn

from haptoflow_paper.codec.state_dict_file import StateDictError, read_state
from haptoflow_training.errors import InputError

_NAMES_SHOWN = 5
_MINIMUM_DIGEST_DIGITS = 8
_CHUNK_BYTES = 1 << 20


def verify_sha256(path: Path, expected: str) -> None:
    """Compare a file with a SHA-256 (64 hexadecimal digits, or the first 8 or more); InputError if they differ."""
    wanted = expected.strip().lower()
    if not re.fullmatch(rf"[0-9a-f]{{{_MINIMUM_DIGEST_DIGITS},64}}", wanted):
        raise InputError(
            f"sha256 '{expected}' for {path}: expected 64 hexadecimal digits, or at least the first "
            f"{_MINIMUM_DIGEST_DIGITS}"
        )
    digest = hashlib.sha256()
    with path.open("rb") as file:
        while chunk := file.read(_CHUNK_BYTES):
            digest.update(chunk)
    if not digest.hexdigest().startswith(wanted):
        raise InputError(
            f"{path}: SHA-256 is {digest.hexdigest()}, expected {wanted}; "
            "fetch the file again or correct sha256"
        )


def read_tensors(path: Path, sha256: str | None = None) -> dict[str, Any]:
    """A file of torch.save as a dict on the CPU; InputError if absent, damaged, or holding other objects."""
    if not path.is_file():
        raise InputError(f"{path}: no such file, expected a PyTorch checkpoint")
    if sha256 is not None:
        verify_sha256(path, sha256)
    try:
        content = read_state(path.read_bytes())
    except (StateDictError, OSError) as error:
        raise InputError(
            f"{path}: not a PyTorch checkpoint of tensors, whole numbers and text alone, or damaged ({error}); "
            "expected a state dict that torch.save wrote"
        ) from error
    if not isinstance(content, Mapping):
        raise InputError(f"{path}: holds a {type(content).__name__}, expected a dict of tensors")
    return dict(content)


def _listed(names: list[str]) -> str:
    shown = ", ".join(names[:_NAMES_SHOWN])
    return shown if len(names) <= _NAMES_SHOWN else f"{shown} and {len(names) - _NAMES_SHOWN} more"


def load_state(module: nn.Module, state: Mapping[str, Any], path: Path) -> None:
    """Load `state` into `module` if names and shapes agree; else InputError, and the module is unchanged."""
    expected = module.state_dict()
    missing = sorted(expected.keys() - state.keys())
    unexpected = sorted(state.keys() - expected.keys())
    shapes = [
        f"{name} {_shape_of(state[name])} instead of {list(expected[name].shape)}"
        for name in sorted(expected.keys() & state.keys())
        if _shape_of(state[name]) != list(expected[name].shape)
    ]
    complaints = [
        f"{title}: {_listed(names)}"
        for title, names in (("missing", missing), ("unexpected", unexpected), ("of another shape", shapes))
        if names
    ]
    if complaints:
        raise InputError(f"{path}: not the weights of this network; {'; '.join(complaints)}")
    not_finite = [name for name in sorted(expected) if not bool(torch.isfinite(state[name]).all())]
    if not_finite:
        raise InputError(f"{path}: not a finite number in {_listed(not_finite)}; the file is damaged")
    module.load_state_dict(dict(state))


def _shape_of(value: Any) -> list[int] | str:
    return list(value.shape) if isinstance(value, Tensor) else type(value).__name__
