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
# How many samples follow a place whose sine is computed.
_STRIDE = 20


class RibComb(nn.Module):
    """Hears noise and past, and tells what the ribs of label and motion make of them.

    Partials are the harmonics of both wave vectors, one family after the other; each has a cosine and a sine, counted
    from the middle between past and segment.
    """

    turn: Tensor
    phase: Tensor
    weights: Tensor
    backwards: Tensor
    order: Tensor
    families: Tensor

    def __init__(self, samples: int = 200) -> None:
        super().__init__()
        if samples % _STRIDE != 0:
            raise ValueError(f"{samples} samples do not divide into strides of {_STRIDE}")
        self.samples = samples
        # Sines of sums from products of sines: 10 places and 20 samples after each stand for all 200. In each partial's
        # row stand (cos, -sin) of the places for its cosine, (sin, cos) for its sine, then cos and sin of the samples,
        # counted from half a sample before the segment: as far as the past's last sample is from there. All are sines:
        # a cosine is one that is a quarter turn ahead.
        quarter = 0.5 * math.pi
        places = torch.arange(0, samples, _STRIDE).repeat_interleave(2).repeat(2)
        within = (torch.arange(_STRIDE) + 0.5).repeat(2)
        turn = 2.0 * math.pi / SAMPLE_RATE_HZ * torch.cat([places, within])
        self.register_buffer("turn", turn.reshape(1, 1, -1), persistent=False)
        strides = samples // _STRIDE
        phase = torch.cat(
            [
                torch.tensor([quarter, 2.0 * quarter]).repeat(strides),
                torch.tensor([0.0, quarter]).repeat(strides),
                torch.tensor([quarter, 0.0]).repeat_interleave(_STRIDE),
            ]
        )
        self.register_buffer("phase", phase.reshape(1, 1, -1), persistent=False)
        # The newest past counts most: a hand that speeds up has left the older pitch behind.
        newest_first = torch.linspace(1.0, 0.05, samples)
        weights = torch.stack([newest_first / newest_first.sum(), torch.full((samples,), 1.0 / samples)])
        self.register_buffer("weights", 2.0 * weights.unsqueeze(0), persistent=False)
        # Time runs backwards in the mirrored past: cosines are the same, sines change their sign.
        backwards = torch.tensor([[1.0, -1.0], [1.0, 1.0]])
        self.register_buffer("backwards", backwards.reshape(1, 2, 1, 2), persistent=False)
        order = torch.arange(1, HARMONICS + 1, dtype=torch.float32)
        self.register_buffer("order", order.reshape(1, 1, HARMONICS), persistent=False)
        families = torch.eye(WAVE_VECTORS).repeat_interleave(HARMONICS, dim=1)
        rows = torch.cat([families, families, torch.ones(1, PARTIALS)])
        self.register_buffer("families", rows.reshape(1, COMB_CHANNELS + 1, PARTIALS, 1), persistent=False)

    def waves(self, embedding: Tensor, motion: Tensor) -> tuple[Tensor, Tensor]:
        """Cosine and sine of each partial at one motion, [B, 48, N]; and [B, 1, 24, 1], 1 where a partial can sound
        and be told apart, else 0. embedding [B, 64], motion [B, 3]; no gradient: wave vectors are not learnt."""
        fundamental = rib_frequencies_hz(embedding.detach(), motion)
        frequency = fundamental * self.order
        told_apart = (fundamental > _LOWEST_FUNDAMENTAL_HZ) & (frequency < _HIGHEST_HZ)
        audible = told_apart.to(motion.dtype).reshape(-1, 1, PARTIALS, 1)
        sines = torch.sin(frequency.reshape(-1, PARTIALS, 1) * self.turn + self.phase)
        places, within = sines.split([4 * self.samples // _STRIDE, 2 * _STRIDE], dim=2)
        places = places.reshape(-1, PARTIALS, 2 * self.samples // _STRIDE, 2)
        waves = _thin_product(places, within.reshape(-1, PARTIALS, 2, _STRIDE))
        return waves.reshape(-1, 2 * PARTIALS, self.samples), audible

    def amplitudes(self, waves: Tensor, audible: Tensor, mirrored: Tensor, segment: Tensor) -> Tensor:
        """[B, 2, 24, 2], cosine and sine: what every partial of the past would be if it went on, then what it is in the
        segment. mirrored [B, 1, N]: the past, newest first; segment [B, 1, N]."""
        projected = torch.cat([mirrored, segment], dim=1) * self.weights @ waves.transpose(1, 2)
        return projected.reshape(-1, 2, PARTIALS, 2) * (audible * self.backwards)

    def coherence(self, waves: Tensor, audible: Tensor, mirrored: Tensor, segment: Tensor) -> Tensor:
        """A segment's amplitudes seen from its past's: [B, 2, 24], what goes on in phase and what a quarter turn off.

        What is comparable between two segments that follow different pasts. Zero where the past has no such partial.
        """
        past, own = self.amplitudes(waves, audible, mirrored, segment).unbind(dim=1)
        past_cosine, past_sine = (past / (past.norm(p=2, dim=2, keepdim=True) + _SMALL)).unbind(dim=2)
        cosine, sine = own.unbind(dim=2)
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
        pairs = self.amplitudes(waves, audible, mirrored, noisy)
        carried, own = pairs.split(1, dim=1)
        carried_size, own_size = (pairs.norm(p=2, dim=3, keepdim=True) + _SMALL).split(1, dim=1)
        fresh = own / own_size
        kept, drawn, left, held = gains.reshape(-1, 4, PARTIALS, 1).split(1, dim=1)
        bounded = kept * torch.clamp(_LARGEST_AMPLITUDE / carried_size, max=1.0)
        lines = carried * (bounded + held / carried_size) + fresh * drawn + own * left
        rows = torch.cat([carried, carried, fresh, fresh, lines], dim=1) * self.families
        return rows.reshape(-1, COMB_CHANNELS + 1, 2 * PARTIALS) @ waves


def _thin_product(left: Tensor, right: Tensor) -> Tensor:
    """[B, P, K, 2] times [B, P, 2, M]. ONNX Runtime is quickest with matrices; PyTorch takes such small ones one by one."""
    if torch.onnx.is_in_onnx_export():
        return left @ right
    return left[..., 0:1] * right[..., 0:1, :] + left[..., 1:2] * right[..., 1:2, :]
