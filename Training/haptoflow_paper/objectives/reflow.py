"""Reflow, the second round of rectified flow (Liu et al. 2023): straightens a flow on pairs the network made itself."""

from __future__ import annotations

from dataclasses import dataclass, fields

import torch
from torch import Tensor

from haptoflow_paper.runs.flow_matching import Field, interpolate, solve
from haptoflow_paper.runs.velocity_field import FieldModel
from haptoflow_training.models.label_embedding import surface_phases
from haptoflow_training.models.level_model import scaled_previous
from haptoflow_training.training.batches import SegmentBatch


@dataclass(frozen=True)
class ReflowPairs:
    """Noise [n, C, N] and the segments [n, C, N] that the teacher made of it, with their conditions; previous
    waveform in unit scale."""

    noise: Tensor
    target: Tensor
    previous: Tensor
    label: Tensor
    motion: Tensor
    position_mm: Tensor
    wander: Tensor

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
            self.wander[rows],
        )

    def loss(self, model: FieldModel, generator: torch.Generator) -> Tensor:
        """`reflow_loss` of the model's velocity field."""
        embedding = model.embedding(self.label)
        phases = surface_phases(embedding, self.motion, self.position_mm, self.wander)

        def field(noisy: Tensor, time: Tensor) -> Tensor:
            return model.field(noisy, time, self.previous, embedding, self.motion, phases)

        return reflow_loss(field, self, generator)

    @staticmethod
    def joined(parts: list[ReflowPairs]) -> ReflowPairs:
        """All pairs of the parts as one set."""
        names = [field.name for field in fields(ReflowPairs)]
        return ReflowPairs(**{name: torch.cat([getattr(part, name) for part in parts]) for name in names})


@torch.no_grad()
def own_pairs(model: FieldModel, batch: SegmentBatch, generator: torch.Generator) -> ReflowPairs:
    """Noise, and the segments that the model's flow makes of it under the conditions of a batch."""
    embedding = model.embedding(batch.label)
    previous = model.encode(scaled_previous(batch.previous, model.level(embedding, batch.motion)))
    noise = torch.randn(batch.label.shape[0], *model.shape, generator=generator)
    phases = surface_phases(embedding, batch.motion, batch.position_mm, batch.wander)

    def field(noisy: Tensor, time: Tensor) -> Tensor:
        return model.field(noisy, time, previous, embedding, batch.motion, phases)

    target = solve(field, noise, "midpoint", 4)
    return ReflowPairs(noise, target, previous, batch.label, batch.motion, batch.position_mm, batch.wander)


def reflow_loss(field: Field, pairs: ReflowPairs, generator: torch.Generator) -> Tensor:
    """The mean of |u(x_t, t) - (x_1 - x_0)|^2 over the pairs; for half of them t is 0, where the one step starts."""
    count = pairs.noise.shape[0]
    time = torch.rand(count, 1, generator=generator)
    time[: count // 2] = 0.0
    state = interpolate(pairs.noise, pairs.target, time)
    return (field(state, time) - (pairs.target - pairs.noise)).square().mean()
