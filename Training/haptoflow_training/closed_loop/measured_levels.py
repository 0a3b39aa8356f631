"""The level measurement that ends `train`, `train-tiers` and `export`: level offsets for each label, and level
tables for labels whose recordings depart from the level model's law."""

from __future__ import annotations

import time
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import torch
from tqdm import tqdm

from haptoflow_training.closed_loop.level_calibration import (
    ClosedLoopLevels,
    Extent,
    TierSource,
    closed_loop_levels,
    hops,
    offsets_db,
)
from haptoflow_training.closed_loop.level_following import level_tables
from haptoflow_training.closed_loop.phase_track import SurfaceStatistics
from haptoflow_training.export.exponents import fit_exponents
from haptoflow_training.export.level_table import LevelTable, MeasuredLevels
from haptoflow_training.export.trained_tier import TrainedTier, load_tiers
from haptoflow_training.training.held_out import HeldOut

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
