"""`haptoflow-training add-material`: material files, further labels, and refused input."""

from __future__ import annotations

import json
import math
import os
import subprocess
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from own_samples import Stroke, csv_one_axis, stroke

from haptoflow_benchmark.engine.engine_render import read_wav, render_motion
from haptoflow_paper import cli as paper
from haptoflow_training.cli import main
from haptoflow_training.errors import InputError
from haptoflow_training.export.model_file import ModelFile, model_space, read_model_file, write_model_file
from haptoflow_training.fewshot.add_label import with_label

ROOT = Path(__file__).parents[2]
DEFAULT = ROOT / "Packages" / "com.haptoflow.runtime" / "Runtime" / "Models" / "default.haptoflow"
TINY = ROOT / "Tests" / "Golden" / "model" / "tiny.haptoflow"
RIBBED = ROOT / "Tests" / "Golden" / "material" / "ribbed.haptomaterial"
ENGINE = Path(os.environ.get("HAPTOFLOW_ENGINE", ROOT / "build" / "native" / "haptoflow"))
# The search ends early, so that two runs may differ.
QUICK = ["--seconds-limit", "1"]


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("recording")
    return csv_one_axis(folder, "mat", "doormat", stroke(6.0, hertz=90.0), licence="CC BY 4.0")


def add(*words: str | Path) -> int:
    return main(["add-material", "--model", str(DEFAULT), *QUICK, *map(str, words)])


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
    assert add("--recording", recording) == 0
    said = capsys.readouterr().out
    assert "mat.haptomaterial" in said
    assert "10 s or more give a more accurate material" in said
    material = read_material(tmp_path / "mat.haptomaterial")
    assert material["space"] == model_space(read_model_file(DEFAULT))
    assert material["name"] == "doormat"
    assert material["provenance"]["licence"] == "CC BY 4.0"
    assert material["provenance"]["recordings"].startswith("mat.csv")
    assert material["provenance"]["seconds"] == pytest.approx(6.0, abs=0.6)
    # own_samples.stroke: 20 v m/s^2 at 1 N between 50 and 200 mm/s.
    for speed in (0.07, 0.16):
        made = render_motion(
            ENGINE, "doormat", np.tile([speed, 0.0, 1.0], (4000, 1)), tmp_path,
            options=("--quiet", "--material", str(tmp_path / "mat.haptomaterial")),
        ).waveform_mps2[400:]  # fmt: skip
        assert math.log(float(np.sqrt(np.square(made).mean()))) == pytest.approx(math.log(20.0 * speed), abs=0.35)
    assert material["range"]["speed_mps"] == pytest.approx((0.05, 0.2), rel=0.1)
    assert not material["periodic"]
    assert ("seeds" in material) == ("seed_bank" in read_model_file(DEFAULT).header), "only where the model needs them"


def ribbed(made: Stroke, ribs_per_mm: float) -> Stroke:
    """The stroke over ribs across its first axis; three partials have a third of the power."""
    phase = 2.0 * np.pi * ribs_per_mm * made.position_mm[:, 0]
    level = 20.0 * np.hypot(*made.velocity_mps.T)
    ribs = level * sum(0.7 / order * np.cos(order * phase) for order in (1, 2, 3))
    return replace(made, acceleration_mps2=made.acceleration_mps2 + ribs)


def test_one_recording_gives_the_bytes_of_haptoflow_learn(tmp_path: Path) -> None:
    made = ribbed(stroke(10.0, hertz=90.0), 0.8)
    recording = csv_one_axis(tmp_path, "mat", "Kitchen_Mat", made, licence="CC BY 4.0", source="our hall")
    out, other = tmp_path / "python.haptomaterial", tmp_path / "line.haptomaterial"
    words = ["--seconds-limit", "3600"]
    assert add("--recording", recording, "-o", out, *words) == 0
    command = [ENGINE, "learn", recording, "--model", DEFAULT, "-o", other, *words, "--quiet"]
    subprocess.run([str(word) for word in command], check=True, capture_output=True)
    assert out.read_bytes() == other.read_bytes()
    assert read_material(out)["periodic"]


def test_a_further_label_leaves_all_other_labels_unchanged(extended: Path) -> None:
    before, after = read_model_file(DEFAULT), read_model_file(extended)
    count = len(before.header["labels"])
    assert after.header["labels"][:count] == before.header["labels"]
    assert [label["name"] for label in after.header["labels"][count:]] == ["doormat"]
    assert np.array_equal(after.tensors["embedding"][: len(before.tensors["embedding"])], before.tensors["embedding"])
    assert after.graphs == before.graphs
    untouched = set(before.header) - {"labels", "seed_bank"}
    assert {key: after.header[key] for key in untouched} == {key: before.header[key] for key in untouched}
    assert model_space(after) == model_space(before)


