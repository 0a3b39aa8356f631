"""The rib comb: predicts the partials of ribs, from the previous waveform and from the place on the surface.

A network of local convolutions cannot carry a phase over 100 ms at any pitch. Projecting the past on the harmonics of
the known rib frequency can do so exactly. The rib phase, which the engine integrates from the travelled distance, gives
the place of the tip on the surface's profile, so that all harmonics keep their relative phases for as long as a stroke
lasts. The weight of each is learnt: machined ribs follow the rib phase, woven threads wander from it. The offset of
wandering threads is found from the past: the profile is compared with it at every offset, and the partials at the
matching offsets are continued.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import torch
from torch import Tensor, nn

from haptoflow_training.models.label_embedding import WAVE_VECTORS
from haptoflow_training.waveform import SAMPLE_RATE_HZ

# At very low speeds a pulse train has its power far above the fundamental.
HARMONICS = 14
PARTIALS = WAVE_VECTORS * HARMONICS
COMB_CHANNELS = 2 * WAVE_VECTORS + 1
# For each partial six gains: of the past's partial, continued; of the same at unit amplitude; of the surface's partial
# in phase with the rib phase and a quarter turn behind it; and the latter two of the wandering profile. For each wave
# vector two logarithms: how sharply the past determines the wandering offset, and how close to the rib phase it stays.
GAINS = 6 * PARTIALS + 2 * WAVE_VECTORS
# A family's harmonics, with cosine and sine of each side by side.
_PAIRS = 2 * HARMONICS
# A sine that has all the power of unit scale has amplitude 1.4. A partial above this limit is not continued at its own
# amplitude, so that one whose gain is slightly above 1 cannot grow without bound in closed loop.
_MAXIMUM_AMPLITUDE = 1.5
# The past contains a partial if it contains nearly a period of the fundamental; the surface contains one whenever the
# tip moves.
_MINIMUM_IN_PAST_HZ, _MINIMUM_HZ, _MAXIMUM_HZ = 9.0, 0.5, 960.0
# Below this fundamental, the partials of one segment cannot be resolved.
_MINIMUM_RESOLVED_HZ = 5.0
# Partials of unit size in phase add up to pulses 14 times as high as one of them.
_PULSE_SCALE = 0.3
_SMALL = 1e-5
# Offsets at which the wandering profile is compared with the past; initial values of how sharply a partial of size 1
# determines the offset, and of how close to the rib phase it stays (as the concentration of a von Mises distribution).
_OFFSETS = 64
_SHARPNESS, _NEARNESS = 8.0, 2.0
_MAXIMUM_LOGARITHM = 3.0
# Sines are computed at every 20th sample, and at the 20 samples after such a place.
_STRIDE = 20


class Ribs(NamedTuple):
    """The ribs at one motion and place. waves [B, 56, N]: cosine and sine of each partial, with time 0 between past
    and segment. The others are [B, 1, 2, 28]: a family for each wave vector, and two values for each of its
    harmonics. ahead, across and pulses, with P the phase of the surface at time 0: (cos P, cos P), (sin P, -sin P)
    and (cos P, -sin P). past_sign: (1, -1) where the past can contain a partial, 0 elsewhere; time runs backwards in
    the mirrored past, which keeps cosines and negates sines. sounding: 1 where the surface has a partial."""

    waves: Tensor
    ahead: Tensor
    across: Tensor
    pulses: Tensor
    past_sign: Tensor
    sounding: Tensor


def spread_gains() -> Tensor:
    """Indices [228] into the 172 gains of a `RibComb`, in the order in which it reads them. Each gain of the past is
    repeated for the partial's cosine and sine; the two gains of a profile's partial are placed side by side. A
    network applies the indices to the weights of the layer that makes its gains, so that an exported graph contains
    the result as a constant."""
    past, profiles, families = torch.arange(GAINS).split([2 * PARTIALS, 4 * PARTIALS, 2 * WAVE_VECTORS])
    pairs = profiles.reshape(2, 2, PARTIALS).transpose(1, 2)
    return torch.cat([past.repeat_interleave(2), pairs.flatten(), families])


class RibComb(nn.Module):
    """Predicts the rib partials of a segment from the past and the rib phase.

    Partials are the harmonics of both wave vectors, one family after the other; each has a cosine and a sine. Written
    with matrices in place of loops over partials, and with shapes that need little copying, because every node of a
    graph costs time.
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
        # Two for each place, twice; two for each sample after a place; six for the surface.
        self.sines = PARTIALS * (4 * self.strides + 2 * _STRIDE + 6)
        order = torch.arange(1, HARMONICS + 1, dtype=torch.float64)
        weight, bias = _angles_and_limits(order, self.strides)
        self.register_buffer("weight", weight.float(), persistent=False)
        self.register_buffer("bias", bias.float(), persistent=False)
        # Newer samples weigh more: when a hand speeds up, the older ones have another pitch.
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
        # Sums cosine and sine of a partial, and writes the sum to both.
        pairs = torch.eye(HARMONICS).repeat_interleave(2, dim=0).repeat_interleave(2, dim=1)
        self.register_buffer("pairs", pairs, persistent=False)

        offsets = 2.0 * math.pi * torch.arange(_OFFSETS, dtype=torch.float64) / _OFFSETS
        turned = order.unsqueeze(1) * offsets
        # With z = cosine - i sine: the past times the conjugate of the profile, turned back. Equal parts multiply
        # cosines, unequal parts sines.
        both = [torch.stack(pair, dim=1) for pair in ((turned.cos(), turned.cos()), (turned.sin(), -turned.sin()))]
        turns = torch.cat([each.reshape(-1, _OFFSETS) for each in both])
        self.register_buffer("overlaps", (_SHARPNESS * turns).float(), persistent=False)
        self.register_buffer("turned_by", turns.t().float().contiguous(), persistent=False)
        nearness = (_NEARNESS * offsets.cos()).float().reshape(1, 1, 1, -1)
        self.register_buffer("nearness", nearness, persistent=False)

    def ribs(self, phases: Tensor) -> Ribs:
        """The ribs for phases [B, 6] (models/surface_waves.py)."""
        rib_phase, signed = phases[:, :WAVE_VECTORS], phases[:, WAVE_VECTORS + 1 : 2 * WAVE_VECTORS + 1]
        # Count the phase in the direction of motion.
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

    def profile(self, phases: Tensor, segments: Tensor) -> tuple[Tensor, Tensor]:
        """The partials of S segments [B, S, N] relative to the surface: [B, S, 2, 28], in phase with the rib phase
        and a quarter turn behind; and a mask [B, 28] of those that can be resolved."""
        ribs = self.ribs(phases)
        fundamental = phases[:, WAVE_VECTORS + 1 : 2 * WAVE_VECTORS + 1].abs().reshape(-1, 1, WAVE_VECTORS, 1)
        resolved = (fundamental > _MINIMUM_RESOLVED_HZ).to(phases.dtype) * ribs.sounding
        projected = segments * self.even @ ribs.waves.transpose(1, 2)
        amplitudes = projected.reshape(len(phases), -1, WAVE_VECTORS, _PAIRS)
        # Turn back by the surface's phase, which negates the terms in `across`.
        seen = (amplitudes * ribs.ahead - self._swapped(amplitudes) * ribs.across) * resolved
        in_phase_and_behind = seen.reshape(len(phases), -1, PARTIALS, 2).transpose(2, 3)
        return in_phase_and_behind, resolved.reshape(len(phases), PARTIALS, 2)[:, :, 0]

    def partials(self, ribs: Ribs, mirrored: Tensor, gains: Tensor) -> tuple[Tensor, Tensor]:
        """Cosine and sine of every partial, [B, 1, 2, 28] each: of the continued past, and of the whole prediction
        before `sounding` masks partials that the surface does not have. gains [B, 228]: see `spread_gains`."""
        projected = mirrored * self.newest @ ribs.waves.transpose(1, 2)
        carried = projected.reshape(-1, 1, WAVE_VECTORS, _PAIRS) * ribs.past_sign
        by_partial, by_family = gains.split([8 * PARTIALS, 2 * WAVE_VECTORS], dim=1)
        kept, held, profiles = by_partial.reshape(-1, 4, WAVE_VECTORS, _PAIRS).split([1, 1, 2], dim=1)
        # A matrix sums the squares of each pair without reshaping. The small constant keeps the root's gradient finite
        # at zero.
        size = torch.sqrt((carried * carried) @ self.pairs + _SMALL**2)
        from_past = carried * ((kept * size.clamp(max=_MAXIMUM_AMPLITUDE) + held) / size)

        # For a partial p cos(P + a) + q sin(P + a): cosine p cos P + q sin P, sine q cos P - p sin P.
        turned = profiles * ribs.ahead + self._swapped(profiles) * ribs.across
        still, wandering = turned.split(1, dim=1)
        ahead, across = self._wandered(still + wandering, carried, by_family)
        return carried, from_past + (still + (wandering * ahead + self._swapped(wandering) * across))

    def _swapped(self, pairs: Tensor) -> Tensor:
        return torch.index_select(pairs, 3, self.swap)

    def _wandered(self, profile: Tensor, carried: Tensor, by_family: Tensor) -> tuple[Tensor, Tensor]:
        """The rotation of the profile's partials [B, 1, 2, 28] that continues them from where they match the past:
        the mean over offsets, each weighted by its overlap with the continued past and its closeness to the rib
        phase; as (cosine, cosine) and (sine, -sine), [B, 1, 2, 28] each. by_family [B, 4]: logarithms of the two
        weights' sharpness."""
        weights = by_family.clamp(-_MAXIMUM_LOGARITHM, _MAXIMUM_LOGARITHM).exp()
        sharp, near = weights.reshape(-1, 2, WAVE_VECTORS, 1).split(1, dim=1)
        overlap = torch.cat([carried * profile, carried * self._swapped(profile)], dim=3) @ self.overlaps
        likely = torch.softmax(sharp * overlap + near * self.nearness, dim=3)
        ahead, across = (likely @ self.turned_by).split(_PAIRS, dim=3)
        return ahead, across

    def forward(self, mirrored: Tensor, phases: Tensor, gains: Tensor) -> Tensor:
        """[B, 5, N]: four channels and the lines, from the mirrored past [B, 1, N], phases [B, 6] and gains [B, 228].

        Channels: for each wave vector the continued past, then pulses, one for each rib that passes. Lines: the
        weighted sum of all partials: the continued past (limited to unit power), the same at unit amplitude, the
        surface's partials in phase and a quarter turn behind, and those of the wandering profile, with gains in that
        order as `spread_gains` arranges them.
        """
        ribs = self.ribs(phases)
        carried, lines = self.partials(ribs, mirrored, gains)
        channels = torch.cat([carried, carried, ribs.pulses, ribs.pulses, lines], dim=1)
        rows = channels * self.families * ribs.sounding
        return rows.reshape(-1, COMB_CHANNELS, 2 * PARTIALS) @ ribs.waves


