"""Reads weights from untrusted files: no code is unpickled, every name and shape is checked."""

from __future__ import annotations

import hashlib
import io
import math
import pickle
import re
import struct
import zipfile
from collections import OrderedDict
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, BinaryIO

import torch
from torch import Tensor, nn

from haptoflow_training.errors import InputError

_LEGACY_MAGIC = 0x1950A86A20F9469CFC6C
_LEGACY_PROTOCOL = 1001
_ELEMENT_COUNT = struct.Struct("<q")
_DTYPES = {
    "FloatStorage": torch.float32,
    "DoubleStorage": torch.float64,
    "HalfStorage": torch.float16,
    "BFloat16Storage": torch.bfloat16,
    "LongStorage": torch.int64,
    "IntStorage": torch.int32,
    "ShortStorage": torch.int16,
    "CharStorage": torch.int8,
    "ByteStorage": torch.uint8,
    "BoolStorage": torch.bool,
}
# What a damaged pickle or archive raises on its way.
_DAMAGE = (
    AttributeError, EOFError, IndexError, KeyError, OverflowError, RecursionError, RuntimeError, TypeError, ValueError,
    pickle.UnpicklingError, struct.error, zipfile.BadZipFile,
)


class StateDictError(Exception):
    """The file is damaged, or is no plain state dict; the message says which."""


@dataclass
class _Storage:
    """The numbers of one or more tensors; `data` arrives after the pickle that refers to it."""

    dtype: torch.dtype
    count: int
    data: Tensor | None = None

    def fill(self, content: bytes) -> None:
        size = torch.empty(0, dtype=self.dtype).element_size()
        if len(content) != self.count * size:
            raise StateDictError(f"a storage has {len(content)} bytes, expected {self.count * size}")
        empty = torch.empty(0, dtype=self.dtype)
        self.data = torch.frombuffer(bytearray(content), dtype=self.dtype) if content else empty


@dataclass(frozen=True)
class _View:
    """A tensor of a storage; sizes and strides in elements."""

    storage: _Storage
    offset: int
    shape: tuple[int, ...]
    strides: tuple[int, ...]

    def tensor(self) -> Tensor:
        data = self.storage.data
        numbers = (self.offset, *self.shape, *self.strides)
        if data is None or len(self.shape) != len(self.strides) or any(type(n) is not int or n < 0 for n in numbers):
            raise StateDictError("a tensor has no storage or an impossible shape")
        last = self.offset + sum((size - 1) * stride for size, stride in zip(self.shape, self.strides, strict=True))
        # Strides of 0 could make a tensor of any size from one number.
        if 0 not in self.shape and (last >= len(data) or math.prod(self.shape) > len(data)):
            raise StateDictError(
                f"a tensor of shape {list(self.shape)} ends outside its storage of {len(data)} numbers"
            )
        return data.as_strided(self.shape, self.strides, self.offset).clone()


def _viewed(storage: _Storage, offset: int, shape: Any, strides: Any) -> _View:
    return _View(storage, offset, tuple(shape), tuple(strides))


class _Names(pickle.Unpickler):
    """Unpickles containers, numbers and text; tensors become views of storages, which `storages` collects by key."""

    def __init__(self, file: BinaryIO, storages: dict[str, _Storage]) -> None:
        super().__init__(file, encoding="utf-8")
        self._storages = storages

    def find_class(self, module: str, name: str) -> Any:
        # Functions of this call alone: a pickle may set attributes of what it gets.
        known: dict[tuple[str, str], Callable[..., Any]] = {
            ("collections", "OrderedDict"): OrderedDict,
            ("torch", "Size"): lambda sizes: tuple(sizes),
            ("torch._utils", "_rebuild_tensor"): lambda *given: _viewed(*given[:4]),
            ("torch._utils", "_rebuild_tensor_v2"): lambda *given: _viewed(*given[:4]),
            ("torch._utils", "_rebuild_parameter"): lambda *given: given[0],
        }
        if module == "torch" and name in _DTYPES:
            return _DTYPES[name]
        if (module, name) not in known:
            raise StateDictError(f"its pickle names {module}.{name}, which no state dict needs; nothing of it was run")
        return known[module, name]

    def persistent_load(self, pid: Any) -> _Storage:
        kind, dtype, key, _, count = pid[:5]
        if kind != "storage" or not isinstance(dtype, torch.dtype) or type(count) is not int or count < 0:
            raise StateDictError("a storage is described in an unknown way")
        if len(pid) > 5 and pid[5] is not None:
            raise StateDictError("a storage is a part of another one, which torch.save writes no more")
        return self._storages.setdefault(str(key), _Storage(dtype, count))


def read_state(content: bytes) -> Any:
    """The object in a file of torch.save, in the zip form or the one before it, with tensors on the CPU.

    Raises StateDictError.
    """
    try:
        storages: dict[str, _Storage] = {}
        if content.startswith(b"PK"):
            found = _from_archive(content, storages)
        else:
            found = _from_legacy(io.BytesIO(content), storages)
        return _with_tensors(found)
    except _DAMAGE as error:
        raise StateDictError("damaged, or not a file of torch.save") from error


def _from_archive(content: bytes, storages: dict[str, _Storage]) -> Any:
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        names = [name for name in archive.namelist() if name.endswith("data.pkl")]
        if len(names) != 1 or any("/code/" in name for name in archive.namelist()):
            raise StateDictError("its archive holds a program (TorchScript) or no data.pkl")
        # Stored without compression, so that no part is larger than the file.
        if any(entry.compress_type != zipfile.ZIP_STORED for entry in archive.infolist()):
            raise StateDictError("its archive is compressed, which torch.save's is not")
        folder = names[0][: -len("data.pkl")]
        found = _Names(io.BytesIO(archive.read(names[0])), storages).load()
        for key, storage in storages.items():
            storage.fill(archive.read(f"{folder}data/{key}"))
    return found


def _from_legacy(file: BinaryIO, storages: dict[str, _Storage]) -> Any:
    if _Names(file, {}).load() != _LEGACY_MAGIC or _Names(file, {}).load() != _LEGACY_PROTOCOL:
        raise StateDictError("not a file of torch.save")
    if _Names(file, {}).load().get("little_endian") is not True:
        raise StateDictError("not little-endian")
    found = _Names(file, storages).load()
    for key in _Names(file, {}).load():
        storage = storages[str(key)]
        if _ELEMENT_COUNT.unpack(file.read(_ELEMENT_COUNT.size)) != (storage.count,):
            raise StateDictError(f"storage {key} has another size than its description")
        storage.fill(file.read(storage.count * torch.empty(0, dtype=storage.dtype).element_size()))
    return found


def _with_tensors(value: Any) -> Any:
    if isinstance(value, _View):
        return value.tensor()
    if isinstance(value, dict):
        return {key: _with_tensors(each) for key, each in value.items()}
    if isinstance(value, (list, tuple)):
        return type(value)(_with_tensors(each) for each in value)
    return value


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
