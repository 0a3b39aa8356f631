"""Reads a .safetensors file, written from the description of the format.

Source: github.com/huggingface/safetensors, README, section "Format": 8 bytes of unsigned little-endian length, as many
bytes of JSON {name: {"dtype", "shape", "data_offsets": [begin, end]}} with an optional "__metadata__", then the bytes
of all tensors without holes, row-major and little-endian.
"""

from __future__ import annotations

import json
import math
import struct
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import torch
from torch import Tensor

from haptoflow_training.errors import InputError

_LENGTH = struct.Struct("<Q")
# The description's own limit.
_MAXIMUM_HEADER_BYTES = 100_000_000
_FLOAT_BYTES = 4
_AGAIN = "fetch the file again"


def read_safetensors(path: Path) -> dict[str, Tensor]:
    """Every tensor of a file in the file's order, float32 on the CPU.

    Raises InputError naming file and tensor if the file is absent, cut off, not of this format, holds another type
    than F32 or a number that is not finite, or if tensors overlap, leave holes or end outside the file.
    """
    try:
        content = path.read_bytes()
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror}); expected a .safetensors file") from error
    header, data = _split(path, content)
    entries = {name: _entry(path, name, entry) for name, entry in header.items() if name != "__metadata__"}
    if not entries:
        raise InputError(f"{path}: holds no tensor; expected the weights of a model")
    _require_without_holes(path, entries, len(data))
    return {name: _tensor(path, name, entry, data) for name, entry in entries.items()}


def _split(path: Path, content: bytes) -> tuple[dict[str, Any], memoryview]:
    if len(content) < _LENGTH.size:
        raise InputError(f"{path}: {len(content)} bytes, cut off before the header; {_AGAIN}")
    (length,) = _LENGTH.unpack_from(content)
    end = _LENGTH.size + length
    if length > _MAXIMUM_HEADER_BYTES or not content[_LENGTH.size : _LENGTH.size + 1] == b"{":
        raise InputError(f"{path}: not a .safetensors file, which begins with the length of a JSON header")
    if end > len(content):
        raise InputError(f"{path}: cut off in its header of {length} bytes; {_AGAIN}")
    try:
        header = json.loads(content[_LENGTH.size : end].decode("utf-8"), object_pairs_hook=_without_repeats)
    except (ValueError, RecursionError) as error:
        raise InputError(f"{path}: its header is not valid JSON ({error}); {_AGAIN}") from error
    return header, memoryview(content)[end:]


def _without_repeats(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) != len(pairs):
        raise ValueError("a name occurs twice")
    return found


def _entry(path: Path, name: str, entry: Any) -> tuple[tuple[int, ...], int, int]:
    """Shape, first byte and the byte after the last one, relative to the data."""
    if not isinstance(entry, Mapping) or not {"dtype", "shape", "data_offsets"} <= entry.keys():
        raise InputError(f"{path}: tensor '{name}' is {entry!r}; expected dtype, shape and data_offsets")
    shape, offsets = entry["shape"], entry["data_offsets"]
    if entry["dtype"] != "F32":
        raise InputError(f"{path}: tensor '{name}' has the dtype {entry['dtype']!r}; expected F32")
    if not _are_counts(shape) or not _are_counts(offsets) or len(offsets) != 2:
        raise InputError(
            f"{path}: tensor '{name}' has the shape {shape!r} and the offsets {offsets!r}; expected whole numbers"
        )
    begin, end = offsets
    if end - begin != _FLOAT_BYTES * math.prod(shape):
        raise InputError(
            f"{path}: tensor '{name}' has {end - begin} bytes; expected {_FLOAT_BYTES * math.prod(shape)} for {shape}"
        )
    return tuple(shape), begin, end


def _are_counts(values: Any) -> bool:
    return isinstance(values, list) and all(type(value) is int and value >= 0 for value in values)


def _require_without_holes(path: Path, entries: Mapping[str, tuple[tuple[int, ...], int, int]], size: int) -> None:
    reached, before = 0, "the header"
    for name, (_, begin, end) in sorted(entries.items(), key=lambda item: item[1][1:]):
        if begin != reached:
            relation = "overlaps" if begin < reached else "leaves a hole after"
            raise InputError(f"{path}: tensor '{name}' begins at byte {begin} and {relation} {before}; {_AGAIN}")
        if end > size:
            raise InputError(f"{path}: cut off in tensor '{name}', which ends at byte {end} of {size}; {_AGAIN}")
        reached, before = end, f"tensor '{name}'"
    if reached != size:
        raise InputError(f"{path}: {size - reached} bytes after the last tensor; expected none")


def _tensor(path: Path, name: str, entry: tuple[tuple[int, ...], int, int], data: memoryview) -> Tensor:
    shape, begin, end = entry
    values = np.frombuffer(data[begin:end], dtype="<f4").astype(np.float32).reshape(shape)
    if not np.isfinite(values).all():
        raise InputError(f"{path}: tensor '{name}' holds a number that is not finite; {_AGAIN}")
    return torch.from_numpy(values)
