"""What fitting an all-pole filter to recorded segments takes, by likelihood or Burg's method: a noise floor, and weights
of what can be felt and of what has no lines."""

from __future__ import annotations

import torch
from torch import Tensor

from haptoflow_training.models.surface_waves import MINIMUM_HZ
from haptoflow_training.waveform import SEGMENT_SAMPLES

_SMALL = 1e-6
# Noise added to recordings before a filter is fitted. Where nothing is felt, a filter has better uses for its poles.
_FLOOR_MPS2 = 0.005
# In unit scale at most this: 45 dB below the level.
_LARGEST_FLOOR = 10.0 ** (-45.0 / 20.0)
# A vibration of this RMS weighs half.
_FAINT_MPS2 = 0.03


def with_floor(segment: Tensor, log_level: Tensor, generator: torch.Generator) -> Tensor:
    """Segments [B, 1, 200] in unit scale, of the level exp(log_level) [B, 1] in m/s^2, over the noise floor."""
    floor = (_FLOOR_MPS2 * torch.exp(-log_level.detach())).clamp(max=_LARGEST_FLOOR).unsqueeze(2)
    return segment + floor * torch.randn(segment.shape, generator=generator)


def motion_at(motion_path: Tensor, sample: int) -> Tensor:
    """[B, 3]: the motion at about a sample of segments whose motions are known at evenly spaced samples [B, K, 3], from
    the first to the last."""
    return motion_path[:, round(sample * (motion_path.shape[1] - 1) / (SEGMENT_SAMPLES - 1))]


def audible(log_level: Tensor) -> Tensor:
    """[B]: near 1 where the expected level exp(log_level) [B, 1] in m/s^2 can be felt, 0 at rest, where nothing is
    recorded. All other segments weigh alike: weighting down unpredictable ones would bias a likelihood towards too little
    variance."""
    power = log_level.detach().squeeze(1).mul(2.0).exp()
    return power / (power + _FAINT_MPS2**2)


def without_waves(rates_hz: Tensor) -> Tensor:
    """[B]: 1 where all families of the surface's waves [B, F] stand still, else 0. Burg's method takes their lines for
    resonances."""
    return (rates_hz.abs() <= MINIMUM_HZ).all(dim=1).to(rates_hz.dtype)


def weighted_mean(values: Tensor, weight: Tensor) -> Tensor:
    """Of [B] each."""
    return (weight * values).sum() / (weight.sum() + _SMALL)
