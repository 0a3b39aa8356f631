"""Ribs are found in recordings as training has them; the library's own tests say how well."""

from __future__ import annotations

import dataclasses
import json
from pathlib import Path

import numpy as np
import pytest

from haptoflow_benchmark import wave_vector_study
from haptoflow_benchmark.cli import main
from haptoflow_benchmark.wave_vector_study import measured, study_surfaces
from haptoflow_training.preprocessing.pipeline import preprocess_recording
from haptoflow_training.preprocessing.settings import PreprocessingSettings
from haptoflow_training.preprocessing.wave_vectors import estimate_wave_vectors
from haptoflow_training.recordings.material_recording import MaterialRecording
from haptoflow_training.recordings.synthetic import Material, load_materials, machine_conditions, record_condition_of

MATERIALS = load_materials()
GOLDEN = Path(__file__).parents[1] / "Golden" / "wave-vectors"


def test_recordings_that_are_joined_have_the_wave_vectors_stated_in_their_file_and_none_has_none() -> None:
    golden = json.loads((GOLDEN / "jute.json").read_text(encoding="utf-8"))
    velocity = np.concatenate([np.tile(each["velocity_mps"], (each["samples"], 1)) for each in golden["strokes"]])
    wave = np.float32(golden["scale_mps2"]) * np.array(golden["wave"], dtype=np.float32)
    force = np.full(len(wave), golden["force_newtons"], dtype=np.float32)
    whole = MaterialRecording("", "", wave, velocity.astype(np.float32), force, "", "")
    expected = golden["wave_vectors_per_mm"]
    for recordings in ([whole], [whole, whole]):
        found = estimate_wave_vectors(recordings)
        assert len(found) == len(expected) == 2
        for one, other in zip(found, expected, strict=True):
            assert np.hypot(*np.subtract(one, other)) < (0.002 if len(recordings) == 1 else 0.02) * np.hypot(*other)
    assert estimate_wave_vectors([]) == ()


def _scanned(material: Material) -> list[MaterialRecording]:
    """Passes of the machine: four axes, forwards and backwards, at three speeds."""
    prepared = []
    for identity in machine_conditions(material, speeds_mmps=(20, 40, 60), forces_millinewtons=(500,), repeats=1):
        made = record_condition_of(material, identity, seed=3, accelerometer_noise=False)
        pieces = preprocess_recording(made, PreprocessingSettings())
        prepared.append(
            MaterialRecording(
                identity.name, material.label, pieces.waveform_mps2, pieces.motion[:, :2], pieces.motion[:, 2], "", ""
            )
        )
    return prepared


@pytest.mark.parametrize(("label", "wavelength_mm"), [("corduroy", 2.5), ("corduroy", 1.0), ("wood", None)])
def test_a_machine_s_few_directions_show_the_ribs_and_no_vector_that_shares_lines_with_them(
    label: str, wavelength_mm: float | None
) -> None:
    material = next(one for one in MATERIALS if one.label == label)
    if wavelength_mm is not None:
        ruling = dataclasses.replace(material.rulings[0], wavelength_mm=wavelength_mm)
        material = dataclasses.replace(material, rulings=(ruling,))
    found = estimate_wave_vectors(_scanned(material))
    if wavelength_mm is None:
        assert found == ()
        return
    ((x, y),) = found
    wanted = 1.0 / wavelength_mm
    assert min(np.hypot(x - wanted, y), np.hypot(x + wanted, y)) < 0.035 * wanted + 0.02



ROOT = Path(__file__).parents[2]


def test_found_missed_and_wrong_vectors_are_counted_separately(monkeypatch: pytest.MonkeyPatch) -> None:
    surfaces = list(study_surfaces())
    corduroy = next(each for each in surfaces if each.name == "corduroy")
    mesh = next(each for each in surfaces if each.name == "metal mesh")
    glass = next(each for each in surfaces if each.name == "glass")
    answers = iter(
        [
            ((-0.404, 0.0),), ((0.4, 0.0), (0.2, 0.7)),
            ((0.833, 0.0),), ((0.833, 0.02), (0.0, 0.87)),
            (), ((0.3, 0.3),),
        ]  # fmt: skip
    )
    monkeypatch.setattr(wave_vector_study, "make_rides", lambda *_, **__: ())
    monkeypatch.setattr(wave_vector_study, "estimate_wave_vectors", lambda _: next(answers))
    totals = measured([corduroy, mesh, glass])["totals"]
    assert totals["10"] == {
        "ruled_surfaces": 2, "families": 3, "within_2_percent": 2, "within_5_percent": 2,
        "wrong_on_ruled": 0, "unruled_surfaces": 1, "wrong_on_unruled": 0,
    }  # fmt: skip
    assert totals["30"] == {
        "ruled_surfaces": 2, "families": 3, "within_2_percent": 1, "within_5_percent": 3,
        "wrong_on_ruled": 1, "unruled_surfaces": 1, "wrong_on_unruled": 1,
    }  # fmt: skip


def test_the_command_writes_what_it_counts(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["measure-wave-vectors", "--every", "60", "--results", str(tmp_path / "found.json")]) == 0
    results = json.loads((tmp_path / "found.json").read_text(encoding="utf-8"))
    assert len(results["surfaces"]) == 2
    assert "families of ribs within 2 %" in capsys.readouterr().out


def test_the_page_states_the_counts_of_the_stored_results() -> None:
    totals = json.loads((ROOT / "Training" / "results" / "wave-vectors.json").read_text(encoding="utf-8"))["totals"]
    page = (ROOT / "Documentation~" / "own-materials.md").read_text(encoding="utf-8")
    for seconds, total in totals.items():
        row = (
            f"| {seconds} s | {total['families']} | {total['within_2_percent']} | {total['within_5_percent']} | "
            f"{total['wrong_on_ruled']} | {total['wrong_on_unruled']} |"
        )
        assert row in page
