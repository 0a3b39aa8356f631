"""How much specimens of one label, and places of one specimen, differ: as materials.toml states, and nothing else."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from haptoflow_training.preprocessing.pipeline import preprocess_recording
from haptoflow_training.preprocessing.settings import PreprocessingSettings
from haptoflow_training.recordings.synthetic import (
    FURTHER_SPECIMENS,
    HELD_OUT_SPECIMEN,
    TRAINING_SPECIMENS,
    Material,
    load_materials,
    record_condition,
)
from haptoflow_training.recordings.synthetic.measurement import band_level
from haptoflow_training.recordings.synthetic.specimens import character_of, surface_gain

MATERIALS = {material.label: material for material in load_materials()}
SMOOTH = ("glass", "metal", "plastic", "paper")


def _level_and_slope(material: Material, specimen: int) -> tuple[float, float]:
    """Level in dB and slope of the spectrum in dB per octave, 50 to 400 Hz."""
    rate, size = PreprocessingSettings().sample_rate_hz, 400
    powers = []
    for seed in range(4):
        recording = record_condition(
            material, velocity_mps=(0.2, 0.06), force_newtons=1.0, duration_seconds=4.0, seed=seed, specimen=specimen,
            accelerometer_noise=False,
        )  # fmt: skip
        wave = preprocess_recording(recording, PreprocessingSettings()).waveform_mps2.astype(np.float64)
        frames = wave[: len(wave) // size * size].reshape(-1, size) * np.hanning(size)
        powers.append((np.abs(np.fft.rfft(frames, axis=1)) ** 2).mean(axis=0))
    power, frequency = np.mean(powers, axis=0), np.fft.rfftfreq(size, 1.0 / rate)
    octaves = np.log2(np.array([50.0, 100.0, 200.0, 400.0]))
    bands = [power[(frequency >= 2**at / 1.2) & (frequency <= 2**at * 1.2)].mean() for at in octaves]
    slope = np.polyfit(octaves, 10.0 * np.log10(bands), 1)[0]
    return 20.0 * np.log10(band_level(frequency, power)), float(slope)


@pytest.mark.parametrize("label", list(MATERIALS))
def test_training_specimens_are_on_average_the_label_and_spread_as_its_material_states(label: str) -> None:
    material = MATERIALS[label]
    found = [character_of(material, specimen) for specimen in TRAINING_SPECIMENS]
    levels = [each.level_db for each in found]
    tilts = [each.tilt_db_per_octave for each in found]
    for values, stated in ((levels, material.specimen_spread_db), (tilts, material.specimen_tilt_db_per_octave)):
        assert np.mean(values) == pytest.approx(0.0, abs=1e-12)
        assert np.std(values, ddof=1) == pytest.approx(stated, rel=0.05)
        assert len(set(values)) == len(TRAINING_SPECIMENS)
    assert list(np.argsort(levels)) != list(np.argsort(tilts))
    smooth = label in SMOOTH
    assert material.specimen_spread_db == (0.75 if smooth else 1.5)


def test_the_held_out_specimen_is_typical_and_further_ones_stay_within_two_deviations() -> None:
    levels = []
    for material in MATERIALS.values():
        typical = character_of(material, HELD_OUT_SPECIMEN)
        assert typical.level_db == typical.tilt_db_per_octave == 0.0
        for specimen in FURTHER_SPECIMENS:
            one = character_of(material, specimen)
            assert one == character_of(material, specimen)
            assert abs(one.level_db) <= 2.0 * material.specimen_spread_db
            assert abs(one.tilt_db_per_octave) <= 2.0 * material.specimen_tilt_db_per_octave
            levels.append(one.level_db / material.specimen_spread_db)
    assert np.mean(levels) == pytest.approx(0.0, abs=0.3) and np.std(levels) == pytest.approx(1.0, abs=0.25)


def test_a_recording_has_the_level_and_the_tilt_of_its_specimen() -> None:
    # Places are left out: a few metres of a stroke do not average them away.
    wood = replace(MATERIALS["wood"], place_spread_db=0.0)
    loud, soft = (pick(TRAINING_SPECIMENS, key=lambda one: character_of(wood, one).level_db) for pick in (max, min))
    for specimen in (loud, soft, HELD_OUT_SPECIMEN):
        level, slope = _level_and_slope(wood, specimen)
        plain_level, plain_slope = _level_and_slope(wood.without_spread, specimen)
        stated = character_of(wood, specimen)
        assert slope - plain_slope == pytest.approx(stated.tilt_db_per_octave, abs=0.05)
        # The tilt turns about 100 Hz and wood's centroid is half an octave above.
        assert level - plain_level == pytest.approx(stated.level_db, abs=0.6)
        if specimen == HELD_OUT_SPECIMEN:
            assert level == plain_level and slope == plain_slope


def _places(count: int) -> NDArray[np.float64]:
    x, y = np.meshgrid(np.linspace(-3000.0, 3000.0, count), np.linspace(-3000.0, 3000.0, count))
    return np.stack([x.ravel(), y.ravel()], axis=1)


def test_without_spread_every_specimen_and_place_is_typical() -> None:
    plain = MATERIALS["concrete"].without_spread
    for specimen in (*TRAINING_SPECIMENS, HELD_OUT_SPECIMEN, *FURTHER_SPECIMENS):
        assert np.all(surface_gain(plain, _places(10), specimen) == 1.0)
        assert character_of(plain, specimen).tilt_db_per_octave == 0.0
