"""The golden checkpoints of Tests/Golden/published, and copies of them with one thing changed."""

from __future__ import annotations

import json
import shutil
import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import torch

from haptoflow_paper.codec.encodec import EnCodec
from haptoflow_paper.published.network import NetworkSizes, PublishedNetwork

PUBLISHED = Path(__file__).parents[1] / "Golden" / "published"
SOLVERS = ("heun", "euler")


class GoldenChain:
    """Arrays of one golden.npz: three segments, each the past of the next."""

    segments = 3

    def __init__(self, solver: str) -> None:
        with np.load(PUBLISHED / solver / "golden.npz") as arrays:
            self._arrays = {name: arrays[name] for name in arrays.files}

    def tensor(self, segment: int, name: str) -> torch.Tensor:
        return torch.from_numpy(self._arrays[f"s{segment}_{name}"])

    def motion(self, segment: int) -> torch.Tensor:
        return torch.from_numpy(self._arrays["motion"][segment : segment + 1]).float()

    def label(self, segment: int) -> int:
        return int(self._arrays["label_ids"][segment])


def assert_within_1e_4_of_its_rms(found: Any, expected: Any) -> None:
    found, expected = np.asarray(found, dtype=np.float64), np.asarray(expected, dtype=np.float64)
    assert found.shape == expected.shape
    error, rms = np.abs(found - expected).max(), np.sqrt(np.square(expected).mean())
    assert error <= 1e-4 * rms, f"off by {error / rms:.2g} of the RMS"


def write_checkpoint_of_published_sizes(folder: Path) -> Path:
    """A checkpoint with the authors' sizes (118 classes, first channels 128, EnCodec's own) and random weights."""
    sizes = NetworkSizes(
        classes=118, latent=128, channels=(128, 256), label=64, control=64, hidden=64, time=64, position=32, groups=8, past_groups=4
    )
    torch.manual_seed(3)
    shutil.copytree(PUBLISHED / "heun", folder, ignore=shutil.ignore_patterns("golden.npz", "*.th", "*.safetensors"))
    state = PublishedNetwork(sizes).state_dict()
    header, data = {}, bytearray()
    for name, value in state.items():
        content = value.numpy().astype("<f4").tobytes()
        header[name] = {"dtype": "F32", "shape": list(value.shape), "data_offsets": [len(data), len(data) + len(content)]}
        data += content
    write_safetensors(folder / "model.safetensors", header, bytes(data))
    books = {f"quantizer.vq.layers.{level}._codebook.embed": torch.randn(1024, 128) / (level + 1) for level in range(32)}
    torch.save({**EnCodec().state_dict(), **books}, folder / "encodec.th")
    classes = [f"Material {row:03}" for row in range(sizes.classes)]

    def enlarge(meta: dict[str, Any]) -> None:
        meta["dataset"].update(classes=classes, label_to_int={name: row for row, name in enumerate(classes)}, num_classes=118)
        meta["config"]["sampling"].update(steps=8, solver="heun", guidance_scale=3.0)

    change_meta(folder, enlarge)
    return folder


def copied(solver: str, folder: Path) -> Path:
    """A writable copy of a golden checkpoint without its golden arrays."""
    target = folder / solver
    shutil.copytree(PUBLISHED / solver, target, ignore=shutil.ignore_patterns("golden.npz"))
    return target


def change_meta(folder: Path, change: Callable[[dict[str, Any]], Any]) -> None:
    path = folder / "meta.json"
    document = json.loads(path.read_text(encoding="utf-8"))
    change(document)
    path.write_text(json.dumps(document), encoding="utf-8")


def safetensors_parts(path: Path) -> tuple[dict[str, Any], bytearray]:
    content = path.read_bytes()
    (length,) = struct.unpack_from("<Q", content)
    return json.loads(content[8 : 8 + length]), bytearray(content[8 + length :])


def write_safetensors(path: Path, header: dict[str, Any], data: bytes) -> None:
    text = json.dumps(header).encode()
    path.write_bytes(struct.pack("<Q", len(text)) + text + data)


def change_safetensors(folder: Path, change: Callable[[dict[str, Any], bytearray], Any]) -> None:
    path = folder / "model.safetensors"
    header, data = safetensors_parts(path)
    change(header, data)
    write_safetensors(path, header, bytes(data))
