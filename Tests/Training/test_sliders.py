"""Sliders move the embedding as named and stay inside the labels' spread; the shipped file is reproduced."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from training_fixtures import still_surfaces

from haptoflow_benchmark.engine_library import default_engine
from haptoflow_paper.metrics.temporal_metrics import rib_modulation_depth
from haptoflow_benchmark.waveform_metrics import power_spectrum
from haptoflow_paper.rows.engine_generator import EngineGenerator
from haptoflow_training.cli import main
from haptoflow_training.closed_loop.render import UPDATE_RATE_HZ, run_closed_loop
from haptoflow_training.export.model_file import ModelFile, model_space, read_model_file
from haptoflow_training.fewshot.sliders import Sliders, find_sliders
from haptoflow_training.recordings.synthetic import load_materials

ROOT = Path(__file__).parents[2]
DEFAULT = ROOT / "Packages" / "com.haptoflow.runtime" / "Runtime" / "Models" / "default.haptoflow"
SHIPPED = ROOT / "Packages" / "com.haptoflow.runtime" / "Editor" / "Sliders" / "default.sliders.json"
TINY = ROOT / "Tests" / "Golden" / "model" / "tiny.haptoflow"


@pytest.fixture(scope="module")
def file() -> ModelFile:
    return read_model_file(DEFAULT)


@pytest.fixture(scope="module")
def sliders(file: ModelFile) -> Sliders:
    return find_sliders(file, load_materials())


def learnt(file: ModelFile, label: str) -> np.ndarray:
    names = [entry["name"] for entry in file.header["labels"]]
    return file.tensors["embedding"][names.index(label)]


def slid(file: ModelFile, sliders: Sliders, label: str, name: str, values: tuple[float, ...]) -> list[np.ndarray]:
    base = learnt(file, label)
    return [np.concatenate([sliders.slid(base[:60], {name: value}), base[60:]]) for value in values]


def rendered(embeddings: list[np.ndarray], velocity: tuple[float, float]) -> np.ndarray:
    motion = np.tile(np.array([*velocity, 1.0], dtype=np.float32), (len(embeddings), 4400, 1))
    with EngineGenerator(default_engine(ROOT), DEFAULT) as source:
        run = run_closed_loop(
            source, np.stack(embeddings).astype(np.float32), motion, np.arange(len(embeddings)),
            still_surfaces(len(embeddings)), update_rate_hz=UPDATE_RATE_HZ, seed=3,
        )  # fmt: skip
    return run.waves[:, 400:]


def centroid_hz(wave: np.ndarray) -> float:
    power, frequency = power_spectrum(wave, 512), np.fft.rfftfreq(512, 1.0 / 2000.0)
    band = (frequency >= 20.0) & (frequency <= 900.0)
    return float((power[band] * frequency[band]).sum() / power[band].sum())


def test_coarseness_lowers_the_pitch_step_by_step_and_hardness_raises_it(file: ModelFile, sliders: Sliders) -> None:
    values, labels = (-1.0, -0.5, 0.0, 0.5, 1.0), ("wood", "stone", "paper", "rubber")
    for name, sign in (("coarseness", -1.0), ("hardness", 1.0)):
        asked = [each for label in labels for each in slid(file, sliders, label, name, values)]
        waves = rendered(asked, (0.08, 0.03))
        pitch = np.log([centroid_hz(wave) for wave in waves]).reshape(len(labels), len(values)).mean(axis=0)
        assert (sign * np.diff(pitch) > 0.0).all(), (name, np.exp(pitch))
        assert sign * (pitch[-1] - pitch[0]) > 0.25


def test_regularity_makes_ribs_stand_out(file: ModelFile, sliders: Sliders) -> None:
    depths = []
    for label, rate in (("jute", 40.0), ("corduroy", 32.0)):
        asked = slid(file, sliders, label, "regularity", (-1.0, 1.0))
        depths.append([rib_modulation_depth(wave, rate) for wave in rendered(asked, (0.08, 0.0))])
    irregular, regular = np.mean(depths, axis=0)
    assert regular > irregular


def test_no_combination_of_sliders_leaves_the_spread_of_the_labels(file: ModelFile, sliders: Sliders) -> None:
    rng = np.random.default_rng(1)
    for label in ("wood", "carpet", "metal mesh"):
        for _ in range(50):
            far = rng.choice([-1.0, 1.0, 5.0, -5.0], len(sliders.directions))
            values = dict(zip(sliders.directions, far, strict=True))
            along = sliders.axes @ (sliders.slid(learnt(file, label)[:60], values) - sliders.mean)
            assert (along >= sliders.lowest - 1e-4).all()
            assert (along <= sliders.highest + 1e-4).all()


def test_the_shipped_file_is_what_the_command_writes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "default.sliders.json"
    assert main(["sliders", "--model", str(DEFAULT), "-o", str(out)]) == 0
    assert "stickiness and level" in capsys.readouterr().out
    made, shipped = (json.loads(path.read_text(encoding="utf-8")) for path in (out, SHIPPED))
    assert made["space"] == shipped["space"] == model_space(read_model_file(DEFAULT))
    assert [slider["name"] for slider in shipped["sliders"]] == [
        "coarseness", "hardness", "regularity", "stickiness", "level",
    ]  # fmt: skip
    for one, other in zip(made["sliders"], shipped["sliders"], strict=True):
        assert one["direction"] == pytest.approx(other["direction"], abs=1e-5)
    axes = np.array(shipped["axes"])
    assert axes @ axes.T == pytest.approx(np.eye(len(axes)), abs=1e-4)
    assert shipped["sliders"][-1]["level_db"] == 12.0
    assert not any(shipped["sliders"][-1]["direction"])


def test_a_model_of_other_labels_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["sliders", "--model", str(TINY), "-o", str(tmp_path / "x.json")]) == 3
    assert "shares 0 labels" in capsys.readouterr().err
    assert not (tmp_path / "x.json").exists()
