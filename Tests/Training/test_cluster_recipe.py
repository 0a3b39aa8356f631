"""The recipe for the Cluster Haptic Texture Dataset, from its files to the engine, with few steps."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from haptoflow_benchmark.engine_render import render_motion
from haptoflow_training.cli import main
from haptoflow_training.export.model_file import read_model_file
from haptoflow_training.recordings.dataset_writer import TextureEntry, write_recording, write_texture_list
from haptoflow_training.recordings.recording import Recording, RecordingIdentity
from haptoflow_training.recordings.synthetic import load_materials, record_machine_condition

ROOT = Path(__file__).parents[2]
CONFIGURATIONS = ROOT / "Training" / "configs" / "cluster"
# Only sizes and steps are smaller than in the recipe.
SMALLER = {
    "base": "[model]\nhidden = 8\n[optimiser]\nlevel_steps = 2\nsteps = 2\nbatch_size = 4\n"
    "[recipe]\nfilter_steps = 2\nenergy_steps = 1\nenergy_batch_size = 2\nself_forcing_steps = 1\n",
    "draft": "[model]\nhidden = 8\nwidth = 8\nprevious_width = 4\n[optimiser]\nbatch_size = 4\n"
    "[recipe]\nenergy_steps = 1\nenergy_batch_size = 2\nself_forcing_steps = 1\n",
}
SMALLER["standard"] = SMALLER["draft"]
TEXTURES = {0: "wood", 103: "corduroy"}
RIB_MM = 2.5
MOTION = np.tile(np.array([0.05, 0.0, 0.8]), (1600, 1))


def _pass_over(texture: int, direction_degrees: int, speed_mmps: int) -> Recording:
    material = {each.label: each for each in load_materials()}[TEXTURES[texture]]
    identity = RecordingIdentity(texture, direction_degrees, speed_mmps, 500, 0)
    return record_machine_condition(material, identity, seed=1)


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
        patch.setenv("PYTHONPATH", str(ROOT / "Training"))
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
