"""`haptoflow-training add-material`: material files, further labels, and refused input."""

from __future__ import annotations

import json
import math
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from haptoflow_benchmark.engine_library import default_engine
from haptoflow_benchmark.engine_render import render_motion
from haptoflow_benchmark.waveform_metrics import power_spectrum
from haptoflow_paper.report.temporal_metrics import rib_modulation_depth
from haptoflow_paper.rows.engine_generator import EngineGenerator
from haptoflow_training.cli import main
from haptoflow_training.training.closed_loop import UPDATE_RATE_HZ, run_closed_loop
from haptoflow_training.errors import InputError
from haptoflow_training.export.model_file import ModelFile, model_space, read_model_file, with_label
from haptoflow_training.export.sliders import Sliders, find_sliders
from haptoflow_training.recordings.synthetic import load_materials
from own_samples import csv_one_axis, stroke
from training_fixtures import still_surfaces
from places import DEFAULT, ENGINE, ROOT, SMALL

# A small model with a skeleton, on which a material is learnt in a second.
TINY = ROOT / "Tests" / "Golden" / "model" / "tiny.haptoflow"
RIBBED = ROOT / "Tests" / "Golden" / "material" / "ribbed.haptomaterial"
# The search ends early, so that two runs may differ.
QUICK = ["--seconds-limit", "0.1"]


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("recording")
    return csv_one_axis(folder, "mat", "doormat", stroke(6.0, hertz=90.0), licence="CC BY 4.0")


def add(*words: str | Path) -> int:
    return main(["add-material", "--model", str(SMALL), *QUICK, *map(str, words)])


def read_material(path: Path) -> dict[str, Any]:
    content: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    return content


