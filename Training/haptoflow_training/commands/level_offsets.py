"""What `train` and `train-tiers` have in common at the end: the level that the finished network makes is taken back."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import torch
from tqdm import tqdm

from haptoflow_training.evaluation.level_calibration import TierSource, hops, level_offsets_db
from haptoflow_training.export.trained_tier import load_tiers
from haptoflow_training.models.level_model import LevelModel
from haptoflow_training.training.held_out import HeldOut
from haptoflow_training.training.recordings_source import Source


def measured_offsets_db(folder: Path, source: Source) -> list[float] | None:
    """What the finished run in `folder` gives too much of each label, in dB, for the export to take back; None where the
    level is one for all labels."""
    torch.set_num_threads(1)
    tier = load_tiers([folder])[0]
    if not isinstance(tier.model.level, LevelModel):
        return None
    with tqdm(total=hops(source.store), unit="hop", desc="levels") as bar:
        made = TierSource(tier)
        return level_offsets_db(made, made.embeddings, source.store, HeldOut.of(tier.config.batch), bar.update)


def by_label(offsets_db: list[float] | None, source: Source) -> dict[str, Any]:
    """What export.json says of them; nothing where none were measured."""
    if offsets_db is None:
        return {}
    names = [info.name for info in source.labels]
    return {"level_offsets_db": {name: round(offset, 3) for name, offset in zip(names, offsets_db, strict=True)}}
