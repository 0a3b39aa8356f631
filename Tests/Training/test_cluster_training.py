"""`./run train --cluster`, from a hub on the loopback address to a model file."""

from __future__ import annotations

import os
import subprocess
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from haptoflow_benchmark.engine_render import render_motion
from haptoflow_training.cli import main
from haptoflow_training.commands import train_tiers
from haptoflow_training.errors import InputError
from haptoflow_training.export.model_file import read_model_file
from haptoflow_training.recordings.cluster_dataset import labels_of_textures
from haptoflow_training.recordings.dataset_layout import TextureEntry, write_recording, write_texture_list
from haptoflow_training.recordings.labels import LabelDefinition, LabelMap, load_labels
from haptoflow_training.recordings.recording import Recording, RecordingIdentity
from haptoflow_training.recordings.synthetic import load_materials, record_condition_of
from haptoflow_training.training.level_calibration import Extent
from parquet_samples import HUB
from test_skeleton_training import SMALL_BASE, SMALL_STANDARD
from training_fixtures import run_here
from places import ROOT

NAME = "tamago117/cluster-haptic-texture-dataset"
SCRIPT = ROOT / "scripts" / "train.mjs"


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


@pytest.fixture
def small(tmp_path: Path) -> list[str]:
    """Words that train a small model, two steps long."""
    configs = tmp_path / "configs"
    configs.mkdir()
    (configs / "base.toml").write_text(SMALL_BASE)
    (configs / "standard.toml").write_text(SMALL_STANDARD)
    return ["--configs", "configs", "--out", "runs", "--lanes", "1", "--export", "cluster.haptoflow"]


@pytest.mark.long(
    because="a model is trained, two steps long, on files from a hub on the loopback address; "
    "test_recordings_from_a_folder_become_a_model_of_the_shipped_kind trains such a model from a folder"
)
def test_a_model_of_chosen_textures_has_their_labels_and_licence(tmp_path: Path, small: list[str]) -> None:
    with loopback_hub() as (hub, _):
        ended = _train(hub, tmp_path, "--textures", "0,38", "--into", "data", *small)
    assert ended.returncode == 0, ended.stderr + ended.stdout
    header = read_model_file(tmp_path / "cluster.haptoflow").header
    assert [label["name"] for label in header["labels"]] == ["wood", "stone"]
    assert "Cluster Haptic Texture Dataset" in header["provenance"]["statement"]
    assert header["provenance"]["licence"] == "CC BY 4.0"


CONFIGURATIONS = ROOT / "Training" / "configs" / "cluster"
# Only sizes and steps are smaller than in the recipe.
SMALLER = {
    "base": "[model]\nhidden = [8, 8]\n[optimiser]\nlevel_steps = 2\nsteps = 2\nbatch_size = 4\n"
    "[recipe]\nfilter_steps = 2\nenergy_steps = 1\nenergy_batch_size = 2\nself_forcing_steps = 1\n",
    "draft": "[model]\nhidden = [8, 8]\nwidth = 8\nprevious_width = 4\n[optimiser]\nbatch_size = 4\n"
    "[recipe]\nenergy_steps = 1\nenergy_batch_size = 2\nself_forcing_steps = 1\n",
}
SMALLER["standard"] = SMALLER["draft"]
TEXTURES = {0: "wood", 103: "corduroy"}
RIB_MM = 2.5
MOTION = np.tile(np.array([0.05, 0.0, 0.8]), (1600, 1))


def _pass_over(texture: int, direction_degrees: int, speed_mmps: int) -> Recording:
    material = {each.label: each for each in load_materials()}[TEXTURES[texture]]
    identity = RecordingIdentity(texture, direction_degrees, speed_mmps, 500, 0)
    return record_condition_of(material, identity, seed=1)


