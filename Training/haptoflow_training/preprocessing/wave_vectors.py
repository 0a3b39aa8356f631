"""Estimates wave vectors of ribs and threads from recordings: spectral lines that follow the speed, by direction.

A ruled surface with wave vector k vibrates at |k . v|: as a function of the place x on the surface, that is a line at
exp(2 pi i k . x), whatever speed and direction do. Every window of the path gives a spectrum along its own direction.
The mean of these spectra at k, over that of neighbouring wave vectors, is the evidence for a line there; the evidence
for ribs is that of their first six harmonics together. A resonance stays at its frequency while the speed changes and
is averaged out; recordings at a single speed therefore show nothing.

`NativePlugin/src/learning/wave_vectors.cpp` implements the same; `Tests/Golden/wave-vectors` compares both with it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median_filter

from haptoflow_training.preprocessing.path_windows import PathWindows, path_windows

if TYPE_CHECKING:
    from haptoflow_training.recordings.material_recording import MaterialRecording

_Doubles = NDArray[np.float64]
WaveVector = tuple[float, float]

MINIMUM_WAVELENGTH_MM, MAXIMUM_WAVELENGTH_MM = 0.4, 8.0
_MAXIMUM_WAVE_VECTORS = 2
_STEP_PER_MM, _MAXIMUM_PER_MM = 0.01, 4.0
# Multiples of the step from 0 to slightly above the highest wave number.
_STEPS = round(_MAXIMUM_PER_MM / _STEP_PER_MM) + 2
_DIRECTIONS = 120
_HARMONICS = 6
# Below, a line cannot be distinguished from the hand's own motion; above, the band ends.
_MINIMUM_HZ, _MAXIMUM_HZ, _MINIMUM_ALONG_PER_MM = 15.0, 800.0, 0.08
_MINIMUM_WINDOWS, _HEARING_SHARE = 6, 5
_MINIMUM_SPEED_RATIO = 1.25
# Limit in multiples of the mean noise power, so that one loud window does not count as many.
_MAXIMUM_POWER = 30.0
_NEIGHBOURS = 41
# Windows that overlap by half carry 0.6 of the information of separate ones.
_INDEPENDENT_SHARE = 0.6
# Natural logarithms of likelihood ratios. Noise alone reaches 15 on none of 38 surfaces without ribs.
_SURE, _SURE_BESIDE_KNOWN, _PRICE_OF_A_HARMONIC, _OWN_LINES = 20.0, 24.0, 3.0, 8.0
_OWN_LINES_SHARE, _SHARE_OF_FIRST, _LOW_HARMONICS_SHARE = 0.06, 0.04, 0.3
_MINIMUM_RATIO = 1.6
# Threads usually cross at right angles, so such a pair is preferred among equals.
_CROSSING_BONUS, _CROSSING_DEGREES, _MINIMUM_TURN_DEGREES = 0.2, 8.0, 20.0
# Half the main lobe of a window is 1.6 of its bins; slightly irregular ribs broaden their higher harmonics.
_LOBE_BINS, _WIDER_BY_ORDER, _TAKEN_HARMONICS = 1.6, 0.1, 8
_TRIES = 6


def estimate_wave_vectors(recordings: Sequence[MaterialRecording]) -> tuple[WaveVector, ...]:
    """Up to two wave vectors (x, y) in cycles per millimetre, the clearest first; empty if there are none, or if the
    recordings do not suffice: less than about 0.2 m of path, or a single speed.

    Finds wavelengths of 0.4 to 8 mm. For a ruled surface that was recorded in one direction only, the vector found lies
    along that direction.
    """
    windows = path_windows([each for each in recordings if len(each.vibration_mps2) > 160])
    if len(windows) < _MINIMUM_WINDOWS or not _speed_changes(windows):
        return ()
    wave, found, first = windows.wave, [], 0.0
    while len(found) < _MAXIMUM_WAVE_VECTORS:
        evidence = _Evidence.of(windows, wave, found)
        clearest = evidence.clearest(found, first)
        if clearest is None:
            break
        vector, orders, score = clearest
        vector = _refined(windows, wave, vector, orders)
        first = first if found else score
        found.append(vector)
        wave = _without(windows, wave, vector)
    return tuple(_upward(vector) for vector in found)


def _speed_changes(windows: PathWindows) -> bool:
    speeds = np.sort(windows.speed_mmps)
    return bool(speeds[len(speeds) * 9 // 10] >= _MINIMUM_SPEED_RATIO * speeds[len(speeds) // 10])


@dataclass(frozen=True)
class _Evidence:
    """gains [directions, steps]: log likelihood ratio of a line at each wave vector; ratios: its mean power over its
    neighbours'."""

    gains: _Doubles
    ratios: _Doubles

    @staticmethod
    def of(windows: PathWindows, wave: _Doubles, known: Sequence[_Doubles]) -> _Evidence:
        spectra = _spectra(windows, wave)
        audible = _audible(windows, known)
        spectra = np.minimum(spectra, _MAXIMUM_POWER)
        rows = np.arange(len(windows))[:, None]
        mean, count = np.zeros((_DIRECTIONS, _STEPS)), np.zeros((_DIRECTIONS, _STEPS))
        for index, angle in enumerate(_angles()):
            share = np.abs(windows.direction @ [np.cos(angle), np.sin(angle)])
            along = share[:, None] * np.arange(_STEPS)[None]
            column = np.floor(along + 0.5).astype(int)
            counted = audible[rows, column] & (along * _STEP_PER_MM > _MINIMUM_ALONG_PER_MM)
            count[index] = counted.sum(axis=0)
            mean[index] = np.where(counted, spectra[rows, column], 0.0).sum(axis=0) / np.maximum(count[index], 1.0)
        enough = count >= max(_MINIMUM_WINDOWS, len(windows) // _HEARING_SHARE)
        neighbours = median_filter(np.where(enough, mean, 1.0), size=(1, _NEIGHBOURS), mode="nearest")
        ratio = np.where(enough, mean / np.maximum(neighbours, 1.0), 0.0)
        # For exponentially distributed powers with mean `ratio` instead of 1, at the most likely ratio.
        gain = _INDEPENDENT_SHARE * count * (ratio - 1.0 - np.log(np.maximum(ratio, 1e-9)))
        return _Evidence(np.where(ratio > 1.0, gain, 0.0), ratio)

    def clearest(self, known: Sequence[_Doubles], first: float) -> tuple[_Doubles, list[int], float] | None:
        """(vector, its audible harmonics, score) or None. first: the score of the first vector, if one is known."""
        scores = self._scores(known)
        sure = max(_SURE_BESIDE_KNOWN, _SHARE_OF_FIRST * first) if known else _SURE
        for _ in range(_TRIES):
            row, place = (int(each) for each in np.unravel_index(int(scores.argmax()), scores.shape))
            score = float(scores[row, place])
            if score < sure:
                return None
            step = self._pitch(row, place)
            gains, ratios = self._lines(self.gains, row, step), self._lines(self.ratios, row, step)
            if ratios.max() >= _MINIMUM_RATIO and gains[:2].sum() >= _LOW_HARMONICS_SHARE * score:
                angle = _angles()[row]
                orders = [order for order, gain in enumerate(gains, start=1) if gain > 2.0 * _PRICE_OF_A_HARMONIC]
                return step * _STEP_PER_MM * np.array([np.cos(angle), np.sin(angle)]), orders or [1], score
            scores[max(row - 3, 0) : row + 4, max(place - 5, 0) : place + 6] = 0.0
        return None

    def _scores(self, known: Sequence[_Doubles]) -> _Doubles:
        """The sum over the harmonics of each fundamental."""
        scores = np.zeros_like(self.gains)
        low, high = (round(1.0 / (each * _STEP_PER_MM)) for each in (MAXIMUM_WAVELENGTH_MM, MINIMUM_WAVELENGTH_MM))
        for order in range(1, _HARMONICS + 1):
            places = np.arange(low, min(high, (_STEPS - 1) // order + 1))
            scores[:, places] += np.maximum(self.gains[:, order * places] - _PRICE_OF_A_HARMONIC, 0.0)
        for vector in known:
            turn = np.degrees(np.abs(_angles() - np.arctan2(vector[1], vector[0])) % np.pi)
            turn = np.minimum(turn, 180.0 - turn)
            scores *= (1.0 + _CROSSING_BONUS * np.exp(-np.square((turn - 90.0) / _CROSSING_DEGREES)))[:, None]
            scores[turn < _MINIMUM_TURN_DEGREES] = 0.0
        return scores

    @staticmethod
    def _lines(values: _Doubles, row: int, step: int) -> _Doubles:
        """[6]: `values` at the six harmonics of the fundamental `step`, 0 for those beyond the highest wave number."""
        places = step * np.arange(1, _HARMONICS + 1)
        inside = places < values.shape[1]
        return np.where(inside, values[row, np.minimum(places, values.shape[1] - 1)], 0.0)

    def _near(self, row: int, step: int) -> _Doubles:
        """[6]: the largest gain near each harmonic of a fundamental that is known to half a step, less the price of
        a harmonic."""
        gains = np.zeros(_HARMONICS)
        rows = slice(max(row - 1, 0), row + 2)
        for order in range(1, _HARMONICS + 1):
            place = order * step
            if place + 1 < self.gains.shape[1]:
                largest = float(self.gains[rows, place - 1 : place + 2].max())
                gains[order - 1] = max(largest - _PRICE_OF_A_HARMONIC, 0.0)
        return gains

    def _pitch(self, row: int, step: int) -> int:
        """The fundamental's step. A fraction of the true step has the same lines, so the largest multiple that keeps
        them is right; and a harmonic may be louder than its fundamental, so the lowest fraction with lines of its
        own is."""
        orders = np.arange(1, _HARMONICS + 1)
        for divisor in (4, 3, 2):
            if divisor * step * _STEP_PER_MM <= 1.0 / MINIMUM_WAVELENGTH_MM:
                gains = self._near(row, step)
                own = gains[orders % divisor > 0].sum()
                lost = self._near(row, divisor * step).sum() <= 0.6 * gains.sum()
                if own < max(_OWN_LINES, _OWN_LINES_SHARE * gains.sum()) and not lost:
                    return divisor * step
        for divisor in (4, 3, 2):
            for lower in (step // divisor, -(-step // divisor)):
                if lower * _STEP_PER_MM >= 1.0 / MAXIMUM_WAVELENGTH_MM:
                    gains = self._near(row, lower)
                    if gains[orders % divisor > 0].sum() > _OWN_LINES and gains[0] > _OWN_LINES:
                        return lower
        return step


def _angles() -> _Doubles:
    return np.pi * np.arange(_DIRECTIONS) / _DIRECTIONS


def _spectra(windows: PathWindows, wave: _Doubles) -> _Doubles:
    """[windows, steps]: power by cycles per millimetre along each window's own direction, 1 for its median noise."""
    power = np.zeros((len(windows), _STEPS))
    turned = wave.astype(np.complex64)
    step = np.exp(-2j * np.pi * _STEP_PER_MM * windows.along_mm).astype(np.complex64)
    for index in range(_STEPS):
        power[:, index] = np.square(np.abs(turned.sum(axis=1)))
        turned *= step
    band = _band(windows)
    for index in range(len(windows)):
        # The median of a chi-squared variable with two degrees of freedom is ln 2 of its mean.
        usual = float(np.median(power[index, band[index]])) / np.log(2.0) if band[index].any() else 1.0
        power[index] /= usual if usual > 0.0 else 1.0
    return power


def _band(windows: PathWindows) -> NDArray[np.bool_]:
    hertz = np.arange(_STEPS)[None] * _STEP_PER_MM * windows.speed_mmps[:, None]
    return np.asarray((hertz >= _MINIMUM_HZ) & (hertz <= _MAXIMUM_HZ))


def _audible(windows: PathWindows, known: Sequence[_Doubles]) -> NDArray[np.bool_]:
    """[windows, steps]: inside the band, and not explained by a harmonic of a known vector."""
    audible = _band(windows)
    places = np.arange(_STEPS)[None] * _STEP_PER_MM
    for vector in known:
        fundamental = np.abs(windows.direction @ vector)[:, None]
        for order in range(_TAKEN_HARMONICS + 1):
            reach = (1.0 + _WIDER_BY_ORDER * order) * _LOBE_BINS / windows.path_mm[:, None]
            audible &= np.abs(places - order * fundamental) >= reach
    return audible


def _is_audible_at(windows: PathWindows, vectors: _Doubles) -> NDArray[np.bool_]:
    """[vectors, windows]: whether the line of a wave vector lies inside the band."""
    hertz = np.abs(vectors @ windows.direction.T) * windows.speed_mmps
    return np.asarray((hertz >= _MINIMUM_HZ) & (hertz <= _MAXIMUM_HZ))


def _refined(windows: PathWindows, wave: _Doubles, vector: _Doubles, orders: Sequence[int]) -> _Doubles:
    """The vector refined to a fiftieth of the plane's step, by ascent on the sum of the lines' amplitudes."""

    def amplitude(vectors: _Doubles) -> _Doubles:
        total = np.zeros(len(vectors))
        for order in orders:
            for index, each in enumerate(order * vectors):
                lines = np.abs((wave * np.exp(-2j * np.pi * (windows.place_mm @ each))).sum(axis=1))
                total[index] += float(lines[_is_audible_at(windows, each[None])[0]].sum())
        return total

    around = np.array([[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]])
    reach, best = _STEP_PER_MM, float(amplitude(vector[None])[0])
    for _ in range(60):
        amplitudes = amplitude(vector + reach * around)
        if amplitudes.max() > best:
            vector, best = vector + reach * around[amplitudes.argmax()], float(amplitudes.max())
        else:
            reach *= 0.5
            if reach < _STEP_PER_MM / 50.0:
                break
    return vector


def _without(windows: PathWindows, wave: _Doubles, vector: _Doubles) -> _Doubles:
    """The windows without the lines of a vector, which could be mistaken for another vector's."""
    left = wave.copy()
    weight = windows.hann.sum(axis=1)
    for order in range(1, _TAKEN_HARMONICS + 1):
        audible = _is_audible_at(windows, order * vector[None])[0]
        line = np.exp(2j * np.pi * order * (windows.place_mm @ vector))
        amplitude = (left * line.conj()).sum(axis=1) / weight
        left -= np.where(audible[:, None], windows.hann * 2.0 * (amplitude[:, None] * line).real, 0.0)
    return left


def _upward(vector: _Doubles) -> WaveVector:
    """Of the two opposite vectors, which describe the same ribs, the one whose larger component is positive, to five
    digits."""
    sign = 1.0 if vector[np.abs(vector).argmax()] > 0.0 else -1.0
    return round(sign * float(vector[0]), 5), round(sign * float(vector[1]), 5)
