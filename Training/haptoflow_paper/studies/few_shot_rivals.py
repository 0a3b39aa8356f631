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

from haptoflow_training.errors import InputError
from haptoflow_training.export.level_table import MAXIMUM_SPEEDS, LevelTable
from haptoflow_training.export.model_file import ModelFile
from haptoflow_training.models.conditioning import REST_FORCE_NEWTONS, REST_SPEED_MPS
from haptoflow_training.models.level_model import LEVEL_FLOOR_MPS2
from haptoflow_training.recordings.native_recording import MaterialRecording

_Floats = NDArray[np.float32]


@dataclass(frozen=True)
class Windows:
    """Stretches of recordings: waves [n, samples]; motion [n, samples, 3] (vx, vy in m/s and force in N)."""

    waves: _Floats
    motion: _Floats

    def __len__(self) -> int:
        return len(self.waves)

    @property
    def speed_mps(self) -> _Floats:
        """[n]: mean of the samples' speeds, so that a turn does not count as rest."""
        return np.hypot(self.motion[..., 0], self.motion[..., 1]).mean(axis=1)

    @property
    def force_newtons(self) -> _Floats:
        return self.motion[..., 2].mean(axis=1)

    @property
    def unsteadiness(self) -> _Floats:
        """[n]: standard deviation of the logarithm of the speed."""
        speed = np.hypot(self.motion[..., 0], self.motion[..., 1])
        return np.log(speed + 0.002).std(axis=1)

    def chosen(self, mask: NDArray[np.bool_]) -> Windows:
        return Windows(self.waves[mask], self.motion[mask])


def windows_of(recordings: Sequence[MaterialRecording], samples: int, hop: int) -> Windows:
    """Every stretch of `samples` that starts a multiple of `hop` after a recording's first sample."""
    waves, motions = [np.zeros((0, samples), dtype=np.float32)], [np.zeros((0, samples, 3), dtype=np.float32)]
    for recording in recordings:
        for start in range(0, len(recording.motion) - samples + 1, hop):
            waves.append(recording.vibration_mps2[None, start : start + samples])
            motions.append(recording.motion[None, start : start + samples])
    return Windows(np.concatenate(waves), np.concatenate(motions))


_Doubles = NDArray[np.float64]

MINIMUM_SPEED_MPS = 0.004
_KNOTS_PER_E_FOLD = 2.2
# Standard deviations: of the log level of a tenth of a second about the law, and of the change of slope between two
# knots.
_WINDOW_SPREAD, _BEND_SPREAD = 0.2, 0.35
_ROUNDS = 25


_MINIMUM_LABELS = 4
# With few labels the spread of the exponents is unknown; these values are those of the published textures.
_FORCE_EXPONENT, _SPEED_EXPONENT = (0.25, 0.2), (0.95, 0.25)
_MINIMUM_SPREAD = 0.1


@dataclass(frozen=True)
class LabelPrior:
    """Exponents of the labels' levels: mean and standard deviation."""

    force_exponent: tuple[float, float]
    speed_exponent: tuple[float, float]

    @classmethod
    def of(cls, model: ModelFile) -> LabelPrior:
        def spread_of(key: str, known: tuple[float, float]) -> tuple[float, float]:
            values = [label["level_exponents"][key] for label in model.header["labels"]]
            if len(values) < _MINIMUM_LABELS:
                return known
            return float(np.mean(values)), max(_MINIMUM_SPREAD, float(np.std(values)))

        return cls(spread_of("force", _FORCE_EXPONENT), spread_of("speed", _SPEED_EXPONENT))