@pytest.fixture(scope="module")
def data_set(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two textures in the published layout, under the published names; nothing states an origin or ribs."""
    root = tmp_path_factory.mktemp("cluster")
    for direction in range(0, 360, 45):
        for speed in (40, 60):
            for texture in TEXTURES:
                write_recording(root, _pass_over(texture, direction, speed))
    names = {0: "Nyatoh", 38: "Granite", 103: "Corduroy"}
    write_texture_list(root, [TextureEntry(number, name, {}) for number, name in names.items()])
    return root


@pytest.fixture(scope="module")
def model(data_set: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("trained")
    configs = folder / "configs"
    configs.mkdir()
    for name, smaller in SMALLER.items():
        (configs / f"{name}.toml").write_text(f'extends = "{CONFIGURATIONS / name}.toml"\n{smaller}', encoding="utf-8")
    file = folder / "cluster.haptoflow"
    words = ["--configs", str(configs), "--recordings", str(data_set), "--out", str(folder / "runs"), "--lanes", "1"]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(train_tiers, "run_jobs", run_here)
        patch.setattr(train_tiers, "Extent", lambda: Extent(recordings_per_label=4, longest_samples=2000))
        assert main(["train-tiers", *words, "--export", str(file)]) == 0
    return file


@pytest.fixture(scope="module")
def header(model: Path) -> dict[str, Any]:
    return read_model_file(model).header


def test_a_cluster_training_has_the_tiers_that_ship_and_states_the_data_set(header: dict[str, Any]) -> None:
    kinds = [(tier["name"], tier["kind"]) for tier in header["tiers"]]
    assert kinds == [("sketch", "skeleton"), ("draft", "refine"), ("standard", "refine")]
    assert header["name"] == "cluster" and header["default_tier"] == "standard"
    provenance = header["provenance"]
    assert provenance["licence"] == "CC BY 4.0" and "Cluster Haptic Texture Dataset" in provenance["statement"]
    emphasised = provenance["configuration"]["batch"]["emphasised_labels"]
    assert list(emphasised) == ["corduroy"], "those of the recipe that the data set has"


def test_wave_vectors_are_found_where_ribs_are_and_only_there(header: dict[str, Any]) -> None:
    periods = {label["name"]: label["wavelength_metres"] for label in header["labels"]}
    assert periods["wood"] is None and periods["corduroy"] == pytest.approx(1e-3 * RIB_MM, rel=0.02)


@pytest.mark.parametrize("tier", ["sketch", "draft", "standard"])
def test_the_engine_renders_every_tier_of_a_cluster_training(model: Path, tier: str, tmp_path: Path) -> None:
    engine = ROOT / "build" / "native" / "haptoflow"
    made = render_motion(engine, "corduroy", MOTION, tmp_path, model=model, options=("--quality", tier))
    assert np.isfinite(made.waveform_mps2).all() and np.std(made.waveform_mps2) > 1e-3
    assert made.report["tier"] == tier and made.report["failures"] == 0


LISTED = {0: "Nyatoh", 1: "Steel", 38: "Granite", 49: "HDPE", 103: "Corduroy", 104: "Cotton broadcloth"}


def test_chosen_textures_become_labels_known_or_of_their_own_name(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "labels.toml"
    assert main(["labels", str(HUB), "--textures", "49,0,38", "--out", str(out)]) == 0
    assert capsys.readouterr().out == "49\thdpe\n0\twood\n38\tstone\n"
    hdpe, wood, stone = load_labels(out).definitions
    assert (hdpe.category, hdpe.textures, hdpe.stiffness_newtons_per_metre) == ("polymer", (49,), 900.0)
    known = {definition.name: definition for definition in load_labels().definitions}
    assert wood == known["wood"] and stone == known["stone"]


def test_without_a_choice_every_known_label_is_there_by_its_id() -> None:
    labels = labels_of_textures(load_labels(), LISTED, ())
    assert sorted(labels.names) == sorted(load_labels().names)
    assert {definition.name: definition.textures for definition in labels.definitions}["cotton"] == (104,)


def test_a_label_whose_texture_is_not_listed_is_named() -> None:
    with pytest.raises(InputError, match=r"texture_list\.xlsx lists no texture of the labels .*corduroy.*--textures"):
        labels_of_textures(load_labels(), {}, ())


def test_an_id_outside_the_data_set_is_refused(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    with pytest.raises(InputError, match="--textures 118: .*no such texture; expected ids from 0 to 117"):
        labels_of_textures(load_labels(), LISTED, (0, 118))
    with pytest.raises(SystemExit):
        main(["labels", str(HUB), "--textures", "oak", "--out", str(tmp_path / "l.toml")])
    assert "'oak'; expected ids with commas between them" in capsys.readouterr().err


def test_a_texture_that_is_called_like_another_label_is_told_apart_by_its_id() -> None:
    known = LabelMap((LabelDefinition("steel", "wood", (66,), 1.0, 0.5),))
    assert labels_of_textures(known, LISTED, (1, 66)).names == ["steel 1", "steel"]
