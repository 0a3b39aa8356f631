"""What the ribs of a surface would do next: the past's own harmonics carried on, and those of the place on the surface.

A network of local convolutions cannot carry a phase over a hundred milliseconds at any pitch. Projecting the past on the
harmonics of the known rib frequency can, exactly; and the rib phase, which the engine counts from the travelled distance,
says where on its profile the tip is, so that all harmonics keep their places to each other for as long as a stroke lasts.
How much of either a surface needs is learnt: machined ribs follow the phase, woven threads wander from it. Where they
have wandered to, the past tells: the profile is laid over it at every offset, and the partials of those that fit go on
together.
"""

from __future__ import annotations

import math

import torch
from torch import Tensor, nn

from haptoflow_training.models.label_embedding import WAVE_VECTORS, signed_rib_frequencies_hz

SAMPLE_RATE_HZ = 2000.0
# A pulse train at a crawl has its power far above the fundamental.
HARMONICS = 14
PARTIALS = WAVE_VECTORS * HARMONICS
COMB_CHANNELS = 2 * WAVE_VECTORS + 1
# Of each partial: the past's carried on, carried on at an amplitude of its own, and two of the surface's: in phase with
# the rib phase and a quarter turn behind it; then two of the profile that wanders. Of each wave vector: how sharply the
# past decides where that has wandered to, and how near to the rib phase it stays, as logarithms.
GAINS = 6 * PARTIALS + 2 * WAVE_VECTORS
# In unit scale a line of all the power there is has an amplitude of 1.4: one that has grown beyond is not carried on as
# it is, so that a line whose gain is a little above 1 in the loop cannot run away.
_LARGEST_AMPLITUDE = 1.5
# The past holds a partial where it holds nearly a period of the fundamental; the surface has one wherever the tip moves.
_LOWEST_IN_PAST_HZ, _LOWEST_HZ, _HIGHEST_HZ = 9.0, 0.5, 960.0
# Below, the partials of one segment cannot be told from each other.
_LOWEST_TOLD_APART_HZ = 5.0
# Partials of unit size that stand in phase make pulses 14 times as high as one of them.
_PULSE_SCALE = 0.3
_SMALL = 1e-5
# Offsets at which the wandering profile is laid over the past, how sharply a partial of size 1 decides, and how near to
# the rib phase it stays (as of a von Mises distribution), both before anything is learnt.
_OFFSETS = 64
_SHARPNESS, _NEARNESS = 8.0, 2.0
_LARGEST_LOGARITHM = 3.0
# How many samples follow a place whose sine is computed.
_STRIDE = 20


