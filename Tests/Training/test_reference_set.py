"""The reference recordings: the two of a pair share the process, not the place."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from haptoflow_paper.rows import reference_set as subject
from haptoflow_paper.rows.reference_conditions import CONSTANT_SPEEDS_MPS, Condition, conditions
from haptoflow_paper.rows.reference_set import known_phases, record_pair
from haptoflow_training.recordings.synthetic import FURTHER_SPECIMENS, HELD_OUT_SPECIMEN, Material, load_materials
from haptoflow_training.recordings.synthetic.surface import TRAINING_SPECIMENS

MATERIALS = load_materials()
CHOSEN = conditions(MATERIALS)


def _material(label: str) -> Material:
    return next(entry for entry in MATERIALS if entry.label == label)


def _first(label: str, kind: str, **wanted: object) -> Condition:
    for entry in CHOSEN:
        if entry.label == label and entry.kind == kind and all(getattr(entry, k) == v for k, v in wanted.items()):
            return entry
    raise AssertionError((label, kind, wanted))


def test_the_grid_covers_slow_to_fast_and_light_to_firm_on_every_label() -> None:
    assert min(CONSTANT_SPEEDS_MPS) == 0.01 and max(CONSTANT_SPEEDS_MPS) == 1.5
    for material in MATERIALS:
        own = [entry for entry in CHOSEN if entry.label == material.label]
        assert {entry.speed_mps for entry in own if entry.kind == "constant"} >= set(CONSTANT_SPEEDS_MPS)
        assert {entry.kind for entry in own} >= {"constant", "reversal", "stop", "varying", "change"}
        forces = [entry.force_newtons for entry in own if entry.kind == "constant"]
        assert min(forces) == 0.2 and max(forces) == 3.0


def test_two_recordings_are_of_the_held_out_specimen_and_the_third_of_one_that_no_training_knows_either(monkeypatch: pytest.MonkeyPatch) -> None:
    specimens: list[int] = []

    def spy(*arguments: Any, **named: Any) -> Any:
        specimens.append(named["specimen"])
        return record(*arguments, **named)

    record = subject.record_condition
    monkeypatch.setattr(subject, "record_condition", spy)
    condition = dataclasses.replace(_first("glass", "change"), seconds=1.0)
    record_pair((condition, _material("glass"), MATERIALS[condition.other_index]))
    further = FURTHER_SPECIMENS[condition.seed % len(FURTHER_SPECIMENS)]
    assert specimens == [HELD_OUT_SPECIMEN, HELD_OUT_SPECIMEN, further] * 2
    assert not {HELD_OUT_SPECIMEN, *FURTHER_SPECIMENS} & set(TRAINING_SPECIMENS)


def test_the_phase_of_the_ribs_is_that_of_the_place_on_the_surface_where_the_recording_is() -> None:
    # Ribs of corduroy's height: the recorded power is modulated with the phase of the place, at its start and later.
    condition = dataclasses.replace(_first("corduroy", "constant", speed_mps=0.03), seconds=6.0)
    pair = record_pair((condition, _material("corduroy"), _material("glass")))
    ruling = _material("corduroy").dominant_ruling
    assert ruling is not None
    embedding = np.zeros(64, dtype=np.float32)
    embedding[-4] = 1.0 / ruling.wavelength_mm
    samples = np.arange(len(pair.recorded))
    phase = known_phases(pair, embedding, samples)
    assert np.all(phase[:, [1, 2, 4, 5]] == 0.0) and 0.0 <= phase[:, :3].min() and phase[:, :3].max() < 1.0
    # Corduroy's ribs wander a little.
    assert np.median(phase[:, 3]) == pytest.approx(condition.rib_rates_hz[0], rel=5e-3)
    turned = np.diff(np.unwrap(2.0 * np.pi * phase[:, 0])).mean() * 2000.0 / (2.0 * np.pi)
    assert turned == pytest.approx(condition.rib_rates_hz[0], rel=1e-3)
    swing = [
        np.angle(np.sum(np.square(part, dtype=np.float64) * np.exp(-2j * np.pi * at)))
        for part, at in zip(np.array_split(pair.recorded, 4), np.array_split(phase[:, 0], 4), strict=True)
    ]
    assert np.abs(np.angle(np.exp(1j * np.subtract(swing, swing[0])))).max() < 0.8


def test_recordings_are_made_anew_where_the_recorder_s_code_has_changed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    condition = dataclasses.replace(_first("glass", "stop"), seconds=1.0)
    monkeypatch.setattr(subject, "conditions", lambda materials: [condition])
    counted: list[int] = []
    first = subject.reference_set(tmp_path / "cache.npz", 1, counted.append)
    written = (tmp_path / "cache.npz").stat().st_mtime_ns
    again = subject.reference_set(tmp_path / "cache.npz", 1, counted.append)
    assert (tmp_path / "cache.npz").stat().st_mtime_ns == written and counted == [1, 1]
    np.testing.assert_array_equal(first[0].recorded, again[0].recorded)
    for name in ("independent", "other_specimen", "wander_turns"):
        np.testing.assert_array_equal(getattr(first[0], name), getattr(again[0], name))
    assert not np.array_equal(first[0].other_specimen, first[0].independent)
    assert again[0].start_mm == pytest.approx(first[0].start_mm) and again[0].condition == condition
    monkeypatch.setattr(subject, "_recorder_crc32", lambda: "other")
    subject.reference_set(tmp_path / "cache.npz", 1, counted.append)
    assert (tmp_path / "cache.npz").stat().st_mtime_ns != written
