"""Rectified flow's second round (Liu et al. 2023): a flow straightened on pairs that the network made itself."""

from __future__ import annotations

from dataclasses import dataclass

import torch
from torch import Tensor

from haptoflow_training.training.batches import SegmentBatch
from haptoflow_training.training.flow_matching import Field, interpolate


@dataclass(frozen=True)
class ReflowPairs:
    """Noise [n, C, N] and what the teacher made of it [n, C, N], with the conditions; previous in unit scale."""

    noise: Tensor
    target: Tensor
    previous: Tensor
    label: Tensor
    motion: Tensor
    position_mm: Tensor

    def draw(self, count: int, generator: torch.Generator) -> ReflowPairs:
        """`count` pairs at random."""
        rows = torch.randint(self.noise.shape[0], (count,), generator=generator)
        return ReflowPairs(
            self.noise[rows],
            self.target[rows],
            self.previous[rows],
            self.label[rows],
            self.motion[rows],
            self.position_mm[rows],
        )


def join_pairs(parts: list[tuple[Tensor, Tensor, Tensor, SegmentBatch]]) -> ReflowPairs:
    """Parts of (noise, target, previous in unit scale, batch) as one set."""
    return ReflowPairs(
        torch.cat([part[0] for part in parts]),
        torch.cat([part[1] for part in parts]),
        torch.cat([part[2] for part in parts]),
        torch.cat([part[3].label for part in parts]),
        torch.cat([part[3].motion for part in parts]),
        torch.cat([part[3].position_mm for part in parts]),
    )


def reflow_loss(field: Field, pairs: ReflowPairs, generator: torch.Generator) -> Tensor:
    """E |u(x_t, t) - (x_1 - x_0)|^2 over coupled pairs; half of the times are 0, where the one step starts."""
    count = pairs.noise.shape[0]
    time = torch.rand(count, 1, generator=generator)
    time[: count // 2] = 0.0
    state = interpolate(pairs.noise, pairs.target, time)
    return (field(state, time) - (pairs.target - pairs.noise)).square().mean()
