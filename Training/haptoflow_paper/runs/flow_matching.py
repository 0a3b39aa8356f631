"""Conditional flow matching (HaptoFlow paper, equations 1 to 3; Lipman et al. 2023) and the solvers that sample it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields

import torch
from functorch import jvp
from torch import Tensor

from haptoflow_paper.runs.velocity_field import FieldModel
from haptoflow_training.models.label_embedding import surface_phases
from haptoflow_training.models.level_model import scaled_previous
from haptoflow_training.training.batches import SegmentBatch

Field = Callable[[Tensor, Tensor], Tensor]


def interpolate(noise: Tensor, target: Tensor, time: Tensor) -> Tensor:
    """x_t = (1 - t) x_0 + t x_1; noise and target [B, C, N], time [B, 1]."""
    weight = time.unsqueeze(-1)
    return (1.0 - weight) * noise + weight * target


def flow_matching_loss(
    field: Field, target: Tensor, generator: torch.Generator | None = None, weight: Tensor | None = None
) -> Tensor:
    """E |u(x_t, t) - (x_1 - x_0)|^2 with x_0 ~ N(0, I), t ~ U(0, 1); target [B, C, N] in unit scale, weight [B].

    Times are stratified over the batch: the same expectation with less variance.
    """
    count = target.shape[0]
    noise = torch.randn(target.shape, generator=generator, dtype=target.dtype)
    strata = (torch.arange(count).unsqueeze(1) + torch.rand(count, 1, generator=generator)) / count
    time = strata[torch.randperm(count, generator=generator)].to(target.dtype)
    error = (field(interpolate(noise, target, time), time) - (target - noise)).square().mean(dim=(1, 2))
    return error.mean() if weight is None else (weight * error).sum() / weight.sum()


def solve(field: Field, noise: Tensor, kind: str, steps: int) -> Tensor:
    """Integrate noise [B, C, N] from time 0 to 1 with `steps` steps of `euler`, `midpoint` or `heun`."""
    state, width = noise, 1.0 / steps
    for step in range(steps):
        time = torch.full((noise.shape[0], 1), step * width, dtype=noise.dtype)
        slope = field(state, time)
        if kind == "euler":
            state = state + width * slope
        elif kind == "midpoint":
            state = state + width * field(state + 0.5 * width * slope, time + 0.5 * width)
        elif kind == "heun":
            state = state + 0.5 * width * (slope + field(state + width * slope, time + width))
        else:
            raise ValueError(f"unknown solver '{kind}': euler, midpoint or heun")
    return state


# (noisy, time, interval) -> average velocity.
AverageField = Callable[[Tensor, Tensor, Tensor], Tensor]
_INTERVAL_SHARE = 4
_DERIVATIVE_LIMIT = 20.0


def _interval_times(count: int, generator: torch.Generator) -> tuple[Tensor, Tensor]:
    """(time, interval) of the rows with an interval: a third spans everything, the rest two uniform times."""
    ends = torch.rand(count, 2, generator=generator).sort(dim=1).values
    time, interval = ends[:, 0:1], ends[:, 1:2] - ends[:, 0:1]
    whole = torch.arange(count).unsqueeze(1) < count // 3
    return torch.where(whole, torch.zeros_like(time), time), torch.where(whole, torch.ones_like(time), interval)


def mean_flow_loss(
    field: Callable[[slice], AverageField], target: Tensor, generator: torch.Generator, weight: Tensor
) -> Tensor:
    """Loss over a batch, target [B, C, N] in unit scale, weight [B].

    field(rows) is the field bound to the conditions of these rows. Three quarters of the rows have interval 0 and
    learn the velocity itself; the last quarter learns u = v + d (du/dx v + du/dt - du/dd), the identity of the
    average over [t, t + d] (equation 6 there, for a flow from noise at 0 to data at 1), its right side held fixed.
    """
    count = target.shape[0]
    split = count - count // _INTERVAL_SHARE
    noise = torch.randn(target.shape, generator=generator)
    velocity = target - noise

    plain = slice(0, split)
    time = torch.rand(split, 1, generator=generator)
    predicted = field(plain)(interpolate(noise[plain], target[plain], time), time, torch.zeros_like(time))
    plain_error = (predicted - velocity[plain]).square().mean(dim=(1, 2))

    ranged = slice(split, count)
    time, interval = _interval_times(count - split, generator)
    state = interpolate(noise[ranged], target[ranged], time)
    ones = torch.ones_like(time)
    average, derivative = jvp(field(ranged), (state, time, interval), (velocity[ranged], ones, -ones))
    width = interval.unsqueeze(-1)
    goal = velocity[ranged] + width * derivative.detach().clamp(-_DERIVATIVE_LIMIT, _DERIVATIVE_LIMIT)
    ranged_error = (average - goal).square().mean(dim=(1, 2))

    error = torch.cat([plain_error, ranged_error])
    adaptive = weight / (error.detach() + 0.01).sqrt()
    return (adaptive * error).sum() / weight.sum()


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
