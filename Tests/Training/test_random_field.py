"""Random fields that never repeat: their statistics, and strokes that never meet the same heights again."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import detrend

from haptoflow_training.preprocessing.pipeline import preprocess_recording
from haptoflow_training.preprocessing.settings import PreprocessingSettings
from haptoflow_training.recordings.synthetic import load_materials, record_condition
from haptoflow_training.recordings.synthetic.features import impact_acceleration
from haptoflow_training.recordings.synthetic.surface import OCTAVE_WAVELENGTHS_MM, RandomField, TipPath

MATERIALS = {material.label: material for material in load_materials()}
STROKE_MM = 30_000.0
# An octave is silent above a certain rate, so half a minute meets at most this many wavelengths.
MAXIMUM_WAVES = 30 * 2000


def _line(count: int, step_mm: float, degrees: float) -> np.ndarray:
    angle = np.radians(degrees)
    return np.arange(count)[:, None] * step_mm * np.array([np.cos(angle), np.sin(angle)]) + np.array([12.0, -7.0])


def _autocorrelation(values: np.ndarray) -> np.ndarray:
    """Normalised, at lags from 0 to half the length; each lag divided by what overlaps."""
    count = len(values)
    power = np.abs(np.fft.rfft(np.concatenate([values - values.mean(), np.zeros(count)]))) ** 2
    raw = np.fft.irfft(power)[: count // 2] / (count - np.arange(count // 2))
    return raw / raw[0]


@pytest.mark.parametrize("octave", range(len(OCTAVE_WAVELENGTHS_MM)))
@pytest.mark.parametrize("degrees", [0.0, 17.0])
def test_no_octave_repeats_along_thirty_metres_or_half_a_minute_of_straight_stroke(octave: int, degrees: float) -> None:
    wavelength = OCTAVE_WAVELENGTHS_MM[octave]
    step = wavelength / 4.0
    count = 4 * min(int(STROKE_MM / wavelength), MAXIMUM_WAVES)
    seen = _autocorrelation(RandomField(1003, 0, octave, wavelength).at(_line(count, step, degrees)))
    # Six standard deviations of a correlation over as many independent wavelengths as the stroke has.
    chance = 6.0 / np.sqrt(0.5 * count * step / wavelength)
    beyond_the_main_lobe = np.abs(seen[4 * 6 :])
    assert beyond_the_main_lobe.max() < chance, np.argmax(beyond_the_main_lobe) * step


def test_asperities_neither_repeat_nor_keep_a_beat_along_thirty_metres_of_straight_stroke() -> None:
    rate = 8000.0
    velocity = np.tile([1000.0, 0.0], (int(30 * rate), 1))
    path = TipPath(np.cumsum(velocity, axis=0) / rate, velocity)
    for label in ("stone", "concrete", "brick", "sandpaper"):
        impulses = impact_acceleration(MATERIALS[label], path, rate, specimen=2)
        struck = impulses != np.median(impulses)
        assert 0.7 < np.sum(struck) * MATERIALS[label].impact_spacing_mm / (
            STROKE_MM * MATERIALS[label].impact_density
        ) < 1.1
        # Both strength and time: a repeated table shows in the first, a regular grid in the second.
        assert np.abs(_autocorrelation(impulses)[1:]).max() < 0.06, label
        assert np.abs(_autocorrelation(struck.astype(float))[8:]).max() < 0.06, label


def test_a_field_has_unit_power_and_the_same_spectrum_in_every_direction_and_place() -> None:
    field = RandomField(1000, 3, 2, 1.0)
    spectra = []
    for degrees in (0.0, 30.0, 45.0, 90.0, 137.0):
        values = field.at(_line(240_000, 0.125, degrees))
        assert np.sqrt(np.mean(values**2)) == pytest.approx(1.0, abs=0.01)
        assert np.mean(values**4) == pytest.approx(3.0, abs=0.1)
        halves = values.reshape(2, -1).std(axis=1)
        assert halves[0] / halves[1] == pytest.approx(1.0, abs=0.03)
        power = (np.abs(np.fft.rfft(values.reshape(-1, 800), axis=1)) ** 2).mean(axis=0)
        spectra.append(power[5:141].reshape(-1, 8).mean(axis=1))
    mean = np.mean(spectra, axis=0)
    heard = mean > 0.01 * mean.max()
    assert np.abs(np.array(spectra)[:, heard] / mean[heard] - 1.0).max() < 0.12


def test_a_field_is_smooth_across_the_borders_of_its_patches() -> None:
    values = RandomField(1000, 3, 2, 1.0).at(_line(400_000, 0.02, 3.0))
    bend = np.abs(np.diff(values, 2))
    assert bend.max() < 6.5 * np.sqrt(np.mean(bend**2))


@pytest.mark.parametrize("label", ["wood", "sandpaper"])
def test_the_fine_structure_of_two_straight_recordings_of_one_condition_is_uncorrelated(label: str) -> None:
    """A repeated surface would have the same lines, every few hertz, at any start: a correlation of 0.9 with
    periodic tiles."""
    lines = []
    for seed in (1, 2):
        recording = record_condition(
            MATERIALS[label], velocity_mps=(1.0, 0.0), force_newtons=1.0, duration_seconds=24.6, seed=seed, specimen=0
        )
        wave = preprocess_recording(recording, PreprocessingSettings()).waveform_mps2[:48_000]
        spectrum = np.log(np.abs(np.fft.rfft(wave * np.hanning(len(wave))))[24 * 40 : 24 * 500] + 1e-9)
        # The fine structure that remains once the spectrum's shape is removed.
        lines.append(detrend(spectrum, bp=np.arange(0, len(spectrum), 480)))
    assert abs(np.corrcoef(lines)[0, 1]) < 0.05
