"""The `.haptoflow` writer and its reader: layout, alignment, checksums, damage."""

from __future__ import annotations

import json
import struct
import zlib
from pathlib import Path

import numpy as np
import pytest

from haptoflow_training.errors import InputError
from haptoflow_training.export.model_file import (
    VERSION,
    ModelFile,
    encode_model_file,
    model_space,
    read_model_file,
    write_model_file,
)

ROOT = Path(__file__).parents[2]
GOLDEN = ROOT / "Tests" / "Golden"
DEFAULT = ROOT / "Packages" / "com.haptoflow.runtime" / "Runtime" / "Models" / "default.haptoflow"
MODEL = ModelFile(
    header={"name": "tést", "labels": [{"name": "wood"}]},
    tensors={"embedding": np.arange(128, dtype=np.float32).reshape(2, 64), "seeds": np.ones((1, 400), np.float32)},
    graphs={"field": b"graph bytes", "level": b"x" * 1000},
)


def _of_version(version: int, content: bytes) -> bytes:
    return content[:8] + struct.pack("<I", version) + content[12:]


def test_what_is_written_is_read_back(tmp_path: Path) -> None:
    path = tmp_path / "model.haptoflow"
    checksum = write_model_file(path, MODEL)
    assert checksum == zlib.crc32(path.read_bytes())
    read = read_model_file(path)
    assert read.header == MODEL.header
    assert read.graphs == MODEL.graphs
    np.testing.assert_array_equal(read.tensors["embedding"], MODEL.tensors["embedding"])


def test_the_preamble_holds_magic_version_lengths_and_checksums() -> None:
    content = encode_model_file(MODEL)
    magic, version, header_length, total, header_crc, own_crc = struct.unpack_from("<8sIIQII", content)
    assert (magic, version, total) == (b"HAPTFLOW", VERSION, len(content))
    assert zlib.crc32(content[32 : 32 + header_length]) == header_crc
    assert zlib.crc32(content[:28]) == own_crc


def test_header_and_blobs_end_and_start_on_multiples_of_64(tmp_path: Path) -> None:
    for name_length in range(1, 140):
        model = ModelFile({"name": "n" * name_length}, MODEL.tensors, MODEL.graphs)
        content = encode_model_file(model)
        (header_length,) = struct.unpack_from("<I", content, 12)
        assert (32 + header_length) % 64 == 0
        path = tmp_path / "m.haptoflow"
        path.write_bytes(content)
        assert read_model_file(path).header["name"] == "n" * name_length


@pytest.mark.parametrize(
    ("damage", "complaint"),
    [
        (lambda content: content[:-1], "truncated"),
        (lambda content: b"NOTAMODL" + content[8:], "not a .haptoflow file"),
        (lambda content: _of_version(VERSION + 1, content), f"version {VERSION + 1}, expected {VERSION}: update"),
        (lambda content: _of_version(VERSION - 1, content), f"{VERSION - 1}, expected {VERSION}: .*training export"),
        (lambda content: content[:40] + b"#" + content[41:], "header"),
        (lambda content: content[:-3] + b"#" + content[-2:], "'level'"),
    ],
    ids=["truncated", "other magic", "newer", "older", "header", "blob"],
)
def test_damage_is_named(tmp_path: Path, damage: object, complaint: str) -> None:
    path = tmp_path / "broken.haptoflow"
    path.write_bytes(damage(encode_model_file(MODEL)))  # type: ignore[operator]
    with pytest.raises(InputError, match=complaint):
        read_model_file(path)


def test_a_tensor_that_is_not_finite_is_refused() -> None:
    with pytest.raises(ValueError, match="'embedding'"):
        encode_model_file(ModelFile({}, {"embedding": np.array([np.nan], np.float32)}, {}))


def test_the_space_follows_the_networks_and_neither_labels_nor_embedding() -> None:
    spaces = json.loads((GOLDEN / "material" / "expected.json").read_text(encoding="utf-8"))["spaces"]
    model = read_model_file(GOLDEN / "model" / "tiny.haptoflow")
    assert model_space(model) == spaces["tiny"]
    assert model_space(read_model_file(DEFAULT)) == spaces["default"]
    model.header["labels"].pop()
    model.tensors["embedding"] = model.tensors["embedding"] * 2.0
    assert model_space(model) == spaces["tiny"]
    name = model.header["tiers"][1]["field"]
    model.graphs[name] = model.graphs[name] + b"\0"
    assert model_space(model) != spaces["tiny"]
