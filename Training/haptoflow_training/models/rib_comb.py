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
# A pulse train at a crawl has its power far above the fundamental.
HARMONICS = 12
PARTIALS = WAVE_VECTORS * HARMONICS
COMB_CHANNELS = 2 * WAVE_VECTORS
# Of each partial: carried on, fresh, as it stands in the noise, and carried on at an amplitude of its own.
GAINS = 4 * PARTIALS
# In unit scale a line of all the power there is has an amplitude of 1.4: one that has grown beyond is not carried on as
# it is, so that a line whose gain is a little above 1 in the loop cannot run away.
_LARGEST_AMPLITUDE = 1.5
# Below this fundamental the past holds less than a period; above the other, a harmonic leaves the band.
_LOWEST_FUNDAMENTAL_HZ, _HIGHEST_HZ = 9.0, 960.0
_SMALL = 1e-5


class RibComb(nn.Module):
    """Hears noise and past, and tells what the ribs of label and motion make of them.

    Partials are the harmonics of both wave vectors; their amplitudes are [B, 1, 48], cosines, then sines, counted
    from the middle between past and segment.
    """

    turn: Tensor
    phase: Tensor
    weight: Tensor
    order: Tensor
    backwards: Tensor
    families: Tensor

    def __init__(self, samples: int = 200) -> None:
        super().__init__()
        self.samples = samples
        # Counted from half a sample before the segment: as far as the past's last sample is from there.
        seconds = (torch.arange(samples) + 0.5) / SAMPLE_RATE_HZ
        self.register_buffer("turn", (2.0 * math.pi * seconds).reshape(1, samples, 1), persistent=False)
        # A cosine is a sine that is a quarter turn ahead.
        phase = torch.tensor([0.5 * math.pi, 0.0]).repeat_interleave(PARTIALS)
        self.register_buffer("phase", phase.reshape(1, 1, -1), persistent=False)
        # The newest past counts most: a hand that speeds up has left the older pitch behind.
        weight = torch.linspace(1.0, 0.05, samples)
        self.register_buffer("weight", (2.0 * weight / weight.sum()).reshape(1, 1, samples), persistent=False)
        order = torch.arange(1, HARMONICS + 1, dtype=torch.float32)
        self.register_buffer("order", order.reshape(1, 1, HARMONICS), persistent=False)
        backwards = torch.tensor([1.0, -1.0]).repeat_interleave(PARTIALS)
        self.register_buffer("backwards", backwards.reshape(1, 1, -1), persistent=False)
        families = torch.eye(WAVE_VECTORS).repeat_interleave(HARMONICS, dim=1)
        rows = torch.cat([families, families, torch.ones(1, PARTIALS)]).unsqueeze(1)
        self.register_buffer("families", rows.unsqueeze(0), persistent=False)

    def waves(self, embedding: Tensor, motion: Tensor) -> tuple[Tensor, Tensor]:
        """Cosines, then sines, of all partials at one motion, [B, N, 48]; and [B, 1, 48], 1 where a partial can sound
        and be told apart, else 0. embedding [B, 64], motion [B, 3]; no gradient: wave vectors are not learnt."""
        fundamental = rib_frequencies_hz(embedding.detach(), motion).unsqueeze(2)
        frequency = fundamental * self.order
        told_apart = (fundamental > _LOWEST_FUNDAMENTAL_HZ) & (frequency < _HIGHEST_HZ)
        audible, frequency = (
            torch.cat([values, values], dim=1).reshape(-1, 1, 2 * PARTIALS)
            for values in (told_apart.to(motion.dtype), frequency)
        )
        return torch.sin(frequency * self.turn + self.phase), audible

    def amplitudes(self, waves: Tensor, segment: Tensor) -> Tensor:
        """Of a segment [B, 1, N]: a projection on the whole of it, [B, 1, 48]."""
        return segment * (2.0 / self.samples) @ waves

    def carried(self, waves: Tensor, mirrored: Tensor) -> Tensor:
        """Of the segment that would follow if every partial went on. mirrored [B, 1, N]: the past, newest first."""
        # Time runs backwards there: cosines are the same, sines change their sign.
        return mirrored * self.weight @ waves * self.backwards

    def coherence(self, waves: Tensor, segment: Tensor, mirrored: Tensor) -> Tensor:
        """A segment's amplitudes seen from its past's: [B, 2, 24], what goes on in phase and what a quarter turn off.

        What is comparable between two segments that follow different pasts. Zero where the past has no such partial.
        """
        cosine, sine = self.amplitudes(waves, segment).squeeze(1).chunk(2, dim=1)
        past = self.carried(waves, mirrored).reshape(-1, 2, PARTIALS)
        past_cosine, past_sine = (past / (past.norm(dim=1, keepdim=True) + _SMALL)).unbind(dim=1)
        in_phase = cosine * past_cosine + sine * past_sine
        return torch.stack([in_phase, cosine * past_sine - sine * past_cosine], dim=1)

    def forward(self, noisy: Tensor, mirrored: Tensor, embedding: Tensor, motion: Tensor, gains: Tensor) -> Tensor:
        """[B, 5, N]: channels for the network, then lines, from noise and mirrored past [B, 1, N].

        Channels: for each wave vector the past carried on, then noise of unit partials with a phase of its own, which
        is what a touch-down from silence starts from. Lines: the sum of all partials, carried on (no larger than all
        the power there is), fresh, as they stand in the noise, and of unit size with the phase of the past, by gains
        [B, 96] in that order. The last holds a line's level in the loop, where the first alone would let it fade.
        """
        waves, audible = self.waves(embedding, motion)
        heard = torch.cat([self.carried(waves, mirrored), self.amplitudes(waves, noisy)], dim=1) * audible
        pairs = heard.reshape(-1, 2, 2, PARTIALS)
        carried, own = pairs.split(1, dim=1)
        carried_size, own_size = (pairs.norm(dim=2, keepdim=True) + _SMALL).split(1, dim=1)
        fresh = own / own_size
        kept, drawn, left, held = gains.reshape(-1, 4, 1, PARTIALS).split(1, dim=1)
        bounded = kept * torch.clamp(_LARGEST_AMPLITUDE / carried_size, max=1.0)
        lines = carried * (bounded + held / carried_size) + fresh * drawn + own * left
        rows = torch.cat([carried, carried, fresh, fresh, lines], dim=1) * self.families
        return rows.reshape(-1, COMB_CHANNELS + 1, 2 * PARTIALS) @ waves.transpose(1, 2)
