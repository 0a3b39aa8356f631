"""Level tables for labels whose recorded level departs from the level model's law.

The level of a finished network in closed loop is compared with the recordings, by speed. A label gets a table where the
two differ by more than the smallest difference that people perceive; the table is then corrected by the error that is
still measured with it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.closed_loop.level_calibration import ClosedLoopLevels, offsets_db
from haptoflow_training.export.exponents import LabelExponents
from haptoflow_training.export.level_table import LevelTable, bin_speed_mps, speed_bins, table_through

# The smallest perceptible change of a vibration's amplitude is 2.2 to 2.5 dB.
FELT_DB = 2.5
_MINIMUM_WINDOWS = 8
_MINIMUM_SPEED_MPS = 0.005
_ROUNDS = 2
_NATURAL_PER_DB = math.log(10.0) / 20.0

Measure = Callable[[Mapping[int, LevelTable]], ClosedLoopLevels]


def level_tables(
    levels: ClosedLoopLevels, exponents: Mapping[int, LabelExponents], measure: Measure
) -> dict[int, LevelTable]:
    """Level tables by label index, for the labels that need one. levels: measured with the level model alone.
    exponents: of every label. measure: measures the labels that have tables, with these tables."""
    labels = len(exponents)
    offsets = offsets_db(levels, labels)
    tables: dict[int, LevelTable] = {}
    for label in range(labels):
        bins, recorded, excess = _by_speed(levels, label, exponents[label])
        if len(bins) >= 2 and np.abs(excess - offsets[label]).max() > FELT_DB:
            tables[label] = _table(levels, label, bins, recorded, exponents[label])
    for _ in range(_ROUNDS if tables else 0):
        measured = measure(tables)
        tables = {label: _corrected(table, measured, label, exponents[label]) for label, table in tables.items()}
    return tables


def _by_speed(
    levels: ClosedLoopLevels, label: int, exponents: LabelExponents
) -> tuple[NDArray[np.int64], NDArray[np.float64], NDArray[np.float64]]:
    """Bins of speed with enough windows; natural log of the recorded RMS at the label's median force in each bin;
    and by how many decibels more was generated."""
    own = (levels.owners == label) & (levels.speeds_mps > _MINIMUM_SPEED_MPS) & (levels.forces_newtons > 0.02)
    bins = speed_bins(levels.speeds_mps[own])
    powers = levels.powers[own] + 1e-8
    force = np.log(levels.forces_newtons[own] / _usual_force(levels, label))
    at_usual_force = powers[:, 1] * np.exp(-2.0 * exponents.level_force * force)
    numbers, counts = np.unique(bins, return_counts=True)
    numbers = numbers[counts >= _MINIMUM_WINDOWS]
    recorded = np.array([0.5 * math.log(float(at_usual_force[bins == number].mean())) for number in numbers])
    excess = [10.0 * math.log10(float(np.divide(*powers[bins == number].sum(axis=0)))) for number in numbers]
    return numbers, recorded, np.array(excess)


def _usual_force(levels: ClosedLoopLevels, label: int) -> float:
    own = (levels.owners == label) & (levels.speeds_mps > _MINIMUM_SPEED_MPS) & (levels.forces_newtons > 0.02)
    return float(np.clip(np.median(levels.forces_newtons[own]), 0.05, 50.0))


def _table(
    levels: ClosedLoopLevels,
    label: int,
    bins: NDArray[np.int64],
    log_levels: NDArray[np.float64],
    exponents: LabelExponents,
) -> LevelTable:
    return table_through(
        np.array([bin_speed_mps(int(number)) for number in bins]),
        log_levels,
        force_newtons=_usual_force(levels, label),
        force_exponent=exponents.level_force,
        speed_exponent=exponents.level_speed,
    )


def _corrected(table: LevelTable, measured: ClosedLoopLevels, label: int, exponents: LabelExponents) -> LevelTable:
    """The table, lowered by the level error that is still measured at each speed."""
    bins, _, excess = _by_speed(measured, label, exponents)
    speeds = np.array([bin_speed_mps(int(number)) for number in bins])
    levels = table.log_level(speeds, table.force_newtons) - _NATURAL_PER_DB * excess
    return _table(measured, label, bins, levels, exponents)