@pytest.fixture(scope="module")
def extended(recording: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("extended") / "mine.haptoflow"
    assert add("--recording", recording, "-o", out) == 0
    return out


def test_a_material_file_states_what_was_recorded(
    recording: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert add("--recording", recording, "--seconds-limit", "1") == 0
    said = capsys.readouterr().out
    assert "mat.haptomaterial" in said
    assert "10 s or more give a more accurate material" in said
    material = read_material(tmp_path / "mat.haptomaterial")
    assert material["space"] == model_space(read_model_file(SMALL))
    assert material["name"] == "doormat"
    assert material["provenance"]["licence"] == "CC BY 4.0"
    assert material["provenance"]["recordings"].startswith("mat.csv")
    assert material["provenance"]["seconds"] == pytest.approx(6.0, abs=0.6)
    # own_samples.stroke: 20 v m/s^2 at 1 N between 50 and 200 mm/s.
    for speed in (0.07, 0.16):
        made = render_motion(
            ENGINE, "doormat", np.tile([speed, 0.0, 1.0], (4000, 1)), tmp_path, model=SMALL,
            options=("--quiet", "--material", str(tmp_path / "mat.haptomaterial")),
        ).waveform_mps2[400:]  # fmt: skip
        assert math.log(float(np.sqrt(np.square(made).mean()))) == pytest.approx(math.log(20.0 * speed), abs=0.35)
    assert material["range"]["speed_mps"] == pytest.approx((0.05, 0.2), rel=0.1)
    assert not material["periodic"]
    assert ("seeds" in material) == ("seed_bank" in read_model_file(SMALL).header), "only where the model needs them"


def test_one_recording_gives_the_bytes_of_haptoflow_learn(tmp_path: Path) -> None:
    recording = csv_one_axis(tmp_path, "mat", "Kitchen_Mat", stroke(5.0, hertz=90.0), licence="CC BY 4.0", source="our hall")
    out, other = tmp_path / "python.haptomaterial", tmp_path / "line.haptomaterial"
    words = ["--seconds-limit", "3600"]
    assert add("--recording", recording, "-o", out, *words) == 0
    command = [ENGINE, "learn", recording, "--model", SMALL, "-o", other, *words, "--quiet"]
    subprocess.run([str(word) for word in command], check=True, capture_output=True)
    assert out.read_bytes() == other.read_bytes()


def test_a_further_label_leaves_all_other_labels_unchanged(extended: Path) -> None:
    before, after = read_model_file(SMALL), read_model_file(extended)
    count = len(before.header["labels"])
    assert after.header["labels"][:count] == before.header["labels"]
    assert [label["name"] for label in after.header["labels"][count:]] == ["doormat"]
    assert np.array_equal(after.tensors["embedding"][: len(before.tensors["embedding"])], before.tensors["embedding"])
    assert after.graphs == before.graphs
    untouched = set(before.header) - {"labels", "seed_bank"}
    assert {key: after.header[key] for key in untouched} == {key: before.header[key] for key in untouched}
    assert model_space(after) == model_space(before)


def test_a_model_with_a_seed_bank_takes_the_seeds_of_a_further_label() -> None:
    before, material = read_model_file(TINY), read_material(RIBBED)
    after = with_label(before, material)
    stated = [{"label": "ribbed", **{key: seed[key] for key in seed if key != "samples"}} for seed in material["seeds"]]
    assert after.header["seed_bank"]["entries"] == [*before.header["seed_bank"]["entries"], *stated]
    seeds = [*before.tensors["seeds"], *(seed["samples"] for seed in material["seeds"])]
    np.testing.assert_allclose(after.tensors["seeds"], seeds)


def test_a_name_that_the_model_has_is_refused_and_nothing_is_written(
    recording: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "x.haptoflow"
    assert add("--recording", recording, "--name", "Ruled", "-o", out) == 3
    assert "'ruled' already; choose another --name" in capsys.readouterr().err
    assert not out.exists()


def test_recordings_of_two_labels_are_refused_unless_a_name_is_given(
    recording: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    other = csv_one_axis(tmp_path, "felt", "felt", stroke(3.0, seed=2))
    assert add("--recording", recording, other, "-o", tmp_path / "x.haptomaterial") == 3
    assert "2 labels (doormat, felt)" in capsys.readouterr().err
    assert add("--recording", recording, other, "--name", "both", "-o", tmp_path / "x.haptomaterial") == 0


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["-o", "x.txt"], "x.txt: expected a name that ends in .haptomaterial or .haptoflow"),
        (["--seconds-limit", "0"], "--seconds-limit 0: expected above 0 to 3600"),
        (["--name", " "], "--name is empty"),
        (["--wave-vector", "1", "0", "--wave-vector", "0", "1", "--wave-vector", "1", "1"], "two at most"),
    ],
)
def test_contradictory_options_are_refused(
    words: list[str], message: str, recording: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    assert add("--recording", recording, *words) == 3
    assert message in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_given_wave_vectors_are_used(recording: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "rack.haptomaterial"
    assert add("--recording", recording, "--name", "rack", "--wave-vector", "0", "0.8", "-o", out) == 0
    assert "ribs every 1.25 mm" in capsys.readouterr().out
    material = read_material(out)
    assert material["periodic"]
    assert material["wavelength_metres"] == pytest.approx(0.00125)
    assert material["embedding"][-4:] == pytest.approx([0.8, 0.0, 0.0, 0.0], abs=1e-6)
    assert material["frequency_exponent"] == 1.0
    assert all("rib_phase" in seed for seed in material.get("seeds", []))


def test_a_label_with_path_separators_cannot_write_outside_the_folder(
    recording: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    inner = tmp_path / "inner"
    inner.mkdir()
    monkeypatch.chdir(inner)
    assert add("--recording", recording, "--name", "../grey mat/2") == 0
    assert [path.name for path in inner.iterdir()] == ["grey-mat-2.haptomaterial"]
    assert read_material(inner / "grey-mat-2.haptomaterial")["name"] == "../grey mat/2"


def test_a_material_of_another_space_does_not_become_a_label() -> None:
    material = read_material(RIBBED)
    model: ModelFile = read_model_file(SMALL)
    with pytest.raises(InputError, match="another model"):
        with_label(model, material)


def render_wav(folder: Path, label: str, *options: str | Path) -> bytes:
    """The bytes of a WAV file of half a second on a plane of the label."""
    folder.mkdir()
    motion = np.tile(np.array([0.08, 0.02, 1.0]), (1000, 1))
    made = render_motion(ENGINE, label, motion, folder, options=("--quiet", *map(str, options)))
    assert float(np.sqrt(np.square(made.waveform_mps2).mean())) > 0.0
    return (folder / "out.wav").read_bytes()


def test_the_engine_renders_the_other_labels_byte_for_byte_as_before(extended: Path, tmp_path: Path) -> None:
    for label in ("smooth", "ruled"):
        before = render_wav(tmp_path / f"{label}-before", label, "--model", SMALL)
        assert render_wav(tmp_path / f"{label}-after", label, "--model", extended) == before


SHIPPED = ROOT / "Packages" / "com.haptoflow.runtime" / "Editor" / "default.sliders.json"


@pytest.fixture(scope="module")
def file() -> ModelFile:
    return read_model_file(DEFAULT)


@pytest.fixture(scope="module")
def sliders(file: ModelFile) -> Sliders:
    return find_sliders(file, load_materials())


def learnt(file: ModelFile, label: str) -> np.ndarray:
    names = [entry["name"] for entry in file.header["labels"]]
    return file.tensors["embedding"][names.index(label)]


def moved(sliders: Sliders, base: np.ndarray, values: dict[str, float]) -> np.ndarray:
    """What the engine makes of an embedding [60] and sliders of -1 to 1 by name."""
    far = base + sum(min(1.0, max(-1.0, value)) * sliders.directions[name] for name, value in values.items())
    own, along = sliders.axes @ (base - sliders.mean), sliders.axes @ (far - sliders.mean)
    held = np.clip(along, np.minimum(sliders.lowest, own), np.maximum(sliders.highest, own))
    return np.asarray(far + sliders.axes.T @ (held - along))


def slid(file: ModelFile, sliders: Sliders, label: str, name: str, values: tuple[float, ...]) -> list[np.ndarray]:
    base = learnt(file, label)
    return [np.concatenate([moved(sliders, base[:60], {name: value}), base[60:]]) for value in values]


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


@pytest.mark.long(
    because="a slider is rendered step by step; test_regularity_makes_the_ribs_of_corduroy_stand_out renders another slider"
)
def test_coarseness_lowers_the_pitch_step_by_step_and_hardness_raises_it(file: ModelFile, sliders: Sliders) -> None:
    values, labels = (-1.0, -0.5, 0.0, 0.5, 1.0), ("wood", "stone", "paper", "rubber")
    for name, sign in (("coarseness", -1.0), ("hardness", 1.0)):
        asked = [each for label in labels for each in slid(file, sliders, label, name, values)]
        waves = rendered(asked, (0.08, 0.03))
        pitch = np.log([centroid_hz(wave) for wave in waves]).reshape(len(labels), len(values)).mean(axis=0)
        assert (sign * np.diff(pitch) > 0.0).all(), (name, np.exp(pitch))
        assert sign * (pitch[-1] - pitch[0]) > 0.25


def test_regularity_makes_the_ribs_of_corduroy_stand_out(file: ModelFile, sliders: Sliders) -> None:
    asked, depths = slid(file, sliders, "corduroy", "regularity", (-1.0, 1.0)), []
    for speed_mps, rate_hz in ((0.08, 32.0), (0.2, 80.0)):
        depths.append([rib_modulation_depth(wave, rate_hz) for wave in rendered(asked, (speed_mps, 0.0))])
    irregular, regular = np.mean(depths, axis=0)
    assert regular > irregular + 0.1


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
