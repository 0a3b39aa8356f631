"""The rivals of a material fitted to seconds: autoregressive models of the same recording, with the same level.

Order 20, from the autocorrelation of the recording in unit scale (Levinson's recursion), driven by Gaussian noise: the
published form for textures, of which Culbertson et al. fit one for each speed and force. Ten seconds suffice for three
bins of speed, or for one model of all speeds.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_toeplitz
from scipy.signal import lfilter

from haptoflow_paper.few_shot.level_law import MINIMUM_SPEED_MPS
from haptoflow_paper.few_shot.recording_windows import windows_of
from haptoflow_training.export.level_table import LevelTable
from haptoflow_training.recordings.material_recording import MaterialRecording

ORDER = 20
_WINDOW_SAMPLES, _HOP_SAMPLES = 400, 200
_MINIMUM_WINDOWS = 4
_MINIMUM_SLIDE_SPEED_MPS, _MAXIMUM_UNSTEADINESS = 0.012, 0.5
# White noise at the level of sensor noise keeps the filter of a silent band stable.
_WHITENING = 1e-5

_Doubles = NDArray[np.float64]


@dataclass(frozen=True)
class AutoregressiveMaterial:
    """filters: (upper border of the bin in m/s, a_1..a_20, RMS of the drive for a wave of RMS 1), borders ascending."""

    filters: tuple[tuple[float, _Doubles, float], ...]
    level: LevelTable

    def render(self, motion: NDArray[np.floating], seed: int) -> NDArray[np.float32]:
        """Render one motion [n, 3] whose speed stays in one bin, in m/s^2."""
        speed = float(np.hypot(motion[:, 0], motion[:, 1]).mean())
        _, predictor, drive = next(entry for entry in self.filters if speed <= entry[0])
        settling = 2000
        noise = np.random.default_rng(seed).standard_normal(len(motion) + settling)
        wave = lfilter([drive], np.concatenate([[1.0], predictor]), noise)[settling:]
        return np.asarray(wave * np.exp(log_levels(self.level, motion)), dtype=np.float32)


def fit_autoregressive(
    recordings: Sequence[MaterialRecording], level: LevelTable, bins: int
) -> AutoregressiveMaterial:
    """Fit the filters. Bins hold equally many windows; a bin with too few uses its neighbour's filter."""
    windows = windows_of(recordings, _WINDOW_SAMPLES, _HOP_SAMPLES)
    # Slower slides consist of starts, stops and sensor noise.
    sliding = (windows.speed_mps > _MINIMUM_SLIDE_SPEED_MPS) & (windows.unsteadiness < _MAXIMUM_UNSTEADINESS)
    if sliding.sum() < bins * _MINIMUM_WINDOWS:
        sliding = windows.speed_mps > MINIMUM_SPEED_MPS
    windows = windows.chosen(sliding)
    unit = windows.waves / np.exp(log_levels(level, windows.motion))
    bins = max(1, min(bins, len(windows) // _MINIMUM_WINDOWS))
    order = np.argsort(windows.speed_mps)
    parts = np.array_split(order, bins)
    filters = []
    for index, part in enumerate(parts):
        last = index == len(parts) - 1
        border = math.inf if last else float(
            math.sqrt(windows.speed_mps[part[-1]] * windows.speed_mps[parts[index + 1][0]])
        )
        filters.append((border, *_levinson(unit[part])))
    return AutoregressiveMaterial(tuple(filters), level)


def log_levels(level: LevelTable, motion: NDArray[np.floating]) -> _Doubles:
    """The natural log level for motion [..., 3]."""
    return level.log_level(np.hypot(motion[..., 0], motion[..., 1]), motion[..., 2])


def _levinson(waves: _Doubles) -> tuple[_Doubles, float]:
    """a_1..a_20 of A(z) = 1 + sum a_i z^-i, and the RMS of the drive that gives a wave of RMS 1.

    (scipy.linalg.solve_toeplitz gives the coefficients but not the residual power.)
    """
    waves = waves / np.sqrt(np.square(waves).mean())
    lags = np.array(
        [(waves[:, lag:] * waves[:, : waves.shape[1] - lag]).sum() / waves.size for lag in range(ORDER + 1)]
    )
    lags[0] *= 1.0 + _WHITENING
    predictor = solve_toeplitz(lags[:-1], -lags[1:])
    error = float(lags[0] + predictor @ lags[1:])
    return np.asarray(predictor), math.sqrt(max(error / lags[0], 1e-9))
