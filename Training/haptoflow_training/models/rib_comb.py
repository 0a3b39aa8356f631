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
from typing import NamedTuple

import torch
from torch import Tensor, nn

from haptoflow_training.models.label_embedding import WAVE_VECTORS, signed_rib_frequencies_hz
from haptoflow_training.waveform import SAMPLE_RATE_HZ

# A pulse train at a crawl has its power far above the fundamental.
HARMONICS = 14
PARTIALS = WAVE_VECTORS * HARMONICS
COMB_CHANNELS = 2 * WAVE_VECTORS + 1
# Of each partial: the past's carried on, carried on at an amplitude of its own, and two of the surface's: in phase with
# the rib phase and a quarter turn behind it; then two of the profile that wanders. Of each wave vector: how sharply the
# past decides where that has wandered to, and how near to the rib phase it stays, as logarithms.
GAINS = 6 * PARTIALS + 2 * WAVE_VECTORS
# A family's harmonics, cosine and sine of each side by side.
_PAIRS = 2 * HARMONICS
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


class Ribs(NamedTuple):
    """What ribs are at one motion and place. waves [B, 56, N]: cosine and sine of each partial, counted from the middle
    between past and segment. The others are [B, 1, 2, 28]: a family for each wave vector, and two values for each of its
    harmonics. ahead, across and pulses, with P the phase of the surface there: (cos P, cos P), (sin P, -sin P) and
    (cos P, -sin P). told: (1, -1) where the past can hold a partial, 0 elsewhere: time runs backwards in the mirrored
    past, where cosines are the same and sines change their sign. sounding: 1 where the surface has a partial."""

    waves: Tensor
    ahead: Tensor
    across: Tensor
    pulses: Tensor
    told: Tensor
    sounding: Tensor


def spread_gains() -> Tensor:
    """Indices [228] into the 172 gains of a `RibComb`, in the order in which it takes them. Each gain of the past is
    repeated, for the partial's cosine and its sine; the two gains of a profile's partial are placed side by side. A network
    indexes the weights of the layer that makes its gains: an exported graph then holds the result as a constant, and the
    reordering costs no time."""
    past, profiles, families = torch.arange(GAINS).split([2 * PARTIALS, 4 * PARTIALS, 2 * WAVE_VECTORS])
    pairs = profiles.reshape(2, 2, PARTIALS).transpose(1, 2)
    return torch.cat([past.repeat_interleave(2), pairs.flatten(), families])


