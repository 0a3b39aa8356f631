"""A loss on mean spectra and moments of each label, for small errors that all segments share.

The energy distance (energy_distance.py) compares single segments, whose spectra scatter by several decibels. A
resonance that is 1 dB too low in all segments of a label hardly shows in it, but dominates the error of the spectrum
averaged over a minute. Here magnitudes are averaged over some hundred segments of the same label and speed, recorded
and drawn, and the loss is half the squared difference of the averages' logarithms. The averages are running ones; the
gradient of a batch is that of its own share in them. Moments of the samples and of 5 ms frames are compared in the same
way: how rare and how strong a material's impacts are shows only over hundreds of segments.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import torch
from torch import Tensor

from haptoflow_training.models.rib_comb import PARTIALS
from haptoflow_training.training.energy_distance import WINDOW_SAMPLES, Spectra

# Borders between speed classes: a contact resonance rises with speed.
_SPEED_BORDERS_MPS = (0.03, 0.08, 0.2, 0.5)
_SPEED_CLASSES = len(_SPEED_BORDERS_MPS) + 1
# How many segments of one label and speed class an average remembers, and the number below which it is not used.
_MEMORY_SEGMENTS, _MINIMUM_SEGMENTS = 80.0, 16.0
_MAXIMUM_ERROR = 1.0
_FLOOR = 1e-3
_BINS = 101
_BANDS = 8
# A Hann window of 400 samples resolves lines that are this far apart.
_MINIMUM_LINE_SPACING_HZ = 40.0
_LONG_BINS_HZ = torch.arange(201) * 5.0


@dataclass(frozen=True)
class LabelFeatures:
    """values and counted [B, K]: magnitudes by frequency, amplitudes of partials, noise between a ruled surface's
    lines by band, and moments; counted is 0 where a feature does not apply to the segment."""

    values: Tensor
    counted: Tensor


# Orders of the moments of the samples' magnitudes and of the frames' RMS. The fourth would need thousands of segments.
_MOMENTS = (1.0, 3.0)
_FRAME_SAMPLES = 10
# Magnitudes are limited to this multiple of the level, so that a single stronger impact does not dominate the average
# for long.
_MAXIMUM_SIZE = 16.0
_KINDS = (_BINS, PARTIALS, _BANDS, 2 * len(_MOMENTS))
FEATURES = sum(_KINDS)
# All kinds of features weigh the same.
_SHARES = torch.cat([torch.full((count,), 1.0 / count) for count in _KINDS])


def _moments(segment: Tensor) -> list[Tensor]:
    """[B] each, of a segment [B, 200] in unit scale."""
    sizes = segment.abs().clamp(max=_MAXIMUM_SIZE)
    frames = (sizes.square().reshape(len(sizes), -1, _FRAME_SAMPLES).mean(dim=2) + 1e-8).sqrt()
    return [values.pow(order).mean(dim=1) for values in (sizes, frames) for order in _MOMENTS]


def label_features(
    spectra: Spectra, ribs_hz: Tensor, partials: Tensor, audible: Tensor, segment: Tensor
) -> LabelFeatures:
    """Features of segments [B, 200] with their pasts. spectra: by window (energy_distance.spectra); ribs_hz [B, 2]:
    the frequency of each family of ribs; partials [B, 2, 28] of the segment; audible [B, 28]: mask of partials
    inside the band."""
    # Of windows as long as a segment, the first contains only the past.
    magnitudes = spectra.magnitudes
    short, long = magnitudes[WINDOW_SAMPLES.index(200)][:, 1:], magnitudes[WINDOW_SAMPLES.index(400)][:, 0, 1:]
    bins = short.mean(dim=1)
    amplitudes = (partials.square().sum(dim=1) + 1e-8).sqrt()
    # For lines at multiples of a spacing, sin^4(pi f / spacing) keeps what lies between them.
    resolved = ribs_hz > _MINIMUM_LINE_SPACING_HZ
    spacing = torch.where(resolved, ribs_hz, torch.ones_like(ribs_hz)).unsqueeze(2)
    between = torch.sin(math.pi * _LONG_BINS_HZ / spacing).pow(4)
    between = torch.where(resolved.unsqueeze(2), between, torch.ones_like(between)).prod(dim=1)[:, 1:]
    noise = (between * long).reshape(-1, _BANDS, 25).sum(dim=2)
    noise = noise / between.reshape(-1, _BANDS, 25).sum(dim=2).clamp(min=1.0)
    ruled = resolved.any(dim=1, keepdim=True).to(bins.dtype).expand(-1, _BANDS)
    moments = torch.stack(_moments(segment), dim=1)
    return LabelFeatures(
        torch.cat([bins, amplitudes, noise, moments], dim=1),
        torch.cat([torch.ones_like(bins), audible, ruled, torch.ones_like(moments)], dim=1),
    )


class LabelBalance:
    """Running averages of features by label and speed class, and the loss of a batch against them. Not part of the
    model."""

    def __init__(self, labels: int) -> None:
        groups = labels * _SPEED_CLASSES
        self._sums = {name: torch.zeros(groups, FEATURES) for name in ("recorded", "drawn", "count")}

    def state(self) -> dict[str, Tensor]:
        """The state that a resumed run continues from."""
        return self._sums

    def restore(self, state: dict[str, Tensor]) -> None:
        """Restore a saved state."""
        self._sums = state

    def loss(
        self,
        label: Tensor,
        speed_mps: Tensor,
        recorded: LabelFeatures,
        drawn: tuple[LabelFeatures, LabelFeatures],
        weight: Tensor,
    ) -> Tensor:
        """The loss of a batch; label [B], speed [B], weight [B] of the segments, as in the energy distance.

        The averages are updated with the batch before they are compared.
        """
        speed_class = torch.bucketize(speed_mps, torch.tensor(_SPEED_BORDERS_MPS))
        group = label * _SPEED_CLASSES + speed_class
        values = 0.5 * (drawn[0].values + drawn[1].values)
        counted = weight.unsqueeze(1) * recorded.counted
        self._remember(group, counted, recorded.values, values.detach())
        error, mean = self._errors()
        share = (counted / weight.sum()) * _SHARES
        # d/dvalue of (log mean drawn - log mean recorded)^2 / 2, with the batch's share in the mean as weight.
        slope = (error / mean)[group]
        pull = (share * slope * values).sum()
        stated = 0.5 * (share * error[group].square()).sum()
        return pull - pull.detach() + stated

    def _remember(self, group: Tensor, counted: Tensor, recorded: Tensor, drawn: Tensor) -> None:
        arrived = torch.zeros_like(self._sums["count"]).index_add_(0, group, counted)
        kept = torch.exp(-arrived / _MEMORY_SEGMENTS)
        new = {"recorded": counted * recorded, "drawn": counted * drawn, "count": counted}
        for name, sums in self._sums.items():
            sums.mul_(kept).index_add_(0, group, new[name])

    def _errors(self) -> tuple[Tensor, Tensor]:
        """(log ratio of drawn to recorded average, 0 where there are too few segments; average drawn), [groups, K]."""
        count = self._sums["count"].clamp(min=1e-6)
        recorded, drawn = (self._sums[name] / count + _FLOOR for name in ("recorded", "drawn"))
        error = (drawn / recorded).log().clamp(-_MAXIMUM_ERROR, _MAXIMUM_ERROR)
        return torch.where(self._sums["count"] >= _MINIMUM_SEGMENTS, error, torch.zeros_like(error)), drawn
