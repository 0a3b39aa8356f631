"""Measures of a generated waveform that only the rows of the comparison have; results/accuracy-and-time.md defines
every figure.

All waveforms are one-dimensional, 2 kHz, m/s^2.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from haptoflow_benchmark.waveform_metrics import power_spectrum, rms
from haptoflow_training.waveform import SAMPLE_RATE_HZ

# Bark band edges (Zwicker 1961) inside the band that the system renders.
CRITICAL_BAND_EDGES_HZ = (20.0, 100.0, 200.0, 300.0, 400.0, 510.0, 630.0, 770.0, 920.0, 1000.0)
# The system's waveforms begin at 20 Hz; slower ribs are felt only as modulation of the power.
_MINIMUM_LINE_HZ = 25.0
_COHERENCE_LAG_SECONDS = 0.5
_FLOOR, _POWER_FLOOR = 1e-9, 1e-12
_FREQUENCY_POINTS = 1 << 16

_Wave = NDArray[np.floating]
_Doubles = NDArray[np.float64]


def gfc_segment(generated: _Wave, recorded: _Wave, segment: int = 200) -> float:
    """The GFC segment by segment, averaged, as the paper reports it. Correct randomness lowers it by about 0.2."""
    count = min(len(generated), len(recorded)) // segment
    window = np.hanning(segment + 1)[:-1]
    cut = [np.asarray(wave[: count * segment], dtype=np.float64) for wave in (generated, recorded)]
    pair = [np.abs(np.fft.rfft(wave.reshape(count, segment) * window, 1024)) for wave in cut]
    product = (pair[0] * pair[1]).sum(axis=1)
    return float((product / (np.sqrt((pair[0] ** 2).sum(axis=1) * (pair[1] ** 2).sum(axis=1)) + _FLOOR)).mean())


def relative_rmse(generated: _Wave, recorded: _Wave) -> float:
    """RMS of the sample differences over the recording's RMS: 1 for silence, 1.41 for an independent draw."""
    difference = np.asarray(generated, dtype=np.float64) - recorded
    return rms(difference) / (rms(recorded) + _FLOOR)


def critical_band_errors_db(generated: _Wave, recorded: _Wave) -> _Doubles:
    """Signed level error in each of the nine critical bands, [9]."""
    window = 512
    frequency = np.fft.rfftfreq(window, 1.0 / SAMPLE_RATE_HZ)
    spectra = [power_spectrum(wave, window) for wave in (generated, recorded)]
    edges = zip(CRITICAL_BAND_EDGES_HZ[:-1], CRITICAL_BAND_EDGES_HZ[1:], strict=True)
    bands = [(frequency >= low) & (frequency < high) for low, high in edges]
    sums = [[spectrum[band].sum() + _FLOOR for band in bands] for spectrum in spectra]
    return 10.0 * np.log10(np.array(sums[0]) / np.array(sums[1]))


def harmonic_share(wave: _Wave, fundamental: float) -> float:
    """Share of the power within 3 % of the fundamental's multiples."""
    wave = np.asarray(wave, dtype=np.float64)
    power = np.square(np.abs(np.fft.rfft(wave * np.hanning(len(wave)))))
    frequency = np.fft.rfftfreq(len(wave), 1.0 / SAMPLE_RATE_HZ)
    order = np.maximum(1.0, np.round(frequency / fundamental))
    near = np.abs(frequency - order * fundamental) <= 0.03 * fundamental
    return float(power[near].sum() / (power[frequency >= 5.0].sum() + _FLOOR))


def drift_db_per_minute(wave: _Wave) -> float:
    """Slope of the level over pieces of one second."""
    seconds = len(wave) // SAMPLE_RATE_HZ
    pieces = np.asarray(wave[: seconds * SAMPLE_RATE_HZ], dtype=np.float64).reshape(seconds, SAMPLE_RATE_HZ)
    level = 10.0 * np.log10(np.square(pieces).mean(axis=1) + _FLOOR)
    return 60.0 * float(np.polyfit(np.arange(seconds), level, 1)[0])


def kink_db(levels_db: _Doubles) -> float:
    """The largest second difference of a level curve sampled evenly in log speed."""
    return float(np.abs(np.diff(levels_db, 2)).max())


def rib_coherence(wave: _Wave, rib_rate_hz: float) -> float:
    """How well the ribs keep their phase over half a second: |E[z(t + 0.5 s) z*(t)]| / E|z|^2, 0 to 1.

    z is the waveform times e^(-2 pi i f t), averaged by a Hann window of half a second, so that values half a second
    apart share no samples and a line exactly at f does not rotate. For constant straight strokes. Below 25 Hz, where
    the system's waveforms have no fundamental, z is computed from the power x^2, which is modulated at the same rate.
    """
    values = np.asarray(wave, dtype=np.float64)
    if rib_rate_hz < _MINIMUM_LINE_HZ:
        values = np.square(values)
    values = values - values.mean()
    length = int(SAMPLE_RATE_HZ * _COHERENCE_LAG_SECONDS)
    hop = length // 10
    turned = values * np.exp(-2j * np.pi * rib_rate_hz * np.arange(len(values)) / SAMPLE_RATE_HZ)
    frames = np.lib.stride_tricks.sliding_window_view(turned, length)[::hop]
    z = frames @ np.hanning(length + 1)[:-1]
    later, earlier = z[10:], z[:-10]
    if len(later) == 0:
        raise ValueError("a wave of a second and a half at least is needed to follow ribs over half a second")
    power = 0.5 * (np.square(np.abs(later)).mean() + np.square(np.abs(earlier)).mean())
    return float(np.abs((later * earlier.conj()).mean()) / (power + _POWER_FLOOR))


def fundamental_hz(wave: _Wave, expected_hz: float) -> float:
    """The strongest line within 12 % of `expected_hz`, interpolated between bins by zero-padding."""
    wave = np.asarray(wave, dtype=np.float64)
    spectrum = np.abs(np.fft.rfft(wave * np.hanning(len(wave)), _FREQUENCY_POINTS))
    frequency = np.fft.rfftfreq(_FREQUENCY_POINTS, 1.0 / SAMPLE_RATE_HZ)
    near = np.flatnonzero(np.abs(frequency - expected_hz) <= 0.12 * expected_hz)
    return float(frequency[near[np.argmax(spectrum[near])]])


def hop_jump_ratio(wave: _Wave, hop_starts: NDArray[np.int64]) -> float:
    """RMS of the sample differences at hop boundaries over that of all others: 1 means that seams cannot be
    detected."""
    differences = np.diff(np.asarray(wave, dtype=np.float64))
    at = np.zeros(len(differences), dtype=np.bool_)
    inside = hop_starts[(hop_starts > 0) & (hop_starts <= len(differences))]
    at[inside - 1] = True
    return rms(differences[at]) / (rms(differences[~at]) + _FLOOR)
