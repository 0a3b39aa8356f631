"""The rib comb of a velocity field: predicts the partials of ribs, from the previous waveform and from the place.

A network of local convolutions cannot carry a phase over 100 ms at any pitch. Projecting the past on the harmonics of
the known rib frequency can do so exactly. The weight of each is learnt: machined ribs follow the rib phase, woven threads
wander from it. The offset of wandering threads is found from the past: the profile is compared with it at every offset,
and the partials at the matching offsets are continued.
"""

from __future__ import annotations

import math

import torch
from torch import Tensor

from haptoflow_training.models.label_embedding import WAVE_VECTORS
from haptoflow_training.models.rib_comb import HARMONICS, PAIRS, PARTIALS, RibComb, Ribs

COMB_CHANNELS = 2 * WAVE_VECTORS + 1
# For each partial six gains: of the past's partial, continued; of the same at unit amplitude; of the surface's partial
# in phase with the rib phase and a quarter turn behind it; and the latter two of the wandering profile. For each wave
# vector two logarithms: how sharply the past determines the wandering offset, and how close to the rib phase it stays.
GAINS = 6 * PARTIALS + 2 * WAVE_VECTORS
# A sine that has all the power of unit scale has amplitude 1.4. A partial above this limit is not continued at its own
# amplitude, so that one whose gain is slightly above 1 cannot grow without bound in closed loop.
_MAXIMUM_AMPLITUDE = 1.5
# Partials of unit size in phase add up to pulses 14 times as high as one of them.
_PULSE_SCALE = 0.3
_SMALL = 1e-5
# Offsets at which the wandering profile is compared with the past; initial values of how sharply a partial of size 1
# determines the offset, and of how close to the rib phase it stays (as the concentration of a von Mises distribution).
_OFFSETS = 64
_SHARPNESS, _NEARNESS = 8.0, 2.0
_MAXIMUM_LOGARITHM = 3.0


def spread_gains() -> Tensor:
    """Indices [228] into the 172 gains of a `RibComb`, in the order in which it reads them. Each gain of the past is
    repeated for the partial's cosine and sine; the two gains of a profile's partial are placed side by side. A
    network applies the indices to the weights of the layer that makes its gains, so that an exported graph contains
    the result as a constant."""
    past, profiles, families = torch.arange(GAINS).split([2 * PARTIALS, 4 * PARTIALS, 2 * WAVE_VECTORS])
    pairs = profiles.reshape(2, 2, PARTIALS).transpose(1, 2)
    return torch.cat([past.repeat_interleave(2), pairs.flatten(), families])


class ContinuingComb(RibComb):
    """Predicts the rib partials of a segment from the past and the rib phase."""

    newest: Tensor
    mirror: Tensor
    pairs: Tensor
    families: Tensor
    overlaps: Tensor
    turned_by: Tensor
    nearness: Tensor

    def __init__(self, samples: int = 200) -> None:
        super().__init__(samples)
        order = torch.arange(1, HARMONICS + 1, dtype=torch.float64)
        # Newer samples weigh more: when a hand speeds up, the older ones have another pitch.
        newest_first = torch.linspace(1.0, 0.05, samples)
        self.register_buffer("newest", (2.0 * newest_first / newest_first.sum()).reshape(1, 1, -1), persistent=False)
        mirror = torch.tensor([1.0, -1.0]).repeat(HARMONICS)
        self.register_buffer("mirror", mirror.reshape(1, 1, 1, PAIRS), persistent=False)
        family = torch.eye(WAVE_VECTORS)
        rows = torch.cat([family, _PULSE_SCALE * family, torch.ones(1, WAVE_VECTORS)]).unsqueeze(2)
        self.register_buffer("families", rows.repeat(1, 1, PAIRS).unsqueeze(0), persistent=False)
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

    def partials(self, ribs: Ribs, mirrored: Tensor, gains: Tensor) -> tuple[Tensor, Tensor]:
        """Cosine and sine of every partial, [B, 1, 2, 28] each: of the continued past, and of the whole prediction
        before `sounding` masks partials that the surface does not have. gains [B, 228]: see `spread_gains`."""
        projected = mirrored * self.newest @ ribs.waves.transpose(1, 2)
        carried = projected.reshape(-1, 1, WAVE_VECTORS, PAIRS) * ribs.past_sign
        by_partial, by_family = gains.split([8 * PARTIALS, 2 * WAVE_VECTORS], dim=1)
        kept, held, profiles = by_partial.reshape(-1, 4, WAVE_VECTORS, PAIRS).split([1, 1, 2], dim=1)
        # A matrix sums the squares of each pair without reshaping. The small constant keeps the root's gradient finite
        # at zero.
        size = torch.sqrt((carried * carried) @ self.pairs + _SMALL**2)
        from_past = carried * ((kept * size.clamp(max=_MAXIMUM_AMPLITUDE) + held) / size)

        # For a partial p cos(P + a) + q sin(P + a): cosine p cos P + q sin P, sine q cos P - p sin P.
        turned = profiles * ribs.ahead + self._swapped(profiles) * ribs.across
        still, wandering = turned.split(1, dim=1)
        ahead, across = self._wandered(still + wandering, carried, by_family)
        return carried, from_past + (still + (wandering * ahead + self._swapped(wandering) * across))

    def _wandered(self, profile: Tensor, carried: Tensor, by_family: Tensor) -> tuple[Tensor, Tensor]:
        """The rotation of the profile's partials [B, 1, 2, 28] that continues them from where they match the past:
        the mean over offsets, each weighted by its overlap with the continued past and its closeness to the rib
        phase; as (cosine, cosine) and (sine, -sine), [B, 1, 2, 28] each. by_family [B, 4]: logarithms of the two
        weights' sharpness."""
        weights = by_family.clamp(-_MAXIMUM_LOGARITHM, _MAXIMUM_LOGARITHM).exp()
        sharp, near = weights.reshape(-1, 2, WAVE_VECTORS, 1).split(1, dim=1)
        overlap = torch.cat([carried * profile, carried * self._swapped(profile)], dim=3) @ self.overlaps
        likely = torch.softmax(sharp * overlap + near * self.nearness, dim=3)
        ahead, across = (likely @ self.turned_by).split(PAIRS, dim=3)
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
