"""Writing and reading `.haptoflow` files: Documentation~/model-format.md is the specification."""

from __future__ import annotations

import json
import struct
import zlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.errors import InputError
from haptoflow_training.whole_file import write_whole

MAGIC = b"HAPTFLOW"
VERSION = 2
ALIGNMENT = 64
_PREAMBLE = struct.Struct("<8sIIQI")
_PREAMBLE_BYTES = _PREAMBLE.size + 4


@dataclass(frozen=True)
class ModelFile:
    """header: the JSON header; tensors: float32 arrays by blob name; graphs: ONNX bytes by blob name."""

    header: dict[str, Any]
    tensors: dict[str, NDArray[np.float32]]
    graphs: dict[str, bytes]


def _aligned(offset: int) -> int:
    return -(-offset // ALIGNMENT) * ALIGNMENT


def _encode_header(header: dict[str, Any], blobs: list[tuple[dict[str, Any], bytes]]) -> tuple[bytes, list[int]]:
    """The padded header and each blob's offset. The offsets are part of the header and depend on its length, so the
    length is raised until both agree."""
    length = 0
    while True:
        offsets, position = [], _PREAMBLE_BYTES + length
        for _, content in blobs:
            position = _aligned(position)
            offsets.append(position)
            position += len(content)
        entries = [dict(entry, offset=offset) for (entry, _), offset in zip(blobs, offsets, strict=True)]
        text = json.dumps({**header, "blobs": entries}, ensure_ascii=False, allow_nan=False).encode("utf-8")
        needed = _aligned(_PREAMBLE_BYTES + len(text)) - _PREAMBLE_BYTES
        if needed <= length:
            return text.ljust(length, b" "), offsets
        length = needed


def encode_model_file(model: ModelFile) -> bytes:
    """The bytes of the file; ValueError if a tensor is not finite float32 or a header value is not JSON."""
    blobs: list[tuple[dict[str, Any], bytes]] = []
    for name, tensor in model.tensors.items():
        if tensor.dtype != np.float32 or not np.isfinite(tensor).all():
            raise ValueError(f"tensor '{name}' must be finite float32, is {tensor.dtype}")
        content = np.ascontiguousarray(tensor).astype("<f4").tobytes()
        blobs.append((_blob_entry(name, "float32", list(tensor.shape), content), content))
    for name, graph in model.graphs.items():
        blobs.append((_blob_entry(name, "onnx", [], graph), graph))

    header, offsets = _encode_header(model.header, blobs)
    total = offsets[-1] + len(blobs[-1][1]) if blobs else _PREAMBLE_BYTES + len(header)
    preamble = _PREAMBLE.pack(MAGIC, VERSION, len(header), total, zlib.crc32(header))
    parts = bytearray(preamble + struct.pack("<I", zlib.crc32(preamble)) + header)
    for offset, (_, content) in zip(offsets, blobs, strict=True):
        parts.extend(b"\0" * (offset - len(parts)))
        parts.extend(content)
    return bytes(parts)


def _blob_entry(name: str, kind: str, shape: list[int], content: bytes) -> dict[str, Any]:
    return {"name": name, "type": kind, "shape": shape, "bytes": len(content), "crc32": zlib.crc32(content)}


def write_model_file(path: Path, model: ModelFile) -> int:
    """Write the file atomically and return its CRC-32. A full disk leaves the old file unchanged."""
    content = encode_model_file(model)
    write_whole(path, content)
    return zlib.crc32(content)


def read_model_file(path: Path) -> ModelFile:
    """Read a file that this package wrote; InputError names what is damaged. Only the engine's reader validates
    untrusted files."""
    try:
        content = path.read_bytes()
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror})") from error
    if len(content) < _PREAMBLE_BYTES or content[:8] != MAGIC:
        raise InputError(f"{path}: is not a .haptoflow file")
    _, version, header_length, total, header_crc = _PREAMBLE.unpack_from(content)
    if version != VERSION:
        remedy = (
            "update HaptoFlow"
            if version > VERSION
            else "make the file again from its training run with `haptoflow-training export`"
        )
        raise InputError(f"{path}: format version {version}, expected {VERSION}: {remedy}")
    if total != len(content):
        raise InputError(f"{path}: {len(content)} bytes long, the file says {total}: truncated or damaged")
    header_bytes = content[_PREAMBLE_BYTES : _PREAMBLE_BYTES + header_length]
    if zlib.crc32(header_bytes) != header_crc:
        raise InputError(f"{path}: the header's checksum does not match: damaged")
    header = json.loads(header_bytes)
    tensors, graphs = {}, {}
    for entry in header["blobs"]:
        blob = content[entry["offset"] : entry["offset"] + entry["bytes"]]
        if len(blob) != entry["bytes"] or zlib.crc32(blob) != entry["crc32"]:
            raise InputError(f"{path}: blob '{entry['name']}' is damaged")
        if entry["type"] == "onnx":
            graphs[entry["name"]] = blob
        else:
            tensors[entry["name"]] = np.frombuffer(blob, dtype="<f4").reshape(entry["shape"])
    return ModelFile({key: value for key, value in header.items() if key != "blobs"}, tensors, graphs)


