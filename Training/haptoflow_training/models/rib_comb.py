"""What the ribs of a surface would do next: the past's own harmonics carried on, and the same comb of fresh noise.

The network hears both as channels, and adds each harmonic to its output with a gain of its own: a line that has to hold
its phase over many hops must not pass through layers that blur it.

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
# Carried on, fresh, and the noise's own share at that pitch, each harmonic of each wave vector.
LINES = 3 * WAVE_VECTORS * HARMONICS
# In unit scale a line of all the power there is has an amplitude of 1.4: one that has grown beyond is not carried on as
# it is, so that a line whose gain is a little above 1 in the loop cannot run away.
_LARGEST_AMPLITUDE = 1.5
# Below this fundamental the past cannot tell one harmonic from the next; above the other, a harmonic leaves the band.
_LOWEST_FUNDAMENTAL_HZ, _HIGHEST_HZ = 15.0, 960.0


class RibComb(nn.Module):
    """(noisy, previous [B, 1, 200], embedding [B, 64], motion [B, 3]) to channels [B, 4, 200] and lines [B, 48, 200].

    Channels: for each wave vector the past carried on, then noise of unit harmonics with a phase of its own, which is
    what a touch-down from silence starts from. Lines: each harmonic by itself: carried on, fresh, and as it stands in
    the noise.
    """

    seconds: Tensor
    weight: Tensor
    order: Tensor

    def __init__(self, samples: int = 200) -> None:
        super().__init__()
        self.past_seconds = samples / SAMPLE_RATE_HZ
        time = torch.arange(samples, dtype=torch.float32) / SAMPLE_RATE_HZ
        self.register_buffer("seconds", time.reshape(1, 1, 1, samples), persistent=False)
        # The newest past counts most: a hand that speeds up has left the older pitch behind.
        weight = torch.linspace(0.05, 1.0, samples)
        self.register_buffer("weight", (2.0 * weight / weight.sum()).reshape(1, 1, 1, samples), persistent=False)
        order = torch.arange(1, HARMONICS + 1, dtype=torch.float32)
        self.register_buffer("order", order.reshape(1, 1, HARMONICS), persistent=False)

    def forward(self, noisy: Tensor, previous: Tensor, embedding: Tensor, motion: Tensor) -> tuple[Tensor, Tensor]:
        # Wave vectors are not learnt: without the detour through their gradient a step costs a fifth less.
        fundamental = rib_frequencies_hz(embedding.detach(), motion).unsqueeze(2)
        frequency = fundamental * self.order
        told_apart = (fundamental > _LOWEST_FUNDAMENTAL_HZ) & (frequency < _HIGHEST_HZ)
        audible = told_apart.to(noisy.dtype).unsqueeze(3)
        turns = (2.0 * math.pi * frequency).unsqueeze(3)
        angle = turns * self.seconds
        cosine, sine = angle.cos() * audible, angle.sin() * audible

        # Measured from the beginning of the past; a whole past later, each harmonic has turned on by this much.
        heard = previous.unsqueeze(2) * self.weight
        real, imaginary = (heard * cosine).sum(dim=3, keepdim=True), (heard * sine).sum(dim=3, keepdim=True)
        advance = turns * self.past_seconds
        ahead, aside = advance.cos(), advance.sin()
        turned_real, turned_imaginary = real * ahead + imaginary * aside, imaginary * ahead - real * aside
        carried = turned_real * cosine + turned_imaginary * sine
        amplitude_inverse = torch.rsqrt(turned_real.square() + turned_imaginary.square() + 1e-6)

        drawn = noisy.unsqueeze(2)
        real, imaginary = (drawn * cosine).sum(dim=3, keepdim=True), (drawn * sine).sum(dim=3, keepdim=True)
        size = torch.rsqrt(real.square() + imaginary.square() + 1e-6)
        own = real * cosine + imaginary * sine
        fresh = size * own
        channels = torch.cat([carried.sum(dim=2), fresh.sum(dim=2)], dim=1)
        # A projection on the whole segment; twice its mean is a harmonic's own share.
        own = own * (2.0 / noisy.shape[2])
        bounded = carried * torch.clamp(_LARGEST_AMPLITUDE * amplitude_inverse, max=1.0)
        lines = torch.stack([bounded, fresh, own], dim=1).reshape(-1, LINES, noisy.shape[2])
        return channels, lines
