"""Fits the tone of a material: the difference between its recording's spectrum and the network's output, by speed and
frequency.

Recording and closed-loop output of the same motion are compared window by window. Gains at the knots of a table over
log speed and log frequency are fitted to the powers of narrow bands as a penalised generalised linear model (Gamma
distribution, logarithmic link). Where data is scarce, the penalty draws a gain towards its neighbours and towards 0 dB.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.export.material_sound import TONE_LIMIT_DB, ToneTable
from haptoflow_training.waveform import SAMPLE_RATE_HZ

WINDOW_SAMPLES = 512
_MINIMUM_HZ, _MAXIMUM_HZ, _FREQUENCIES = 20.0, 900.0, 24
_BAND_EDGES = 56
_DECIBELS = 20.0 / math.log(10.0)

_Doubles = NDArray[np.float64]


@dataclass(frozen=True)
class ToneOptions:
    """Standard deviations in natural logarithms of the amplitude: of a gain (size), of the step from one frequency
    to the next (step), of the change of that step (bend), and of the change from one speed to the next (speed_step)."""

    size: float = 1.0
    step: float = 0.35
    bend: float = 0.25
    speed_step: float = 0.3


def band_powers(waves: NDArray[np.floating]) -> tuple[_Doubles, _Doubles, _Doubles]:
    """For waves [n, 512]: powers [n, bands], the centres of the bands in Hz, and the number of bins in each."""
    spectrum = np.square(np.abs(np.fft.rfft(np.asarray(waves, dtype=np.float64) * np.hanning(waves.shape[1]), axis=1)))
    frequency = np.fft.rfftfreq(waves.shape[1], 1.0 / SAMPLE_RATE_HZ)
    edges = np.geomspace(_MINIMUM_HZ * 0.9, 980.0, _BAND_EDGES)
    members = np.digitize(frequency, edges)
    powers, centres, counts = [], [], []
    for band in range(1, len(edges)):
        inside = members == band
        if inside.any():
            powers.append(spectrum[:, inside].mean(axis=1))
            centres.append(math.exp(float(np.log(frequency[inside]).mean())))
            counts.append(int(inside.sum()))
    return np.stack(powers, axis=1), np.array(centres), np.array(counts, dtype=np.float64)


def speed_knots(speed_mps: NDArray[np.floating], seconds: float) -> tuple[float, ...]:
    """Knots over the recorded speeds: one for a few seconds of recording, up to six for minutes."""
    low, high = (float(value) for value in np.quantile(speed_mps, [0.05, 0.95]))
    count = int(np.clip(round(1.0 + math.log2(max(seconds, 1.0))), 1, 6))
    if count == 1 or high < 1.2 * low:
        return (round(math.sqrt(low * high), 5),)
    return tuple(round(float(value), 5) for value in np.geomspace(low, high, count))


def fit_tone(
    recorded: _Doubles,
    made: _Doubles,
    centres_hz: _Doubles,
    counts: _Doubles,
    speed_mps: NDArray[np.floating],
    knots_mps: tuple[float, ...],
    options: ToneOptions = ToneOptions(),
) -> ToneTable:
    """recorded and made [windows, bands]: powers of the recording, and the expected powers of the output."""
    frequencies = np.geomspace(_MINIMUM_HZ, _MAXIMUM_HZ, _FREQUENCIES)
    across = _hats(np.log(np.clip(centres_hz, _MINIMUM_HZ, _MAXIMUM_HZ)), np.log(frequencies))
    known = np.log(np.array(knots_mps))
    along = _hats(np.clip(np.log(np.maximum(speed_mps, 1e-6)), known[0], known[-1]), known)
    floor = 1e-4 * made.mean()
    ratio = (recorded + floor) / (made + floor)
    unknowns = len(knots_mps) * _FREQUENCIES
    penalty = _penalties(len(knots_mps), known, options)
    # For Hann windows of noise that overlap by half, a bin carries about two thirds of the information of an
    # independent one.
    weight = np.broadcast_to(0.6 * counts, ratio.shape)
    gains = np.zeros(unknowns)
    for _ in range(12):
        table = gains.reshape(len(knots_mps), _FREQUENCIES)
        log_gain = along @ table @ across.T
        step = np.clip(0.5 * (ratio * np.exp(-2.0 * log_gain) - 1.0), -1.0, 1.5)
        wanted = log_gain + step
        # The design is a product of two bases, so its normal equations are sums of small products over windows.
        matrix = np.zeros((unknowns, unknowns))
        side = np.zeros(unknowns)
        total = np.einsum("wa,wb,wf->abf", along, along, weight)
        for one in range(len(knots_mps)):
            for other in range(len(knots_mps)):
                block = across.T @ (total[one, other][:, None] * across)
                rows = slice(one * _FREQUENCIES, (one + 1) * _FREQUENCIES)
                columns = slice(other * _FREQUENCIES, (other + 1) * _FREQUENCIES)
                matrix[rows, columns] = block
        side = ((along.T @ (weight * wanted)) @ across).reshape(-1)
        gains = np.linalg.solve(4.0 * matrix + penalty, 4.0 * side)
    table = np.clip(_DECIBELS * gains.reshape(len(knots_mps), _FREQUENCIES), -TONE_LIMIT_DB, TONE_LIMIT_DB)
    rounded = tuple(tuple(round(float(value), 2) for value in row) for row in table)
    return ToneTable(knots_mps, tuple(round(float(value), 2) for value in frequencies), rounded)


def _hats(places: _Doubles, knots: _Doubles) -> _Doubles:
    """[places, knots]: weights of linear interpolation."""
    if len(knots) == 1:
        return np.ones((len(places), 1))
    return np.stack([np.interp(places, knots, row) for row in np.eye(len(knots))], axis=1)


def _penalties(speeds: int, known: _Doubles, options: ToneOptions) -> _Doubles:
    rows = []

    def row(*entries: tuple[int, int, float]) -> None:
        values = np.zeros(speeds * _FREQUENCIES)
        for speed, frequency, value in entries:
            values[speed * _FREQUENCIES + frequency] += value
        rows.append(values)

    for speed in range(speeds):
        for frequency in range(_FREQUENCIES):
            row((speed, frequency, 1.0 / options.size))
            if frequency + 1 < _FREQUENCIES:
                row((speed, frequency, -1.0 / options.step), (speed, frequency + 1, 1.0 / options.step))
            if 0 < frequency < _FREQUENCIES - 1:
                bend = 1.0 / options.bend
                row((speed, frequency - 1, bend), (speed, frequency, -2.0 * bend), (speed, frequency + 1, bend))
            if speed + 1 < speeds:
                # A larger step of log speed allows a larger change.
                size = 1.0 / (options.speed_step * math.sqrt(max(known[speed + 1] - known[speed], 0.05)))
                row((speed, frequency, -size), (speed + 1, frequency, size))
    stacked = np.array(rows)
    return np.asarray(stacked.T @ stacked)
