"""Conditional flow matching (HaptoFlow paper, equations 1 to 3; Lipman et al. 2023) and the solvers that sample it."""

from __future__ import annotations

from collections.abc import Callable

import torch
from torch import Tensor

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
