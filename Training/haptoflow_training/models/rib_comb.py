"""What the ribs of a surface would do next: the past's own harmonics carried on, and the same comb of fresh noise.

A network of local convolutions cannot carry a phase over a hundred milliseconds at any pitch; projecting the past on
the harmonics of the known rib frequency can, exactly, and leaves to the network how much of it to keep.
"""

from __future__ import annotations

import math

import torch
from torch import Tensor, nn

from haptoflow_training.models.label_embedding import WAVE_VECTORS, rib_frequencies_hz

SAMPLE_RATE_HZ = 2000.0
HARMONICS = 8
COMB_CHANNELS = 2 * WAVE_VECTORS
# Below this fundamental the past cannot tell one harmonic from the next; above the other, a harmonic leaves the band.
_LOWEST_FUNDAMENTAL_HZ, _HIGHEST_HZ = 15.0, 960.0


class RibComb(nn.Module):
    """(noisy, previous [B, 1, 200], embedding [B, 64], motion [B, 3]) to [B, 4, 200]: for each wave vector the past
    carried on, then noise of unit harmonics with a phase of its own, which is what a touch-down from silence starts
    from."""

    past_seconds: Tensor
    next_seconds: Tensor
    weight: Tensor
    order: Tensor

    def __init__(self, samples: int = 200) -> None:
        super().__init__()
        time = torch.arange(samples, dtype=torch.float32) / SAMPLE_RATE_HZ
        self.register_buffer("next_seconds", time.reshape(1, 1, 1, samples), persistent=False)
        past = (time - samples / SAMPLE_RATE_HZ).reshape(1, 1, 1, samples)
        self.register_buffer("past_seconds", past, persistent=False)
        # The newest past counts most: a hand that speeds up has left the older pitch behind.
        weight = torch.linspace(0.05, 1.0, samples)
        self.register_buffer("weight", (2.0 * weight / weight.sum()).reshape(1, 1, 1, samples), persistent=False)
        order = torch.arange(1, HARMONICS + 1, dtype=torch.float32)
        self.register_buffer("order", order.reshape(1, 1, HARMONICS), persistent=False)

    def forward(self, noisy: Tensor, previous: Tensor, embedding: Tensor, motion: Tensor) -> Tensor:
        fundamental = rib_frequencies_hz(embedding, motion).unsqueeze(2)
        frequency = fundamental * self.order
        told_apart = (fundamental > _LOWEST_FUNDAMENTAL_HZ) & (frequency < _HIGHEST_HZ)
        audible = told_apart.to(noisy.dtype).unsqueeze(3)
        turns = (2.0 * math.pi * frequency).unsqueeze(3)
        past_angle, next_angle = turns * self.past_seconds, turns * self.next_seconds
        next_cosine, next_sine = next_angle.cos() * audible, next_angle.sin() * audible

        heard = previous.unsqueeze(2) * self.weight
        cosine = (heard * past_angle.cos()).sum(dim=3, keepdim=True)
        sine = (heard * past_angle.sin()).sum(dim=3, keepdim=True)
        carried = (cosine * next_cosine + sine * next_sine).sum(dim=2)

        drawn = noisy.unsqueeze(2)
        cosine = (drawn * next_cosine).sum(dim=3, keepdim=True)
        sine = (drawn * next_sine).sum(dim=3, keepdim=True)
        size = torch.rsqrt(cosine.square() + sine.square() + 1e-6)
        fresh = (size * (cosine * next_cosine + sine * next_sine)).sum(dim=2)
        return torch.cat([carried, fresh], dim=1)