class RibComb(nn.Module):
    """Hears past and rib phase, and tells what the ribs of label and motion make of them.

    Partials are the harmonics of both wave vectors, one family after the other; each has a cosine and a sine. Matrices
    stand where loops over partials would be easier to read, and shapes are chosen so that few values have to be laid out
    anew: every node of a graph costs time.
    """

    weight: Tensor
    bias: Tensor
    newest: Tensor
    even: Tensor
    mirror: Tensor
    signs: Tensor
    pairs: Tensor
    families: Tensor
    swap: Tensor
    overlaps: Tensor
    turned_by: Tensor
    nearness: Tensor

    def __init__(self, samples: int = 200) -> None:
        super().__init__()
        if samples % _STRIDE != 0:
            raise ValueError(f"{samples} samples do not divide into strides of {_STRIDE}")
        self.samples, self.strides = samples, samples // _STRIDE
        # Two for each place, twice, two for each sample after a place, and six of the surface.
        self.sines = PARTIALS * (4 * self.strides + 2 * _STRIDE + 6)
        order = torch.arange(1, HARMONICS + 1, dtype=torch.float64)
        weight, bias = _angles_and_limits(order, self.strides)
        self.register_buffer("weight", weight.float(), persistent=False)
        self.register_buffer("bias", bias.float(), persistent=False)
        # The newest past counts most: a hand that speeds up has left the older pitch behind.
        newest_first = torch.linspace(1.0, 0.05, samples)
        self.register_buffer("newest", (2.0 * newest_first / newest_first.sum()).reshape(1, 1, -1), persistent=False)
        self.register_buffer("even", torch.full((1, 1, samples), 2.0 / samples), persistent=False)
        mirror = torch.tensor([1.0, -1.0]).repeat(HARMONICS)
        self.register_buffer("mirror", mirror.reshape(1, 1, 1, _PAIRS), persistent=False)
        signs = torch.cat([mirror.repeat(WAVE_VECTORS), torch.ones(2 * PARTIALS)])
        self.register_buffer("signs", signs, persistent=False)
        family = torch.eye(WAVE_VECTORS)
        rows = torch.cat([family, _PULSE_SCALE * family, torch.ones(1, WAVE_VECTORS)]).unsqueeze(2)
        self.register_buffer("families", rows.repeat(1, 1, _PAIRS).unsqueeze(0), persistent=False)
        self.register_buffer("swap", torch.arange(_PAIRS).reshape(-1, 2).flip(1).flatten(), persistent=False)
        # Sums cosine and sine of a partial, for both of them.
        pairs = torch.eye(HARMONICS).repeat_interleave(2, dim=0).repeat_interleave(2, dim=1)
        self.register_buffer("pairs", pairs, persistent=False)

        offsets = 2.0 * math.pi * torch.arange(_OFFSETS, dtype=torch.float64) / _OFFSETS
        turned = order.unsqueeze(1) * offsets
        # Of z = cosine - i sine, past times conjugate profile, turned back: products of equal parts by cosines, of
        # unequal ones by sines.
        both = [torch.stack(pair, dim=1) for pair in ((turned.cos(), turned.cos()), (turned.sin(), -turned.sin()))]
        turns = torch.cat([each.reshape(-1, _OFFSETS) for each in both])
        self.register_buffer("overlaps", (_SHARPNESS * turns).float(), persistent=False)
        self.register_buffer("turned_by", turns.t().float().contiguous(), persistent=False)
        nearness = (_NEARNESS * offsets.cos()).float().reshape(1, 1, 1, -1)
        self.register_buffer("nearness", nearness, persistent=False)

    def ribs(self, embedding: Tensor, motion: Tensor, rib_phase: Tensor) -> Ribs:
        """Of embedding [B, 64], motion [B, 3] and rib phase [B, 2] in turns at the segment's first sample; no gradient:
        wave vectors are not learnt."""
        signed = signed_rib_frequencies_hz(embedding.detach(), motion).reshape(-1, WAVE_VECTORS)
        # The phase is counted the way in which the tip moves.
        place = torch.cat([signed.abs(), torch.sign(signed) * rib_phase], dim=1)
        angles, limits = torch.addmm(self.bias, place, self.weight).split([self.sines, 4 * PARTIALS], dim=1)
        half = 2 * PARTIALS * _STRIDE
        places, within, surface = torch.sin(angles).split([4 * PARTIALS * self.strides, half, 6 * PARTIALS], dim=1)
        waves = _thin_product(
            places.reshape(-1, PARTIALS, 2 * self.strides, 2), within.reshape(-1, PARTIALS, 2, _STRIDE)
        )
        inside = torch.where(limits.abs() < 1.0, self.signs, torch.zeros_like(self.signs))
        return Ribs(
            waves.reshape(-1, 2 * PARTIALS, self.samples),
            *surface.reshape(-1, 3, WAVE_VECTORS, _PAIRS).split(1, dim=1),
            *inside.reshape(-1, 2, WAVE_VECTORS, _PAIRS).split(1, dim=1),
        )

    def profile(self, embedding: Tensor, motion: Tensor, rib_phase: Tensor, segments: Tensor) -> tuple[Tensor, Tensor]:
        """The partials of S segments [B, S, N] as the surface sees them: [B, S, 2, 28], in phase with the rib phase and a
        quarter turn behind; and which of them can be told apart, [B, 28]."""
        ribs = self.ribs(embedding, motion, rib_phase)
        fundamental = signed_rib_frequencies_hz(embedding.detach(), motion).abs().unsqueeze(1)
        told_apart = (fundamental > _LOWEST_TOLD_APART_HZ).to(motion.dtype) * ribs.sounding
        projected = segments * self.even @ ribs.waves.transpose(1, 2)
        amplitudes = projected.reshape(len(motion), -1, WAVE_VECTORS, _PAIRS)
        # Turned back by the surface's phase: what is across changes its sign.
        seen = (amplitudes * ribs.ahead - self._swapped(amplitudes) * ribs.across) * told_apart
        in_phase_and_behind = seen.reshape(len(motion), -1, PARTIALS, 2).transpose(2, 3)
        return in_phase_and_behind, told_apart.reshape(len(motion), PARTIALS, 2)[:, :, 0]

    def partials(self, ribs: Ribs, mirrored: Tensor, gains: Tensor) -> tuple[Tensor, Tensor]:
        """Cosine and sine of every partial, [B, 1, 2, 28] each: of the past carried on, and of the lines before
        `sounding` takes out what the surface does not have. gains [B, 228]: see `spread_gains`."""
        projected = mirrored * self.newest @ ribs.waves.transpose(1, 2)
        carried = projected.reshape(-1, 1, WAVE_VECTORS, _PAIRS) * ribs.told
        by_partial, by_family = gains.split([8 * PARTIALS, 2 * WAVE_VECTORS], dim=1)
        kept, held, profiles = by_partial.reshape(-1, 4, WAVE_VECTORS, _PAIRS).split([1, 1, 2], dim=1)
        # A matrix sums the squares of each pair without reshaping. The small square keeps the root's gradient finite at
        # zero.
        size = torch.sqrt((carried * carried) @ self.pairs + _SMALL**2)
        from_past = carried * ((kept * size.clamp(max=_LARGEST_AMPLITUDE) + held) / size)

        # A partial p cos(P + a) + q sin(P + a): cosine p cos P + q sin P, sine q cos P - p sin P.
        turned = profiles * ribs.ahead + self._swapped(profiles) * ribs.across
        still, wandering = turned.split(1, dim=1)
        ahead, across = self._wandered(still + wandering, carried, by_family)
        return carried, from_past + (still + (wandering * ahead + self._swapped(wandering) * across))

    def _swapped(self, pairs: Tensor) -> Tensor:
        return torch.index_select(pairs, 3, self.swap)

    def _wandered(self, profile: Tensor, carried: Tensor, by_family: Tensor) -> tuple[Tensor, Tensor]:
        """By what the profile's partials [B, 1, 2, 28] are turned to go on from where they fit the past: the mean over
        offsets, each as likely as it overlaps with what is carried on and lies near the rib phase; as (cosine, cosine) and
        (sine, -sine), [B, 1, 2, 28] each. by_family [B, 4]: logarithms of how sharp and how near."""
        weights = by_family.clamp(-_LARGEST_LOGARITHM, _LARGEST_LOGARITHM).exp()
        sharp, near = weights.reshape(-1, 2, WAVE_VECTORS, 1).split(1, dim=1)
        overlap = torch.cat([carried * profile, carried * self._swapped(profile)], dim=3) @ self.overlaps
        likely = torch.softmax(sharp * overlap + near * self.nearness, dim=3)
        ahead, across = (likely @ self.turned_by).split(_PAIRS, dim=3)
        return ahead, across

    def forward(self, mirrored: Tensor, embedding: Tensor, motion: Tensor, rib_phase: Tensor, gains: Tensor) -> Tensor:
        """[B, 5, N]: four channels and the lines, from the mirrored past [B, 1, N], rib phase [B, 2] and gains [B, 228].

        Channels: for each wave vector the past carried on, then pulses, one for each rib that passes. Lines: the sum of
        all partials: the past's carried on (no larger than all the power there is) and of unit size with the phase of
        the past, then the surface's in phase and a quarter turn behind, then those of the profile that wanders, by gains in
        that order, as `spread_gains` lays them out.
        """
        ribs = self.ribs(embedding, motion, rib_phase)
        carried, lines = self.partials(ribs, mirrored, gains)
        channels = torch.cat([carried, carried, ribs.pulses, ribs.pulses, lines], dim=1)
        rows = channels * self.families * ribs.sounding
        return rows.reshape(-1, COMB_CHANNELS, 2 * PARTIALS) @ ribs.waves


