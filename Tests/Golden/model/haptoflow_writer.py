"""Writes a `.haptoflow` file from its parts: a second reading of Documentation~/model-format.md that shares
no code with the reader or with the training's export."""

from __future__ import annotations

import json
import struct
import zlib
from pathlib import Path

import numpy as np

ALIGNMENT = 64
PREFIX_BYTES = 32


def _aligned(offset: int) -> int:
    return -(-offset // ALIGNMENT) * ALIGNMENT


def _describe(content: bytes | np.ndarray) -> tuple[str, list[int], bytes]:
    if isinstance(content, bytes):
        return "onnx", [], content
    return "float32", list(content.shape), content.astype("<f4").tobytes()


def write_model(path: Path, header: dict, blobs: dict[str, bytes | np.ndarray]) -> None:
    """`blobs`: ONNX graphs as bytes, tensors as arrays. Offsets in the header depend on the header's own
    length, which is therefore laid out until it stands still."""
    header_end = PREFIX_BYTES + ALIGNMENT
    while True:
        entries = []
        end = header_end
        for name, content in blobs.items():
            kind, shape, raw = _describe(content)
            offset = _aligned(end)
            entries.append({"name": name, "type": kind, "shape": shape, "offset": offset, "bytes": len(raw),
                            "crc32": zlib.crc32(raw)})
            end = offset + len(raw)
        text = json.dumps({**header, "blobs": entries}, ensure_ascii=False).encode("utf-8")
        needed = _aligned(PREFIX_BYTES + len(text))
        if needed <= header_end:
            break
        header_end = needed

    text = text.ljust(header_end - PREFIX_BYTES, b" ")
    prefix = b"HAPTFLOW" + struct.pack("<IIQI", 2, len(text), end, zlib.crc32(text))
    file = bytearray(prefix + struct.pack("<I", zlib.crc32(prefix)) + text)
    for entry, content in zip(entries, blobs.values()):
        file += bytes(entry["offset"] - len(file))
        file += _describe(content)[2]
    path.write_bytes(bytes(file))
