"""The rib comb: projects waveforms on the partials of ribs, relative to the place on the surface.

The rib phase, which the engine integrates from the travelled distance, gives the place of the tip on the surface's
profile, so that all harmonics keep their relative phases for as long as a stroke lasts.
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
# A family's harmonics, with cosine and sine of each side by side.
PAIRS = 2 * HARMONICS
# The past contains a partial if it contains nearly a period of the fundamental; the surface contains one whenever the
# tip moves.
_MINIMUM_IN_PAST_HZ, _MINIMUM_HZ, _MAXIMUM_HZ = 9.0, 0.5, 960.0
# Below this fundamental, the partials of one segment cannot be resolved.
_MINIMUM_RESOLVED_HZ = 5.0
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


class RibComb(nn.Module):
    """Projects segments on the partials of ribs.

    Partials are the harmonics of both wave vectors, one family after the other; each has a cosine and a sine. Written
    with matrices in place of loops over partials, and with shapes that need little copying, because every node of a
    graph costs time.
    """

    weight: Tensor
    bias: Tensor
    even: Tensor
    signs: Tensor
    swap: Tensor

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
        self.register_buffer("even", torch.full((1, 1, samples), 2.0 / samples), persistent=False)
        mirror = torch.tensor([1.0, -1.0]).repeat(HARMONICS)
        signs = torch.cat([mirror.repeat(WAVE_VECTORS), torch.ones(2 * PARTIALS)])
        self.register_buffer("signs", signs, persistent=False)
        self.register_buffer("swap", torch.arange(PAIRS).reshape(-1, 2).flip(1).flatten(), persistent=False)

    def ribs(self, phases: Tensor) -> Ribs:
        """The ribs for phases [B, 6] (models/label_embedding.py)."""
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
            *surface.reshape(-1, 3, WAVE_VECTORS, PAIRS).split(1, dim=1),
            *inside.reshape(-1, 2, WAVE_VECTORS, PAIRS).split(1, dim=1),
        )

    def profile(self, phases: Tensor, segments: Tensor) -> tuple[Tensor, Tensor]:
        """The partials of S segments [B, S, N] relative to the surface: [B, S, 2, 28], in phase with the rib phase
        and a quarter turn behind; and a mask [B, 28] of those that can be resolved."""
        ribs = self.ribs(phases)
        fundamental = phases[:, WAVE_VECTORS + 1 : 2 * WAVE_VECTORS + 1].abs().reshape(-1, 1, WAVE_VECTORS, 1)
        resolved = (fundamental > _MINIMUM_RESOLVED_HZ).to(phases.dtype) * ribs.sounding
        projected = segments * self.even @ ribs.waves.transpose(1, 2)
        amplitudes = projected.reshape(len(phases), -1, WAVE_VECTORS, PAIRS)
        # Turn back by the surface's phase, which negates the terms in `across`.
        seen = (amplitudes * ribs.ahead - self._swapped(amplitudes) * ribs.across) * resolved
        in_phase_and_behind = seen.reshape(len(phases), -1, PARTIALS, 2).transpose(2, 3)
        return in_phase_and_behind, resolved.reshape(len(phases), PARTIALS, 2)[:, :, 0]

    def _swapped(self, pairs: Tensor) -> Tensor:
        return torch.index_select(pairs, 3, self.swap)


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