def _angles_and_limits(order: Tensor, strides: int) -> tuple[Tensor, Tensor]:
    """Factors and offsets that turn size and phase of both fundamentals, [B, 4], into the angles whose sines are the
    waves and the surface's phases, and into two limits for each partial. The first limit lies between -1 and 1 where
    the past can contain the partial, the second where the surface has it; each occurs twice, for cosine and sine.

    Sines of sums are products of sines: 10 places and the 20 samples after each cover all 200. For each partial there
    are (cos, -sin) of the places for its cosine and (sin, cos) for its sine; then cos and sin of the samples, counted
    from half a sample before the segment. All are computed as sines: a cosine is a sine a quarter turn ahead, a negated
    sine is one half a turn ahead.
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
    # Limits of the fundamental: from the lowest frequency up to where the harmonic reaches the highest.
    highest = _MAXIMUM_HZ / order.repeat(WAVE_VECTORS)
    for lowest in (_MINIMUM_IN_PAST_HZ, _MINIMUM_HZ):
        centre, reach = 0.5 * (highest + lowest), 0.5 * (highest - lowest)
        by_size.append((family / reach).repeat_interleave(2, dim=1))
        added.append((-centre / reach).repeat_interleave(2))
    return torch.cat([torch.cat(by_size, dim=1), torch.cat(by_phase, dim=1)]), torch.cat(added)


def _thin_product(left: Tensor, right: Tensor) -> Tensor:
    """[B, P, K, 2] times [B, P, 2, M]. Matrix products are fastest in ONNX Runtime; PyTorch computes such small ones
    one by one."""
    if torch.onnx.is_in_onnx_export():
        return left @ right
    return left[..., 0:1] * right[..., 0:1, :] + left[..., 1:2] * right[..., 1:2, :]
