"""Ribs are found in recordings: within 2 % where there are some, none where there are none."""

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
from haptoflow_training.recordings.synthetic import (
    Material,
    load_materials,
    machine_conditions,
    record_condition,
    record_condition_of,
)

MATERIALS = load_materials()
RATE_HZ = 2000
GOLDEN = Path(__file__).parents[1] / "Golden" / "wave-vectors"


def straight_strokes(seconds: float, seed: int, slowest: float = 0.05, fastest: float = 0.35) -> np.ndarray:
    """Velocities [n, 2] in m/s: a new direction every 0.6 s, each at a speed of its own."""
    generator = np.random.default_rng(seed)
    count = int(np.ceil(seconds / 0.6))
    speed = np.exp(generator.uniform(np.log(slowest), np.log(fastest), count))
    angle = 2.4 * np.arange(count) + generator.uniform(0.0, 2.0 * np.pi)
    pieces = speed[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
    return np.repeat(pieces, round(0.6 * RATE_HZ), axis=0)[: int(seconds * RATE_HZ)]


def recorded(material: Material, seed: int, velocity: np.ndarray) -> MaterialRecording:
    recording = record_condition(
        material, velocity_mps=(velocity[:, 0], velocity[:, 1]), force_newtons=1.0,
        duration_seconds=len(velocity) / RATE_HZ, seed=seed,
    )  # fmt: skip
    made = preprocess_recording(recording, PreprocessingSettings())
    return MaterialRecording("", material.label, made.waveform_mps2, made.motion[:, :2], made.motion[:, 2], "", "")


@pytest.mark.parametrize("material", MATERIALS, ids=lambda material: material.label)
def test_every_family_of_ribs_is_found_within_2_percent_and_none_on_a_surface_without(material: Material) -> None:
    seed = 100 + material.texture_id
    # Uneven threads have another spacing at every place; their mean is estimated from several.
    places = 4 if any(ruling.jitter > 0.05 for ruling in material.rulings) else 1
    strokes = [recorded(material, seed + place, straight_strokes(12.0, seed + place)) for place in range(places)]
    found = estimate_wave_vectors(strokes)
    wanted = [np.array(vector) for vector in material.wave_vectors_per_mm]
    assert len(found) == len(wanted)
    for vector in wanted:
        errors = [min(np.linalg.norm(np.array(one) - vector), np.linalg.norm(np.array(one) + vector)) for one in found]
        assert min(errors) < 0.02 * np.linalg.norm(vector)


def lined(velocity: np.ndarray, line: np.ndarray, seed: int = 0) -> MaterialRecording:
    """Noise with a line of a third of its power."""
    noise = np.random.default_rng(seed).standard_normal(len(velocity))
    wave = (noise + 0.8 * np.sqrt(2.0) * line).astype(np.float32)
    return MaterialRecording("", "", wave, velocity.astype(np.float32), np.ones(len(wave), dtype=np.float32), "", "")


def place_mm(velocity: np.ndarray) -> np.ndarray:
    return np.cumsum(velocity, axis=0) * 1000.0 / RATE_HZ


def test_ribs_of_any_direction_are_found() -> None:
    velocity = straight_strokes(12.0, 3)
    vector = np.array([-0.31, 0.62])
    (found,) = estimate_wave_vectors([lined(velocity, np.sin(2.0 * np.pi * place_mm(velocity) @ vector))])
    assert np.linalg.norm(np.array(found) - vector) < 0.02 * np.linalg.norm(vector)


def test_a_resonance_that_does_not_follow_the_speed_is_not_a_rib() -> None:
    velocity = straight_strokes(12.0, 4)
    time = np.arange(len(velocity)) / RATE_HZ
    assert estimate_wave_vectors([lined(velocity, np.sin(2.0 * np.pi * 140.0 * time))]) == ()


def test_one_speed_in_one_direction_gives_no_wave_vector() -> None:
    velocity = np.tile([0.15, 0.0], (12 * RATE_HZ, 1))
    assert estimate_wave_vectors([lined(velocity, np.sin(2.0 * np.pi * place_mm(velocity) @ [0.8, 0.0]))]) == ()


def test_one_direction_at_several_speeds_gives_the_ribs_along_it() -> None:
    speed = np.repeat(np.tile([0.06, 0.11, 0.2, 0.33], 5), round(0.6 * RATE_HZ))
    velocity = np.column_stack([speed, 0.0 * speed])
    (found,) = estimate_wave_vectors([lined(velocity, np.sin(2.0 * np.pi * place_mm(velocity) @ [0.8, 0.3]))])
    assert abs(found[0]) == pytest.approx(0.8, rel=0.02)


def test_a_short_path_gives_no_wave_vector_and_no_error() -> None:
    assert estimate_wave_vectors([]) == ()
    velocity = straight_strokes(1.0, 5)
    assert estimate_wave_vectors([lined(velocity, np.zeros(len(velocity)))]) == ()
    assert estimate_wave_vectors([lined(np.zeros((4000, 2)), np.zeros(4000))]) == ()


@pytest.mark.parametrize(("name", "count"), [("corduroy", 1), ("jute", 2), ("sandpaper", 0)])
def test_the_golden_recordings_have_the_wave_vectors_stated_in_their_files(name: str, count: int) -> None:
    golden = json.loads((GOLDEN / f"{name}.json").read_text(encoding="utf-8"))
    velocity = np.concatenate([np.tile(each["velocity_mps"], (each["samples"], 1)) for each in golden["strokes"]])
    wave = np.float32(golden["scale_mps2"]) * np.array(golden["wave"], dtype=np.float32)
    force = np.full(len(wave), golden["force_newtons"], dtype=np.float32)
    found = estimate_wave_vectors([MaterialRecording("", "", wave, velocity.astype(np.float32), force, "", "")])
    expected = golden["wave_vectors_per_mm"]
    assert len(found) == len(expected) == count
    for one, other in zip(found, expected, strict=True):
        assert np.hypot(*np.subtract(one, other)) < 0.002 * np.hypot(*other)


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


@pytest.mark.parametrize(
    ("label", "wavelength_mm", "expected"),
    [
        ("corduroy", 2.5, [(0.4, 0.0)]),
        ("corduroy", 1.0, [(1.0, 0.0)]),
        ("wood", None, []),
    ],
)
def test_a_machine_s_few_directions_show_the_ribs_and_no_vector_that_shares_lines_with_them(
    label: str, wavelength_mm: float | None, expected: list[tuple[float, float]]
) -> None:
    material = next(one for one in MATERIALS if one.label == label)
    if wavelength_mm is not None:
        ruling = dataclasses.replace(material.rulings[0], wavelength_mm=wavelength_mm)
        material = dataclasses.replace(material, rulings=(ruling,))
    found = estimate_wave_vectors(_scanned(material))
    assert len(found) == len(expected)
    for vector in expected:
        distances = [min(np.hypot(x - vector[0], y - vector[1]), np.hypot(x + vector[0], y + vector[1])) for x, y in found]
        assert min(distances) < 0.035 * np.hypot(*vector) + 0.02


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