def fit_level(windows: Windows, prior: LabelPrior) -> LevelTable:
    """Fit the law to windows of about 100 ms that overlap by half. InputError if no window moves."""
    speed, force = windows.speed_mps.astype(np.float64), windows.force_newtons.astype(np.float64)
    moving = (speed > MINIMUM_SPEED_MPS) & (windows.unsteadiness < 0.6)
    if moving.sum() < 8:
        moving = speed > MINIMUM_SPEED_MPS
    if not moving.any():
        raise InputError(
            f"no tenth of a second of the recording moves faster than {1000.0 * MINIMUM_SPEED_MPS:g} mm/s; a "
            "texture is felt "
            "while the tip slides: check the unit of the speed"
        )
    power = np.square(windows.waves[moving], dtype=np.float64).mean(axis=1) + LEVEL_FLOOR_MPS2**2
    speed, force = speed[moving], np.maximum(force[moving], REST_FORCE_NEWTONS)
    place = np.log(speed + REST_SPEED_MPS)
    middle = math.exp(float(np.log(force).mean()))
    knots = _knots(place)
    basis = np.stack([np.interp(place, knots, row) for row in np.eye(len(knots))], axis=1)
    pressed = np.log(force / middle)
    design = np.column_stack([basis, pressed])
    # Neighbouring windows share half of their samples, so each counts half.
    weight = 0.5 / _WINDOW_SPREAD**2
    penalty, target = _penalty(knots, prior)
    found = np.append(np.interp(knots, *_sorted_means(place, 0.5 * np.log(power))), prior.force_exponent[0])
    for _ in range(_ROUNDS):
        log_level = design @ found
        # Limited, so that a single impact cannot destabilise the first iterations.
        step = np.clip(0.5 * (power * np.exp(-2.0 * log_level) - 1.0), -1.0, 2.0)
        wanted = log_level + step
        matrix = weight * design.T @ design + penalty.T @ penalty
        previous = found
        found = np.linalg.solve(matrix, weight * design.T @ wanted + penalty.T @ target)
        if np.abs(found - previous).max() < 1e-5:
            break
    levels, exponent = found[:-1], float(np.clip(found[-1], -4.0, 4.0))
    speeds = tuple(round(math.exp(knot) - REST_SPEED_MPS, 5) for knot in knots)
    slope = round(_slope(place, design @ found - exponent * pressed, prior), 4)
    return LevelTable(
        speeds, tuple(round(float(level), 4) for level in levels), round(middle, 4), round(exponent, 4), slope
    )


def _knots(place: _Doubles) -> _Doubles:
    low, high = np.quantile(place, [0.02, 0.98])
    count = int(np.clip(1 + round(_KNOTS_PER_E_FOLD * (high - low)), 1, MAXIMUM_SPEEDS))
    count = min(count, max(1, len(place) // 6))
    if count == 1 or high - low < 0.05:
        return np.array([float(np.median(place))])
    return np.linspace(low, high, count)


def _sorted_means(place: _Doubles, values: _Doubles) -> tuple[_Doubles, _Doubles]:
    """A first guess of the curve: means of neighbouring values, by speed."""
    order = np.argsort(place)
    parts = np.array_split(order, max(1, min(8, len(order) // 4)))
    return np.array([place[part].mean() for part in parts]), np.array([values[part].mean() for part in parts])


def _penalty(knots: _Doubles, prior: LabelPrior) -> tuple[_Doubles, _Doubles]:
    """Rows and targets of the penalty: slopes about those of the labels, changes of slope about 0, the force
    exponent about that of the labels."""
    rows, targets = [], []
    steps = np.diff(knots)
    for index, step in enumerate(steps):
        row = np.zeros(len(knots) + 1)
        row[index : index + 2] = np.array([-1.0, 1.0]) / step
        rows.append(row / (3.0 * prior.speed_exponent[1]))
        targets.append(prior.speed_exponent[0] / (3.0 * prior.speed_exponent[1]))
    for index in range(len(steps) - 1):
        row = np.zeros(len(knots) + 1)
        row[index : index + 3] += np.array([1.0, -1.0, 0.0]) / steps[index]
        row[index : index + 3] += np.array([0.0, -1.0, 1.0]) / steps[index + 1]
        # The slope follows a random walk: with finer knots it changes less at each.
        rows.append(row / (_BEND_SPREAD * math.sqrt(2.0 * steps[index])))
        targets.append(0.0)
    last = np.zeros(len(knots) + 1)
    last[-1] = 1.0 / prior.force_exponent[1]
    rows.append(last)
    targets.append(prior.force_exponent[0] / prior.force_exponent[1])
    return np.array(rows), np.array(targets)


def _slope(place: _Doubles, log_level: _Doubles, prior: LabelPrior) -> float:
    """The slope in the upper half of the recorded speeds, from which the law is extrapolated; that of the labels
    where data is scarce."""
    upper = place >= np.median(place)
    x, y = place[upper], log_level[upper]
    mean, spread = prior.speed_exponent
    certainty = (x - x.mean()) @ (x - x.mean()) / _WINDOW_SPREAD**2 * 0.5
    slope = (x - x.mean()) @ (y - y.mean()) / max(float((x - x.mean()) @ (x - x.mean())), 1e-9)
    blended = (certainty * slope + mean / spread**2) / (certainty + 1.0 / spread**2)
    return float(np.clip(blended, 0.0, 2.0))


ORDER = 20
_WINDOW_SAMPLES, _HOP_SAMPLES = 400, 200
_MINIMUM_WINDOWS = 4
_MINIMUM_SLIDE_SPEED_MPS, _MAXIMUM_UNSTEADINESS = 0.012, 0.5
# White noise at the level of sensor noise keeps the filter of a silent band stable.
_WHITENING = 1e-5


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