def model_space(model: ModelFile) -> str:
    """Eight hex digits that identify the networks an embedding belongs to: the CRC-32 over each tier's name and the
    CRC-32 of its field graph, in the file's order; for a skeleton, of its perceptron's last layer."""
    text = "".join(f"{tier['name']}:{_identity(model, tier):08x};" for tier in model.header["tiers"])
    return f"{zlib.crc32(text.encode('ascii')):08x}"


def _identity(model: ModelFile, tier: dict[str, Any]) -> int:
    if tier["kind"] == "skeleton":
        return zlib.crc32(np.ascontiguousarray(model.tensors["skeleton.4.weight"]).astype("<f4").tobytes())
    return zlib.crc32(model.graphs[tier["field"]])


# What a material file states beside a label's own keys.
_NOT_OF_A_LABEL = ("format", "version", "space", "name", "description", "embedding", "range", "seeds")


def with_label(model: ModelFile, material: dict[str, Any]) -> ModelFile:
    """The model with a further label at the end: an embedding row, a header entry and, if the model has a seed bank,
    seeds. material: the content of a material file. InputError if it is of another space or a label has its name."""
    name, space = material["name"], model_space(model)
    if material["space"] != space:
        raise InputError(
            f"material '{name}' was learnt for another model (space {material['space']}, the model's is {space}); learn "
            "it from its recording under this model"
        )
    require_new_name(model, name)
    rows = model.tensors["embedding"]
    label = {key: value for key, value in material.items() if key not in _NOT_OF_A_LABEL}
    header = {**model.header, "labels": [*model.header["labels"], {"name": name, "embedding_row": len(rows), **label}]}
    added: dict[str, Any] = {"embedding": [material["embedding"]]}
    if "pieces" in model.tensors:
        # One piece of the material is known: the label itself.
        added["pieces"] = np.zeros((1, *model.tensors["pieces"].shape[1:]))
    bank, seeds = model.header.get("seed_bank"), material.get("seeds", [])
    if bank is not None:
        added[bank["tensor"]] = [seed["samples"] for seed in seeds]
        entries = [{"label": name, **{key: value for key, value in seed.items() if key != "samples"}} for seed in seeds]
        header["seed_bank"] = {**bank, "entries": [*bank["entries"], *entries]}
    tensors = {
        key: np.concatenate([tensor, np.array(added[key], dtype=np.float32)]) if len(added.get(key, ())) else tensor
        for key, tensor in model.tensors.items()
    }
    return ModelFile(header, tensors, model.graphs)


def require_new_name(model: ModelFile, name: str) -> None:
    """InputError if the model has a label of this name."""
    if any(label["name"] == name for label in model.header["labels"]):
        raise InputError(f"the model has a label '{name}' already; choose another --name")
