"""Burg's method: reflection coefficients of short recordings (Burg 1975), a batch at a time."""

from __future__ import annotations

import torch
from torch import Tensor

_SMALL = 1e-9
_MAXIMUM_REFLECTION = 0.999


def burg_reflection(waves: Tensor, order: int) -> Tensor:
    """waves [B, N] to the reflection coefficients [B, order] that minimise the sum of squared forward and backward
    prediction errors, order after order; all within -1 and 1, in the sign of `step_up` (models/all_pole_filter.py)."""
    forward, backward, found = waves, waves, []
    for _ in range(order):
        ahead, behind = forward[:, 1:], backward[:, :-1]
        power = ahead.square().sum(dim=1) + behind.square().sum(dim=1)
        reflection = -2.0 * (ahead * behind).sum(dim=1) / (power + _SMALL)
        found.append(reflection)
        column = reflection.unsqueeze(1)
        forward, backward = ahead + column * behind, behind + column * ahead
    return torch.stack(found, dim=1)


def burg_distance(raw: Tensor, waves: Tensor) -> Tensor:
    """[B]: the squared distance of predictions [B, M + 1] for `PredictedFilter` from Burg's estimates of recorded
    segments [B, N], in the arguments of the reflection coefficients, and of the predicted level from that of unit scale.

    The mean of short estimates is not the best filter, but near it, and there is one way there: a likelihood alone,
    from a random start, often ends with a false peak near the band's end.
    """
    reflection = burg_reflection(waves, raw.shape[1] - 1).clamp(-_MAXIMUM_REFLECTION, _MAXIMUM_REFLECTION)
    wanted = torch.cat([torch.atanh(reflection), torch.zeros_like(raw[:, :1])], dim=1)
    return (raw - wanted).square().sum(dim=1)