def _angles_and_limits(order: Tensor, strides: int) -> tuple[Tensor, Tensor]:
    """What size and phase of both fundamentals, [B, 4], are multiplied by, and what is added: for the angles whose sines
    are waves and surface, and for two limits of each partial. The first lies between -1 and 1 where the past can hold the
    partial, the second where the surface has it; each stands twice, for cosine and sine.

    Sines of sums come from products of sines: 10 places and 20 samples after each stand for all 200. For each partial
    stand (cos, -sin) of the places for its cosine and (sin, cos) for its sine; then cos and sin of the samples, counted
    from half a sample before the segment, as far as the past's last sample is from there. All are sines: a cosine is one
    that is a quarter turn ahead, and a sine below zero one that is half a turn ahead.
    """
    quarter, whole = 0.5 * math.pi, 2.0 * math.pi
    family = torch.eye(WAVE_VECTORS, dtype=torch.float64).repeat_interleave(HARMONICS, dim=1)
    orders = family * order.repeat(WAVE_VECTORS)
    nothing = torch.zeros_like(orders)
    place = whole / SAMPLE_RATE_HZ * torch.arange(0, strides * _STRIDE, _STRIDE, dtype=torch.float64)
    within = whole / SAMPLE_RATE_HZ * (torch.arange(_STRIDE, dtype=torch.float64) + 0.5)
    by_place = place.repeat_interleave(2).repeat(2)
    lead_of_place = torch.tensor([quarter, whole / 2.0] * strides + [0.0, quarter] * strides, dtype=torch.float64)
    by_sample = within.repeat(2)
    lead_of_sample = torch.tensor([quarter] * _STRIDE + [0.0] * _STRIDE, dtype=torch.float64)

    def spread(turns: Tensor) -> Tensor:
        return (orders.unsqueeze(2) * turns).reshape(WAVE_VECTORS, -1)

    before = -0.5 * whole / SAMPLE_RATE_HZ
    leads = [(quarter, quarter), (0.0, whole / 2.0), (quarter, whole / 2.0)]
    pair = torch.ones(2, dtype=torch.float64)
    by_size = [spread(by_place), spread(by_sample), *[spread(before * pair)] * 3]
    by_phase = [nothing.repeat(1, len(by_place)), nothing.repeat(1, len(by_sample)), *[spread(whole * pair)] * 3]
    by_phase += [nothing] * 4
    added = [lead_of_place.repeat(PARTIALS), lead_of_sample.repeat(PARTIALS)]
    added += [torch.tensor(lead, dtype=torch.float64).repeat(PARTIALS) for lead in leads]
    # Of the fundamental: from the lowest on, as long as the harmonic is below the highest.
    highest = _HIGHEST_HZ / order.repeat(WAVE_VECTORS)
    for lowest in (_LOWEST_IN_PAST_HZ, _LOWEST_HZ):
        centre, reach = 0.5 * (highest + lowest), 0.5 * (highest - lowest)
        by_size.append((family / reach).repeat_interleave(2, dim=1))
        added.append((-centre / reach).repeat_interleave(2))
    return torch.cat([torch.cat(by_size, dim=1), torch.cat(by_phase, dim=1)]), torch.cat(added)


def _thin_product(left: Tensor, right: Tensor) -> Tensor:
    """[B, P, K, 2] times [B, P, 2, M]. ONNX Runtime is quickest with matrices; PyTorch takes such small ones one by one."""
    if torch.onnx.is_in_onnx_export():
        return left @ right
    return left[..., 0:1] * right[..., 0:1, :] + left[..., 1:2] * right[..., 1:2, :]
