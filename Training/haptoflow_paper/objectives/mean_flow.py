"""MeanFlow (Geng et al. 2025): the network learns the average velocity over an interval, so any step count works."""

from __future__ import annotations

from collections.abc import Callable

import torch
from functorch import jvp
from torch import Tensor

from haptoflow_paper.runs.flow_matching import interpolate

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