class RibComb(nn.Module):
    """Hears past and rib phase, and tells what the ribs of label and motion make of them.

    Partials are the harmonics of both wave vectors, one family after the other; each has a cosine and a sine, counted
    from the middle between past and segment.
    """

    turn: Tensor
    phase: Tensor
    weights: Tensor
    even: Tensor
    mirror: Tensor
    order: Tensor
    turns: Tensor
    quarters: Tensor
    families: Tensor
    overlaps: Tensor
    turned_by: Tensor
    nearness: Tensor

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
        self.register_buffer("weights", (2.0 * newest_first / newest_first.sum()).reshape(1, 1, -1), persistent=False)
        self.register_buffer("even", torch.full((1, 1, samples), 2.0 / samples), persistent=False)
        # Time runs backwards in the mirrored past: cosines are the same, sines change their sign.
        self.register_buffer("mirror", torch.tensor([[[1.0, -1.0]]]), persistent=False)
        order = torch.arange(1, HARMONICS + 1, dtype=torch.float32)
        self.register_buffer("order", order.reshape(1, 1, HARMONICS), persistent=False)
        self.register_buffer("turns", 2.0 * math.pi * order.reshape(1, 1, HARMONICS), persistent=False)
        self.register_buffer("quarters", torch.tensor([quarter, 0.0]).reshape(1, 1, 2), persistent=False)
        families = torch.eye(WAVE_VECTORS).repeat_interleave(HARMONICS, dim=1)
        rows = torch.cat([families, _PULSE_SCALE * families, torch.ones(1, PARTIALS)])
        self.register_buffer("families", rows.reshape(1, COMB_CHANNELS, PARTIALS, 1), persistent=False)
        offsets = 2.0 * math.pi * torch.arange(_OFFSETS) / _OFFSETS
        turned = order.unsqueeze(1) * offsets
        self.register_buffer("overlaps", torch.cat([turned.cos(), turned.sin()]).unsqueeze(0), persistent=False)
        self.register_buffer("turned_by", torch.cat([turned.cos(), turned.sin()]).t().unsqueeze(0), persistent=False)
        self.register_buffer("nearness", _NEARNESS * offsets.cos().reshape(1, 1, -1), persistent=False)

    def waves(self, embedding: Tensor, motion: Tensor) -> tuple[Tensor, Tensor]:
        """Cosine and sine of each partial at one motion, [B, 56, N]; and the signed fundamentals [B, 2, 1] in Hz.
        embedding [B, 64], motion [B, 3]; no gradient: wave vectors are not learnt."""
        signed = signed_rib_frequencies_hz(embedding.detach(), motion)
        frequency = signed.abs() * self.order
        sines = torch.sin(frequency.reshape(-1, PARTIALS, 1) * self.turn + self.phase)
        places, within = sines.split([4 * self.samples // _STRIDE, 2 * _STRIDE], dim=2)
        places = places.reshape(-1, PARTIALS, 2 * self.samples // _STRIDE, 2)
        waves = _thin_product(places, within.reshape(-1, PARTIALS, 2, _STRIDE))
        return waves.reshape(-1, 2 * PARTIALS, self.samples), signed

    def audible(self, signed_hz: Tensor, lowest_hz: float) -> Tensor:
        """[B, 28, 1], 1 where a partial can sound and its fundamental is above lowest_hz, else 0."""
        fundamental = signed_hz.abs()
        inside = (fundamental > lowest_hz) & (fundamental * self.order < _HIGHEST_HZ)
        return inside.to(signed_hz.dtype).reshape(-1, PARTIALS, 1)

    def surface(self, signed_hz: Tensor, rib_phase: Tensor) -> Tensor:
        """[B, 28, 2]: cosine and sine of each partial's phase at the middle between past and segment, from the rib phase
        [B, 2] in turns at the segment's first sample, counted the way in which the tip moves."""
        ahead = torch.sign(signed_hz) * rib_phase.unsqueeze(2) - signed_hz.abs() * (0.5 / SAMPLE_RATE_HZ)
        return torch.sin((ahead * self.turns).reshape(-1, PARTIALS, 1) + self.quarters)

    def profile(self, embedding: Tensor, motion: Tensor, rib_phase: Tensor, segments: Tensor) -> tuple[Tensor, Tensor]:
        """The partials of S segments [B, S, N] as the surface sees them: [B, S, 2, 28], in phase with the rib phase and a
        quarter turn behind; and which of them can be told apart, [B, 28]."""
        waves, signed = self.waves(embedding, motion)
        told_apart = self.audible(signed, _LOWEST_TOLD_APART_HZ).squeeze(2)
        amplitudes = (segments * self.even @ waves.transpose(1, 2)).reshape(len(waves), -1, PARTIALS, 2)
        cosine, sine = (amplitudes * told_apart.reshape(-1, 1, PARTIALS, 1)).unbind(dim=3)
        ahead, behind = self.surface(signed, rib_phase).unsqueeze(1).unbind(dim=3)
        in_phase = cosine * ahead - sine * behind
        return torch.stack([in_phase, cosine * behind + sine * ahead], dim=2), told_apart

    def _wandered(self, wandering: Tensor, profile: Tensor, carried: Tensor, by_family: Tensor) -> Tensor:
        """Partials [B, 28, 2] that go on from where the profile fits the past [B, 28, 2]: the mean over offsets, each as
        likely as it overlaps with what is carried on and lies near the rib phase. by_family [B, 4]: logarithms of how
        sharp and how near."""
        sharp, near = by_family.clamp(-_LARGEST_LOGARITHM, _LARGEST_LOGARITHM).exp().reshape(-1, 2, WAVE_VECTORS, 1).unbind(1)
        cosine, sine = profile.unbind(dim=2)
        past_cosine, past_sine = carried.unbind(dim=2)
        # Of z = cosine - i sine, past times conjugate profile: its angle is what a partial has wandered by.
        overlap = torch.stack([past_cosine * cosine + past_sine * sine, past_cosine * sine - past_sine * cosine], dim=1)
        overlap = overlap.reshape(-1, 2, WAVE_VECTORS, HARMONICS).transpose(1, 2).reshape(-1, WAVE_VECTORS, 2 * HARMONICS)
        likely = torch.softmax(_SHARPNESS * sharp * (overlap @ self.overlaps) + near * self.nearness, dim=2)
        turn = (likely @ self.turned_by).reshape(-1, WAVE_VECTORS, 2, HARMONICS).transpose(1, 2)
        turn_cosine, turn_sine = turn.reshape(-1, 2, PARTIALS, 1).unbind(dim=1)
        ahead, aside = wandering.split(1, dim=2)
        return torch.cat([ahead * turn_cosine + aside * turn_sine, aside * turn_cosine - ahead * turn_sine], dim=2)

    def forward(self, mirrored: Tensor, embedding: Tensor, motion: Tensor, rib_phase: Tensor, gains: Tensor) -> Tensor:
        """[B, 5, N]: four channels and the lines, from the mirrored past [B, 1, N], rib phase [B, 2] and gains [B, 172].

        Channels: for each wave vector the past carried on, then pulses, one for each rib that passes. Lines: the sum of
        all partials: the past's carried on (no larger than all the power there is) and of unit size with the phase of
        the past, then the surface's in phase and a quarter turn behind, then those of the profile that wanders, by gains in
        that order.
        """
        waves, signed = self.waves(embedding, motion)
        carried, pulses, lines = self.partials(waves, signed, mirrored, rib_phase, gains)
        rows = torch.stack([carried, carried, pulses, pulses, lines], dim=1) * self.families
        return rows.reshape(-1, COMB_CHANNELS, 2 * PARTIALS) @ waves

    def partials(
        self, waves: Tensor, signed_hz: Tensor, mirrored: Tensor, rib_phase: Tensor, gains: Tensor
    ) -> tuple[Tensor, Tensor, Tensor]:
        """Cosine and sine of every partial [B, 28, 2] of the past carried on, of the pulses and of the lines."""
        told = self.audible(signed_hz, _LOWEST_IN_PAST_HZ) * self.mirror
        carried = (mirrored * self.weights @ waves.transpose(1, 2)).reshape(-1, PARTIALS, 2) * told
        size = carried.norm(p=2, dim=2, keepdim=True) + _SMALL
        surface = self.surface(signed_hz, rib_phase)
        by_partial, by_family = gains.split([6 * PARTIALS, 2 * WAVE_VECTORS], dim=1)
        kept, held, *profiles = by_partial.reshape(-1, 6, PARTIALS, 1).unbind(dim=1)
        bounded = kept * torch.clamp(_LARGEST_AMPLITUDE / size, max=1.0)
        still, wandering = _turned(profiles[0], profiles[1], surface), _turned(profiles[2], profiles[3], surface)
        wandered = self._wandered(wandering, still + wandering, carried, by_family)
        sounding = self.audible(signed_hz, _LOWEST_HZ)
        lines = carried * (bounded + held / size) + (still + wandered) * sounding
        ahead, aside = surface.split(1, dim=2)
        return carried, torch.cat([ahead, -aside], dim=2) * sounding, lines


def _turned(in_phase: Tensor, behind: Tensor, surface: Tensor) -> Tensor:
    """[B, 28, 2]: cosine and sine of partials p cos(P + a) + q sin(P + a), with P the surface's phase: p cos P + q sin P
    and q cos P - p sin P."""
    ahead, aside = surface.split(1, dim=2)
    return torch.cat([in_phase * ahead + behind * aside, behind * ahead - in_phase * aside], dim=2)


def _thin_product(left: Tensor, right: Tensor) -> Tensor:
    """[B, P, K, 2] times [B, P, 2, M]. ONNX Runtime is quickest with matrices; PyTorch takes such small ones one by one."""
    if torch.onnx.is_in_onnx_export():
        return left @ right
    return left[..., 0:1] * right[..., 0:1, :] + left[..., 1:2] * right[..., 1:2, :]
