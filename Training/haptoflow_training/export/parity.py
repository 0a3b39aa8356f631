"""Golden vectors of the exported model: what PyTorch computes, for the C++ engine to reproduce."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import torch

from haptoflow_training.models.haptoflow_model import PREVIOUS_LIMIT, HaptoFlowModel, unit_scale
from haptoflow_training.training.batches import SegmentBatch
from haptoflow_training.training.flow_matching import solve
from haptoflow_training.training.run_log import write_json

_SOLVERS = (("euler", 1), ("euler", 8), ("midpoint", 2), ("heun", 3), ("midpoint", 4))


@torch.no_grad()
def write_parity(
    path: Path, model: HaptoFlowModel, batch: SegmentBatch, *, tier: str, model_crc32: int, seed: int
) -> None:
    """Write one case per row of `batch`, solvers in turn, with the model's own recordings as previous waveforms."""
    generator = torch.Generator().manual_seed(seed)
    cases: list[dict[str, Any]] = []
    for row in range(batch.label.shape[0]):
        kind, steps = _SOLVERS[row % len(_SOLVERS)]
        embedding = model.embedding(batch.label[row : row + 1])
        motion, previous = batch.motion[row : row + 1], batch.previous[row : row + 1]
        log_level = model.level(embedding, motion)
        scaled = unit_scale(previous, log_level).clamp(-PREVIOUS_LIMIT, PREVIOUS_LIMIT)
        noise = torch.randn(1, 1, 200, generator=generator)

        def field(noisy: torch.Tensor, time: torch.Tensor) -> torch.Tensor:
            return model.field(noisy, time, scaled, embedding, motion)

        segment = solve(field, noise, kind, steps) * torch.exp(log_level).unsqueeze(-1)
        cases.append(
            {
                "tier": tier,
                "solver": kind,
                "steps": steps,
                "embedding": embedding.flatten().tolist(),
                "motion": motion.flatten().tolist(),
                "previous": previous.flatten().tolist(),
                "noise": noise.flatten().tolist(),
                "log_level": log_level.item(),
                "field_at_start": field(noise, torch.zeros(1, 1)).flatten().tolist(),
                "segment": segment.flatten().tolist(),
            }
        )
    write_json(path, {"model_crc32": f"{model_crc32:08x}", "cases": cases})
