"""`./run train --cluster`, from a hub on the loopback address to a model file."""

from __future__ import annotations

import os
import subprocess
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from parquet_samples import HUB
from test_skeleton_training import SMALL_BASE, SMALL_STANDARD

from haptoflow_training.export.model_file import read_model_file
from haptoflow_training.recordings.cluster_dataset import open_dataset
from haptoflow_training.recordings.labels import load_labels

NAME = "tamago117/cluster-haptic-texture-dataset"
SCRIPT = Path(__file__).resolve().parents[2] / "scripts" / "train.mjs"
# Each recording of these textures, with three files.
CHOSEN = ("0_0_40_500_0", "0_90_40_500_1", "38_0_40_500_0", "38_90_40_500_1")


@contextmanager
def loopback_hub() -> Iterator[tuple[str, list[str]]]:
    """The address of a hub that serves Golden/parquet/hub, and the requests that it gets, a list that grows."""
    asked: list[str] = []
    words = ["node", str(Path(__file__).with_name("serve_hub.mjs")), NAME, str(HUB)]
    with subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as server:
        assert server.stdin is not None and server.stdout is not None
        address = server.stdout.readline().strip()
        listening = threading.Thread(target=lambda: asked.extend(line.strip() for line in server.stdout or ()))
        listening.start()
        try:
            yield address, asked
        finally:
            server.stdin.close()
            listening.join()


def _train(hub: str, folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        ["node", str(SCRIPT), "--cluster", *words],
        env={**os.environ, "HF_ENDPOINT": hub, "HF_TOKEN": "", "INIT_CWD": str(folder), "PYTHONWARNINGS": "ignore"},
        capture_output=True, text=True, timeout=600,
    )  # fmt: skip


def _brought(asked: list[str]) -> list[str]:
    """The files whose bytes were asked for, by the hub's address of them."""
    return [line.split("/resolve/")[1].split("/", 1)[1] for line in asked if "/resolve/" in line]


def _of_data_set(path: Path) -> str:
    return "/".join(path.parts[-4:])


@pytest.fixture
def small(tmp_path: Path) -> list[str]:
    """Words that train a small model, two steps long."""
    configs = tmp_path / "configs"
    configs.mkdir()
    (configs / "base.toml").write_text(SMALL_BASE)
    (configs / "standard.toml").write_text(SMALL_STANDARD)
    return ["--configs", "configs", "--out", "runs", "--lanes", "1", "--export", "cluster.haptoflow"]


def test_a_model_of_chosen_textures_has_their_labels_and_licence(tmp_path: Path, small: list[str]) -> None:
    with loopback_hub() as (hub, _):
        ended = _train(hub, tmp_path, "--textures", "0,38", "--into", "data", *small)
    assert ended.returncode == 0, ended.stderr + ended.stdout
    header = read_model_file(tmp_path / "cluster.haptoflow").header
    assert [label["name"] for label in header["labels"]] == ["wood", "stone"]
    assert "Cluster Haptic Texture Dataset" in header["provenance"]["statement"]
    assert header["provenance"]["licence"] == "CC BY 4.0"


def test_chosen_textures_are_downloaded_once_and_handed_to_the_training(tmp_path: Path) -> None:
    words = ["--textures", "0,38", "--into", "data", "--configs", "gone"]
    with loopback_hub() as (hub, asked):
        ended = _train(hub, tmp_path, *words)
        # The training has begun, and refuses the configuration.
        assert ended.returncode == 3 and f"{Path('gone') / 'base.toml'}" in ended.stderr, ended.stderr
        files = sorted(path.name for path in (tmp_path / "data" / "sensor_data").rglob("*") if path.is_file())
        assert files == sorted(f"{name}.parquet" for name in CHOSEN for _ in range(3))
        first = len(asked)
        assert "wood (0), stone (38)" in ended.stdout and "licence cc-by-4.0" in ended.stdout
        # Again: a file that is missing and a damaged one are brought, the others are only read.
        lost, damaged = sorted((tmp_path / "data" / "sensor_data" / "force").rglob("*.parquet"))[:2]
        lost.unlink()
        damaged.write_bytes(b"PAR1" + damaged.read_bytes()[4:-1] + b"2")
        assert _train(hub, tmp_path, *words).returncode == 3
    assert not [path for path in asked if "/49" in path or "audio" in path]
    assert len(_brought(asked[:first])) == 13 == len(set(_brought(asked[:first])))
    assert sorted(_brought(asked[first:])) == sorted([_of_data_set(lost), _of_data_set(damaged)])
    labels = load_labels(tmp_path / "data" / "labels.toml")
    assert [(label.name, label.textures) for label in labels.definitions] == [("wood", (0,)), ("stone", (38,))]
    assert [entry.label for entry in open_dataset(tmp_path / "data", labels)] == ["wood", "wood", "stone", "stone"]


def test_wrong_words_are_refused_before_anything_is_asked_for(tmp_path: Path) -> None:
    with loopback_hub() as (hub, asked):
        for words, sentence in (
            (["--textures", "oak"], "--textures oak: expected ids"),
            (["--textures"], "--textures needs ids"),
            (["--into"], "--into needs a folder"),
            (["--recordings", "x"], "leave --recordings out"),
        ):
            ended = _train(hub, tmp_path, *words)
            assert ended.returncode == 2 and sentence in ended.stderr, ended.stderr
        ended = _train(hub, tmp_path, "--textures", "0,118", "--into", "data")
        assert "--textures 118: the data set has no such texture" in ended.stderr
    assert _brought(asked) == ["texture_list.xlsx"], "nothing is asked for by words that are refused"
