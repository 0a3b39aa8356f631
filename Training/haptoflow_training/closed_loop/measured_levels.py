"""The level measurement that ends `train`, `train-tiers` and `export`: level offsets for each label, and level
tables for labels whose recordings depart from the level model's law."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import torch
from numpy.typing import NDArray
from tqdm import tqdm

from haptoflow_training.closed_loop.level_calibration import (
    ClosedLoopLevels, Extent, TierSource, closed_loop_levels, hops, offsets_db
)
from haptoflow_training.closed_loop.render import SurfaceStatistics
from haptoflow_training.export.exponents import LabelExponents, fit_exponents
from haptoflow_training.export.level_table import LevelTable, MeasuredLevels, bin_speed_mps, speed_bins, table_through
from haptoflow_training.export.trained_tier import TrainedTier, load_tiers
from haptoflow_training.training.batches import HeldOut

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


if TYPE_CHECKING:
    from haptoflow_training.training.recordings_source import Source


def measured_levels(folder: Path, source: Source, extent: Extent = Extent()) -> MeasuredLevels:
    """Measure the finished run in `folder`. Tables are made only for recordings from folders: the levels of
    synthetic recordings follow the law by construction."""
    torch.set_num_threads(1)
    tier = load_tiers([folder])[0]
    held_out = HeldOut.of(tier.config.batch)
    statistics = SurfaceStatistics.of_labels(source.labels)

    def measure(tables: Mapping[int, LevelTable]) -> ClosedLoopLevels:
        made = TierSource(tier, tables)
        wanted = frozenset(tables) or None
        with tqdm(total=hops(source.store, extent), unit="hop", desc="levels") as bar:
            return closed_loop_levels(
                made, made.embeddings, source.store, statistics, held_out, bar.update, extent, wanted
            )

    levels = measure({})
    offsets = offsets_db(levels, len(source.labels))
    if tier.config.data.source != "folders":
        return MeasuredLevels(offsets)
    exponents = {
        row: fit_exponents(source.store, row, periodic=info.periodic, seed=tier.config.seed, held_out=held_out)
        for row, info in enumerate(source.labels)
    }
    return MeasuredLevels(offsets, level_tables(levels, exponents, measure))


def seconds_of_a_measurement(tier: TrainedTier, source: Source, extent: Extent) -> float:
    """How long one round of `measured_levels` takes, in seconds, estimated from a few of its hops."""
    torch.set_num_threads(1)
    made = TierSource(tier)
    few = Extent(extent.recordings_per_label, _TRIED_SAMPLES)
    begun = time.monotonic()
    statistics = SurfaceStatistics.of_labels(source.labels)
    closed_loop_levels(made, made.embeddings, source.store, statistics, HeldOut.of(tier.config.batch), extent=few)
    return (time.monotonic() - begun) * hops(source.store, extent) / hops(source.store, few)


_TRIED_SAMPLES = 600


def by_label(measured: MeasuredLevels, source: Source) -> dict[str, Any]:
    """The measured levels as export.json states them; empty where none were measured."""
    if measured.offsets_db is None:
        return {}
    names = [info.name for info in source.labels]
    described: dict[str, Any] = {
        "level_offsets_db": {name: round(offset, 3) for name, offset in zip(names, measured.offsets_db, strict=True)}
    }
    if measured.tables:
        described["level_tables"] = [names[row] for row in measured.tables]
    return described
