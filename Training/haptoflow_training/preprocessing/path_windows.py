"""Windows along a recording's path: about 35 mm of nearly straight sliding each, whitened and placed on the surface.

`NativePlugin/src/learning/path_windows.cpp` implements the same; `Tests/Golden/wave-vectors` compares both with it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_toeplitz

from haptoflow_training.waveform import SAMPLE_RATE_HZ

if TYPE_CHECKING:
    from haptoflow_training.recordings.material_recording import MaterialRecording

_Doubles = NDArray[np.float64]

# This much path holds many ribs, while a tracker's error over it is less than one rib.
_PATH_MM = 35.0
_MINIMUM_SAMPLES, _MAXIMUM_SAMPLES = 160, 1000
_MINIMUM_SPEED_MMPS = 4.0
# A window whose path bends more, or is shorter, carries little information about a direction.
_MINIMUM_STRAIGHTNESS, _MINIMUM_PATH_MM = 0.96, 4.0
_PREDICTOR_ORDER = 10
_LEVEL_REACH_SAMPLES = 100
_MAXIMUM_WINDOWS = 200


@dataclass(frozen=True)
class PathWindows:
    """wave and hann [windows, samples], zero after a window's end; place_mm [windows, samples, 2] relative to the
    window's middle; direction [windows, 2] of unit length; speed_mmps and path_mm [windows]."""

    wave: _Doubles
    hann: _Doubles
    place_mm: _Doubles
    direction: _Doubles
    speed_mmps: _Doubles
    path_mm: _Doubles

    def __len__(self) -> int:
        return len(self.wave)

    @property
    def along_mm(self) -> _Doubles:
        """[windows, samples]: the place along the window's own direction."""
        return np.asarray(np.einsum("wsc,wc->ws", self.place_mm, self.direction))


def path_windows(recordings: Sequence[MaterialRecording]) -> PathWindows:
    """At most 200 windows that overlap by half, chosen evenly from all."""
    found = []
    for recording, white in zip(recordings, _whitened(recordings), strict=True):
        velocity = 1000.0 * recording.velocity_mps.astype(np.float64)
        speed = np.linalg.norm(velocity, axis=1)
        place = np.concatenate([np.zeros((1, 2)), np.cumsum(velocity, axis=0) / SAMPLE_RATE_HZ])
        resting = np.concatenate([[0], np.cumsum(speed <= _MINIMUM_SPEED_MMPS)])
        start = _PREDICTOR_ORDER
        while start + _MINIMUM_SAMPLES <= len(white):
            wanted = _PATH_MM * SAMPLE_RATE_HZ / max(float(speed[start]), _MINIMUM_SPEED_MMPS)
            count = int(np.clip(wanted, _MINIMUM_SAMPLES, _MAXIMUM_SAMPLES))
            end = start + count
            if end > len(white) or resting[end] > resting[start]:
                start += _MINIMUM_SAMPLES // 2
                continue
            chord = place[end] - place[start]
            path = float(speed[start:end].sum()) / SAMPLE_RATE_HZ
            straight = float(np.linalg.norm(chord))
            power = float(np.square(white[start:end]).mean())
            if straight >= _MINIMUM_STRAIGHTNESS * path and path >= _MINIMUM_PATH_MM and power > 0.0:
                found.append((white[start:end] / np.sqrt(power), place[start:end] - place[start + count // 2],
                              chord / straight, path))  # fmt: skip
            start += count // 2
    if len(found) > _MAXIMUM_WINDOWS:
        found = [found[place * len(found) // _MAXIMUM_WINDOWS] for place in range(_MAXIMUM_WINDOWS)]
    return _stacked(found)


def _stacked(found: Sequence[tuple[_Doubles, _Doubles, _Doubles, float]]) -> PathWindows:
    longest = max((len(wave) for wave, *_ in found), default=0)
    wave, hann = np.zeros((len(found), longest)), np.zeros((len(found), longest))
    place = np.zeros((len(found), longest, 2))
    for index, (values, places, _, _) in enumerate(found):
        window = np.hanning(len(values) + 2)[1:-1]
        wave[index, : len(values)] = window * values
        hann[index, : len(values)] = window
        place[index, : len(values)] = places
    path = np.array([each[3] for each in found])
    seconds = np.array([len(each[0]) for each in found]) / SAMPLE_RATE_HZ
    direction = np.array([each[2] for each in found]).reshape(-1, 2)
    return PathWindows(wave, hann, place, direction, path / seconds if len(found) else path, path)


def _whitened(recordings: Sequence[MaterialRecording]) -> list[_Doubles]:
    """The residual of one linear predictor for all recordings: it removes the spectral shape that surface and tool
    give to everything, and leaves lines. Before that, each sample is divided by the RMS of its 100 ms."""
    even = [_evened(recording.vibration_mps2.astype(np.float64)) for recording in recordings]
    correlation = np.zeros(_PREDICTOR_ORDER + 1)
    for wave, recording in zip(even, recordings, strict=True):
        slides = 1000.0 * np.linalg.norm(recording.velocity_mps, axis=1) > _MINIMUM_SPEED_MMPS
        for lag in range(min(_PREDICTOR_ORDER + 1, len(wave))):
            first = _PREDICTOR_ORDER
            correlation[lag] += float(np.sum((wave[first:] * wave[first - lag : len(wave) - lag])[slides[first:]]))
    column = correlation[:-1].copy()
    column[0] += 1e-3 * correlation[0] + 1e-12
    taps = solve_toeplitz(column, correlation[1:])
    white = []
    for wave in even:
        error = wave.copy()
        for lag, tap in enumerate(taps, start=1):
            error[lag:] -= tap * wave[: len(wave) - lag]
        error[:_PREDICTOR_ORDER] = 0.0
        white.append(error)
    return white


def _evened(wave: _Doubles) -> _Doubles:
    sums = np.concatenate([[0.0], np.cumsum(np.square(wave))])
    places = np.arange(len(wave))
    first = np.maximum(places - _LEVEL_REACH_SAMPLES, 0)
    last = np.minimum(places + _LEVEL_REACH_SAMPLES, len(wave))
    return np.asarray(wave / (np.sqrt((sums[last] - sums[first]) / (last - first)) + 1e-6))
