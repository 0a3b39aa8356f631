from __future__ import annotations

import ctypes

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import signal

from haptoflow_training.native_library import native_library
from haptoflow_training.preprocessing.dft321 import dft321
from haptoflow_training.recordings.native_recording import as_native

RATE_HZ = 8000

CENTRES_HZ = 1000.0 * 2.0 ** (np.arange(-17, 0) / 3.0)


def band_levels_db(axes: NDArray[np.float64]) -> NDArray[np.float64]:
    """Third-octave energies of all axes together, 20-800 Hz bands (upper edge 891 Hz)."""
    spectrum = np.abs(np.fft.rfft(axes, axis=0)) ** 2
    power = spectrum.sum(axis=1) if spectrum.ndim == 2 else spectrum
    frequencies = np.fft.rfftfreq(len(axes), 1.0 / RATE_HZ)
    edge = 2.0 ** (1.0 / 6.0)
    return 10 * np.log10(
        [power[(frequencies >= c / edge) & (frequencies < c * edge)].sum() for c in CENTRES_HZ]
    )


def broadband(seconds: float, seed: int = 3) -> NDArray[np.float64]:
    noise = np.random.default_rng(seed).standard_normal((int(seconds * RATE_HZ), 3))
    return signal.sosfilt(signal.butter(2, [15, 1500], "bandpass", fs=RATE_HZ, output="sos"), noise, axis=0)


def resonant(noise: NDArray[np.float64], low: float, high: float) -> NDArray[np.float64]:
    return signal.sosfilt(signal.butter(1, [low, high], "bandpass", fs=RATE_HZ, output="sos"), noise)


def one_source_through_three_transfers() -> NDArray[np.float64]:
    noise = broadband(4.0)
    return np.column_stack(
        [
            0.2 * noise[:, 0],
            1.5 * resonant(noise[:, 0], 150, 300),
            0.1 * signal.lfilter([1.0], [1.0, -0.9], -noise[:, 0]) + 0.1 * noise[:, 1],
        ]
    )


def nearly_cancelling_axes() -> NDArray[np.float64]:
    noise = broadband(4.0)
    return np.column_stack([noise[:, 0], -noise[:, 0] + 0.3 * noise[:, 1], 0.2 * noise[:, 2]])


@pytest.mark.parametrize("axes", [one_source_through_three_transfers, nearly_cancelling_axes])
def test_dft321_keeps_every_third_octave_energy_within_half_a_decibel(axes) -> None:
    three = axes()
    difference = band_levels_db(dft321(three, RATE_HZ)) - band_levels_db(three)
    assert np.abs(difference).max() < 0.5


@pytest.mark.parametrize("axis", [0, 2])
def test_dft321_returns_a_one_axis_input_unchanged(axis: int) -> None:
    three = np.zeros((12345, 3))
    three[:, axis] = broadband(2.0)[:12345, 0]
    assert np.abs(dft321(three, RATE_HZ) - three[:, axis]).max() < 1e-9 * np.abs(three).max()


def test_dft321_of_axes_that_cancel_exactly_still_has_their_energy() -> None:
    noise = broadband(2.0)[:, 0]
    one = dft321(np.column_stack([noise, -noise, np.zeros_like(noise)]), RATE_HZ)
    assert np.all(np.isfinite(one))
    assert np.sum(one**2) / (2 * np.sum(noise**2)) == pytest.approx(1.0, abs=0.02)


@pytest.mark.parametrize("count", [1, 139, 140, 281])
def test_dft321_keeps_the_length_of_inputs_around_the_frame_length(count: int) -> None:
    one = dft321(broadband(1.0)[:count], RATE_HZ)
    assert one.shape == (count,)
    assert np.all(np.isfinite(one))


def combined_by_the_library(axes: NDArray[np.float64]) -> NDArray[np.float32]:
    """One axis of 10 to 1000 Hz, as learning hears axes [n, 1 or 3] at 2 kHz."""
    wave = np.zeros(len(axes), np.float32)
    with as_native(axes.astype(np.float32), np.zeros((len(axes), 2), np.float32), wave) as handle:
        pointer = wave.ctypes.data_as(ctypes.POINTER(ctypes.c_float))
        native_library().call("haptoflow_recording_wave", handle, pointer, ctypes.c_uint64(len(wave)))
    return wave


def test_training_combines_axes_as_learning_does() -> None:
    three = np.random.default_rng(4).standard_normal((8000, 3)) @ np.array([[1.0, 0.5, -0.6], [0.3, 0.8, 0.4], [0.1, 0.1, 1.2]])
    banded = np.column_stack([combined_by_the_library(axis[:, None]) for axis in three.T])
    difference = dft321(banded, 2000.0) - combined_by_the_library(three)
    assert np.sqrt(np.mean(difference[100:-100] ** 2)) < 0.01 * np.sqrt(np.mean(banded**2) * 3.0)
