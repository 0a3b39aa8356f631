"""Level tables over speed, for labels whose level follows no power law: the `level` key of a label in a model file.

The level model is a power law with a bounded correction. Deviations beyond that (a published brick rises by 14 dB
between 60 and 80 mm/s) are stored in a table of at most 16 speeds; below and above the table, the law continues.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from haptoflow_training.models.conditioning import REST_FORCE_NEWTONS, REST_SPEED_MPS

_Doubles = NDArray[np.float64]

BINS_PER_OCTAVE = 6.0
MAXIMUM_SPEEDS = 16
_CLOSE_ENOUGH = 0.25 * math.log(10.0) / 20.0


@dataclass(frozen=True)
class LevelTable:
    """speeds_mps: 1 to 16 values, ascending. log_levels: natural logarithms of the RMS in m/s^2 at force_newtons.
    speed_exponent: of the law beyond the table's ends, equal to the label's level exponent."""

    speeds_mps: tuple[float, ...]
    log_levels: tuple[float, ...]
    force_newtons: float
    force_exponent: float
    speed_exponent: float

    def log_level(self, speed_mps: ArrayLike, force_newtons: ArrayLike) -> _Doubles:
        """The natural log level at any speed (m/s, 0 or more) and force (N)."""
        place = np.log(np.asarray(speed_mps, dtype=np.float64) + REST_SPEED_MPS)
        knots = np.log(np.asarray(self.speeds_mps) + REST_SPEED_MPS)
        beyond = place - np.clip(place, knots[0], knots[-1])
        force = np.maximum(np.asarray(force_newtons, dtype=np.float64), REST_FORCE_NEWTONS)
        inside = np.interp(place, knots, np.asarray(self.log_levels))
        pressed = self.force_exponent * np.log(force / self.force_newtons)
        return np.asarray(inside + self.speed_exponent * beyond + pressed)

    def to_json(self) -> dict[str, Any]:
        return {
            "speeds_mps": [round(speed, 5) for speed in self.speeds_mps],
            "log_levels": [round(level, 4) for level in self.log_levels],
            "force_newtons": round(self.force_newtons, 4),
            "force_exponent": round(self.force_exponent, 4),
        }


@dataclass(frozen=True)
class MeasuredLevels:
    """What training/level_calibration.py found. offsets_db: the level error of each label, None where nothing was
    measured. tables: by label index."""

    offsets_db: list[float] | None = None
    tables: Mapping[int, LevelTable] = field(default_factory=dict)


def speed_bins(speeds_mps: _Doubles) -> NDArray[np.int64]:
    """The bin of each speed: six bins an octave, counted from 1 m/s; neighbouring bins differ by 12 %."""
    bins: NDArray[np.int64] = np.floor(BINS_PER_OCTAVE * np.log2(np.maximum(speeds_mps, 1e-4)) + 0.5).astype(np.int64)
    return bins


def bin_speed_mps(number: int) -> float:
    """The centre of a speed bin, in m/s."""
    return float(2.0 ** (number / BINS_PER_OCTAVE))


def table_through(
    speeds_mps: _Doubles, log_levels: _Doubles, *, force_newtons: float, force_exponent: float, speed_exponent: float
) -> LevelTable:
    """The table through a curve at ascending speeds [n], with as few points as keep it within a quarter of a
    decibel, at most 16."""
    place = np.log(speeds_mps + REST_SPEED_MPS)
    kept = sorted({0, len(place) - 1})
    while len(kept) < min(MAXIMUM_SPEEDS, len(place)):
        misses = np.abs(np.interp(place, place[kept], log_levels[kept]) - log_levels)
        worst = int(misses.argmax())
        if misses[worst] < _CLOSE_ENOUGH:
            break
        kept = sorted({*kept, worst})
    return LevelTable(
        tuple(float(speed) for speed in speeds_mps[kept]),
        tuple(float(level) for level in log_levels[kept]),
        force_newtons,
        force_exponent,
        speed_exponent,
    )