def test_a_further_label_has_its_level_tone_and_licence(extended: Path) -> None:
    model = read_model_file(extended)
    label = model.header["labels"][-1]
    assert len(label["level"]["speeds_mps"]) == len(label["level"]["log_levels"])
    tone = label["tone"]
    assert len(tone["gains_db"]) == len(tone["speeds_mps"]) * len(tone["forces_newtons"])
    assert label["provenance"]["licence"] == "CC BY 4.0"
    assert label["embedding_row"] == len(model.tensors["embedding"]) - 1


def test_a_material_file_and_a_label_hold_the_same_material() -> None:
    material, model = read_material(RIBBED), with_label(read_model_file(TINY), read_material(RIBBED))
    label = model.header["labels"][-1]
    assert {key: label[key] for key in ("level", "tone", "provenance", "friction_coefficient")} == {
        key: material[key] for key in ("level", "tone", "provenance", "friction_coefficient")
    }
    assert "embedding" not in label and "seeds" not in label
    assert model.tensors["embedding"][-1] == pytest.approx(material["embedding"])


def test_a_model_with_a_seed_bank_takes_the_seeds_of_a_further_label() -> None:
    before, material = read_model_file(TINY), read_material(RIBBED)
    after = with_label(before, material)
    stated = [{"label": "ribbed", **{key: seed[key] for key in seed if key != "samples"}} for seed in material["seeds"]]
    assert after.header["seed_bank"]["entries"] == [*before.header["seed_bank"]["entries"], *stated]
    seeds = [*before.tensors["seeds"], *(seed["samples"] for seed in material["seeds"])]
    np.testing.assert_allclose(after.tensors["seeds"], seeds)


def test_a_model_with_a_seed_bank_takes_a_label_without_seeds() -> None:
    before = read_model_file(TINY)
    after = with_label(before, read_material(RIBBED.with_name("plain-twin.haptomaterial")))
    assert after.header["labels"][-1]["name"] == "plain twin"
    assert after.header["seed_bank"] == before.header["seed_bank"]
    np.testing.assert_array_equal(after.tensors["seeds"], before.tensors["seeds"])


def test_a_name_that_the_model_has_is_refused_and_nothing_is_written(
    recording: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "x.haptoflow"
    assert add("--recording", recording, "--name", "Wood", "-o", out) == 3
    assert "'wood' already; choose another --name" in capsys.readouterr().err
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


def test_a_recording_that_is_too_short_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    short = csv_one_axis(tmp_path / "short", "a", "a", stroke(1.5))
    assert add("--recording", short, "-o", tmp_path / "x.haptomaterial") == 3
    assert "the recording lasts 1.5 s; record 10 s or more" in capsys.readouterr().err
    assert not (tmp_path / "x.haptomaterial").exists()


def test_given_wave_vectors_are_used(
    recording: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
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
    model: ModelFile = read_model_file(DEFAULT)
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
    for label in ("wood", "corduroy"):
        before = render_wav(tmp_path / f"{label}-before", label, "--model", DEFAULT)
        assert render_wav(tmp_path / f"{label}-after", label, "--model", extended) == before


def test_the_engine_renders_the_further_label_and_the_material_file_alike(tmp_path: Path) -> None:
    material = ROOT / "Tests" / "Golden" / "material" / "denim.haptomaterial"
    model = tmp_path / "denim.haptoflow"
    write_model_file(model, with_label(read_model_file(DEFAULT), read_material(material)))
    folders = tmp_path / "label", tmp_path / "file"
    render_wav(folders[0], "denim", "--model", model)
    render_wav(folders[1], "denim", "--model", DEFAULT, "--material", material)
    waves = [read_wav(folder / "out.wav") for folder in folders]
    levels = [20.0 * math.log10(float(np.sqrt(np.square(wave, dtype=np.float64).mean()))) for wave in waves]
    assert levels[0] == pytest.approx(levels[1], abs=1.5)


def test_the_help_has_examples(capsys: pytest.CaptureFixture[str]) -> None:
    for program, run, command in (
        ("haptoflow-training", main, "add-material"),
        ("haptoflow-training", main, "sliders"),
        ("haptoflow-paper", paper.main, "few-shot"),
    ):
        with pytest.raises(SystemExit):
            run([command, "--help"])
        said = capsys.readouterr().out
        assert f"{program} {command} --model" in said
