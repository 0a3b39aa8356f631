"""Golden vectors of the exported model: PyTorch's results, which the C++ engine must reproduce."""

from __future__ import annotations

import copy
import dataclasses
from pathlib import Path
from typing import Any

import torch
from torch import Tensor

from haptoflow_training.export.trained_tier import TrainedTier
from haptoflow_training.models.label_embedding import surface_phases
from haptoflow_training.models.level_model import scaled_previous
from haptoflow_training.training.batches import SegmentBatch
from haptoflow_training.training.run_log import write_json

def _in_double(batch: SegmentBatch) -> SegmentBatch:
    parts = {field.name: getattr(batch, field.name) for field in dataclasses.fields(batch)}
    return dataclasses.replace(
        batch, **{name: part.double() for name, part in parts.items() if isinstance(part, Tensor) and part.is_floating_point()}
    )


@torch.no_grad()
def write_parity(path: Path, tiers: list[TrainedTier], batch: SegmentBatch, *, model_crc32: int, seed: int) -> None:
    """Write one case for each row of `batch`, cycling through tiers and solvers; the previous waveforms are recorded
    ones. Computed in double precision: an all-pole filter at single precision is no reference."""
    generator = torch.Generator().manual_seed(seed)
    tiers = [copy.deepcopy(tier) for tier in tiers]
    for tier in tiers:
        tier.model.double()
    batch = _in_double(batch)
    cases: list[dict[str, Any]] = []
    for row in range(batch.label.shape[0]):
        tier = tiers[row % len(tiers)]
        kind, steps = tier.golden_solvers[row // len(tiers) % len(tier.golden_solvers)]
        embedding = tier.model.embedding(batch.label[row : row + 1])
        motion, previous = batch.motion[row : row + 1], batch.previous[row : row + 1]
        where = batch.position_mm[row : row + 1], batch.wander[row : row + 1]
        phases = surface_phases(embedding, motion, *where)
        log_level = tier.model.level(embedding, motion)
        condition = scaled_previous(previous, log_level), embedding, motion, phases
        noise = torch.randn(1, 1, 200, generator=generator).double()
        segment = tier.generate(noise, condition, kind, steps) * torch.exp(log_level).unsqueeze(-1)
        cases.append(
            {
                "tier": tier.name,
                "solver": kind,
                "steps": steps,
                "embedding": embedding.flatten().tolist(),
                "motion": motion.flatten().tolist(),
                "phases": phases.flatten().tolist(),
                "previous": previous.flatten().tolist(),
                "noise": noise.flatten().tolist(),
                "log_level": log_level.item(),
                "segment": segment.flatten().tolist(),
            }
        )
    write_json(path, {"model_crc32": f"{model_crc32:08x}", "cases": cases})
