"""Ribs are found in recordings as training has them; the library's own tests say how well."""

from __future__ import annotations

import dataclasses
import json
from pathlib import Path

import numpy as np
import pytest

from haptoflow_training.preprocessing.pipeline import preprocess_recording
from haptoflow_training.recordings.native_recording import estimate_wave_vectors
from haptoflow_training.recordings.native_recording import MaterialRecording
from haptoflow_training.recordings.synthetic import Material, load_materials, machine_conditions, record_condition_of

MATERIALS = load_materials()
GOLDEN = Path(__file__).parents[1] / "Golden" / "wave-vectors"


def test_recordings_that_are_joined_have_the_wave_vectors_stated_in_their_file_and_none_has_none() -> None:
    golden = json.loads((GOLDEN / "jute.json").read_text(encoding="utf-8"))
    velocity = np.concatenate([np.tile(each["velocity_mps"], (each["samples"], 1)) for each in golden["strokes"]])
    wave = np.float32(golden["scale_mps2"]) * np.array(golden["wave"], dtype=np.float32)
    force = np.full(len(wave), golden["force_newtons"], dtype=np.float32)
    whole = MaterialRecording(wave, np.column_stack([velocity, force]).astype(np.float32))
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
        pieces = preprocess_recording(made)
        prepared.append(
            MaterialRecording(pieces.waveform_mps2, pieces.motion)
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
