"""Spectral energy distance: trains a network to produce a whole segment in one evaluation.

Gritsenko et al. 2020 (A spectral energy distance for parallel speech synthesis), equation 4: with x a recorded and y1,
y2 two independently generated segments of the same condition, loss = (D(x, y1) + D(x, y2)) / 2 - D(y1, y2) / 2. The
last term rewards variety, so the conditional mean, which one Euler step of a plain flow returns, is not a minimum. D
compares magnitudes of short spectra of [past, segment], so that the seam counts too, and the samples themselves near
the seam. It also compares envelopes, because a spectrum does not show whether a segment's power is even or comes in
impacts, which a hand feels.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import TypeVar

import torch
from torch import Tensor

from haptoflow_training.models.rib_comb import PARTIALS
from haptoflow_training.waveform import SAMPLE_RATE_HZ

# The longest window spans past and segment: it resolves 5 Hz, and smears the lines of a ruled surface if the segment
# does not continue the phase of the past.
WINDOW_SAMPLES = (16, 32, 64, 128, 200, 400)
_SHORT_PAST_SAMPLES = 64
_SEAM_SAMPLES = 64
_POWER_FLOOR = 1e-5
_LINE_WEIGHT = 2.0

# Lengths of an envelope's frames, and constants that keep the logarithm and the root of silence smooth.
_ENVELOPE_SAMPLES = (4, 10, 20)
_LOG_FLOOR, _ROOT_FLOOR = 1e-3, 1e-6
# The modulation of past and segment: frames of 4 ms at 500 Hz, modulation frequencies 15 to 195 Hz in steps of 5.
_MODULATION_SAMPLES, _MODULATION_HOP = 8, 4
_MODULATION_HZ = (15.0, 195.0, 5.0)
_MODULATION_WEIGHT = 2.0

T = TypeVar("T")


@lru_cache(maxsize=None)
def _basis(window: int) -> Tensor:
    """[window, 2 * bins]: Hann-windowed cosines and sines; white noise of power 1 has mean power 1 in every bin."""
    samples = torch.arange(window, dtype=torch.float64)
    bins = torch.arange(window // 2 + 1, dtype=torch.float64)
    return _windowed_waves(2.0 * math.pi * samples[:, None] * bins[None, :] / window)


def _windowed_waves(angle: Tensor) -> Tensor:
    """[N, 2 * bins]: cosines and sines of the angles [N, bins] in a Hann window of power 1."""
    samples = torch.arange(len(angle), dtype=torch.float64)
    hann = 0.5 - 0.5 * torch.cos(2.0 * math.pi * samples / len(angle))
    hann = hann / hann.square().sum().sqrt()
    return torch.cat([hann[:, None] * angle.cos(), hann[:, None] * angle.sin()], dim=1).float()


def powers_by_bin(wave: Tensor, window: int) -> Tensor:
    """[B, N] to [B, frames, window / 2 + 1] powers; hop max(4, window / 4)."""
    frames = wave.unfold(1, window, max(4, window // 4))
    # One matrix product for the whole batch; for a stack of matrices, PyTorch would compute one for each row.
    rows = frames.reshape(-1, window) @ _basis(window)
    real, imaginary = rows.reshape(*frames.shape[:2], -1).chunk(2, dim=2)
    return real.square() + imaginary.square()


@dataclass(frozen=True)
class Spectra:
    """By window (WINDOW_SAMPLES): magnitudes and their logarithms, [B, frames, bins] each."""

    magnitudes: list[Tensor]
    logarithms: list[Tensor]


def halves_of(spectra: Spectra) -> tuple[Spectra, Spectra]:
    """The spectra of the first and of the second half of the batch."""
    first, second = (
        [[part.chunk(2)[half] for part in parts] for parts in (spectra.magnitudes, spectra.logarithms)]
        for half in range(2)
    )
    return Spectra(*first), Spectra(*second)


def spectral_distance(first: Spectra, second: Spectra) -> Tensor:
    """[B]: mean over windows of the mean magnitude difference plus the RMS over bins of the log magnitudes'
    difference."""
    total = torch.zeros(first.magnitudes[0].shape[0])
    for one, other in zip(first.magnitudes, second.magnitudes, strict=True):
        total = total + (one - other).abs().mean(dim=(1, 2))
    for one, other in zip(first.logarithms, second.logarithms, strict=True):
        total = total + ((one - other).square().mean(dim=2) + 1e-8).sqrt().mean(dim=1)
    return total / len(first.magnitudes)


def sample_distance(first: Tensor, second: Tensor) -> Tensor:
    """[B]: RMS of the difference near the seam plus half that of the whole segment; [B, 200] each."""
    difference = (first - second).square()
    near = (difference[:, :_SEAM_SAMPLES].mean(dim=1) + 1e-8).sqrt()
    return near + 0.5 * (difference.mean(dim=1) + 1e-8).sqrt()


def line_distance(first: Tensor, second: Tensor) -> Tensor:
    """[B]: RMS of the difference between the waveforms that the partials first and second [B, 2, P] describe."""
    return (0.5 * (first - second).square().sum(dim=(1, 2)) + 1e-8).sqrt()


@lru_cache(maxsize=None)
def _modulation_basis(frames: int) -> Tensor:
    """[frames, 2 * bins]: Hann-windowed cosines and sines of the modulation's frequencies."""
    samples = torch.arange(frames, dtype=torch.float64)
    low, high, step = _MODULATION_HZ
    frequency = torch.arange(low, high + 0.5 * step, step, dtype=torch.float64)
    return _windowed_waves(2.0 * math.pi * samples[:, None] * frequency[None, :] * (_MODULATION_HOP / SAMPLE_RATE_HZ))


def envelopes(past: Tensor, segment: Tensor) -> list[Tensor]:
    """Features of waveforms [B, 200] in time: for each frame length the logarithm and the root of the frames' power,
    in time order and sorted; the sorted magnitudes of the samples; the modulation of past and segment by frequency."""
    found = []
    for samples in _ENVELOPE_SAMPLES:
        power = segment.square().reshape(len(segment), -1, samples).mean(dim=2)
        for values in (power, power.sort(dim=1).values):
            found += [0.5 * (values + _LOG_FLOOR).log(), (values + _ROOT_FLOOR).sqrt()]
    found.append(segment.abs().sort(dim=1).values)
    frames = torch.cat([past, segment], dim=1).square().unfold(1, _MODULATION_SAMPLES, _MODULATION_HOP).mean(dim=2)
    real, imaginary = ((frames + _ROOT_FLOOR).sqrt() @ _modulation_basis(frames.shape[1])).chunk(2, dim=1)
    found.append((real.square() + imaginary.square() + 1e-8).sqrt())
    return found


def envelope_distance(first: list[Tensor], second: list[Tensor]) -> Tensor:
    """[B]: RMS differences of the features of `envelopes`; the frame lengths count as one feature."""
    *framed, sizes, modulation = [
        ((one - other).square().mean(dim=1) + 1e-8).sqrt() for one, other in zip(first, second, strict=True)
    ]
    return torch.stack(framed).sum(dim=0) / len(_ENVELOPE_SAMPLES) + sizes + _MODULATION_WEIGHT * modulation


def energy_score(recorded: T, drawn: tuple[T, T], distance: Callable[[T, T], Tensor]) -> Tensor:
    """[B]: the distance of two draws from the recording, less half of their distance from each other."""
    first, second = drawn
    attraction = 0.5 * (distance(recorded, first) + distance(recorded, second))
    return attraction - 0.5 * distance(first, second)


def spectra(past: Tensor, segment: Tensor) -> Spectra:
    """Spectra of past and segment [B, 200] by window; the shorter windows start from the past's last samples."""
    whole = torch.cat([past, segment], dim=1)
    near = whole[:, past.shape[1] - _SHORT_PAST_SAMPLES :]
    powers = [powers_by_bin(near if window <= near.shape[1] else whole, window) for window in WINDOW_SAMPLES]
    return Spectra(
        [(power + 1e-8).sqrt() for power in powers], [0.5 * (power + _POWER_FLOOR).log() for power in powers]
    )


def energy_distance_loss(
    recorded: Spectra,
    drawn: tuple[Spectra, Spectra],
    weight: Tensor,
    *,
    waves: tuple[Tensor, ...] | None,
    lines: tuple[Tensor, ...],
    envelopes: tuple[list[Tensor], list[Tensor], list[Tensor]],
) -> Tensor:
    """The loss of a batch, from the spectra of the recording and of two draws, each with its past; weight [B].

    waves: recorded segment and draws [B, 200] if all follow the same past; None if the draws follow the network's own
    output, because then only spectra can agree. lines: the partials [B, 2, P] of recorded segment and draws relative to
    the rib phase, zero for surfaces without ribs; short spectra hardly show whether a line keeps its phase. envelopes:
    of recorded segment and draws, each with its past.
    """
    loss = energy_score(recorded, drawn, spectral_distance)
    if waves is not None:
        loss = loss + energy_score(waves[0], (waves[1], waves[2]), sample_distance)
    loss = loss + _LINE_WEIGHT * energy_score(lines[0], (lines[1], lines[2]), line_distance)
    loss = loss + energy_score(envelopes[0], (envelopes[1], envelopes[2]), envelope_distance)
    return (weight * loss).sum() / weight.sum()


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
    """values and counted [B, K]: magnitudes by frequency, amplitudes of partials, noise between a ruled surface's lines
    by band, moments, and moments of what drives a filter; counted is 0 where a feature does not apply to the
    segment."""

    values: Tensor
    counted: Tensor


# Orders of the moments of the samples' magnitudes and of the frames' RMS. The fourth would need thousands of segments.
_MOMENTS = (1.0, 3.0)
_FRAME_SAMPLES = 10
# Magnitudes are limited to this multiple of the level, so that a single stronger impact does not dominate the average
# for long.
_MAXIMUM_SIZE = 16.0
_KINDS = (_BINS, PARTIALS, _BANDS, 2 * len(_MOMENTS), 2 * len(_MOMENTS))
FEATURES = sum(_KINDS)
# All kinds of features weigh the same.
_SHARES = torch.cat([torch.full((count,), 1.0 / count) for count in _KINDS])


def _moments(segment: Tensor) -> list[Tensor]:
    """[B] each, of a segment [B, 200] in unit scale."""
    sizes = segment.abs().clamp(max=_MAXIMUM_SIZE)
    frames = (sizes.square().reshape(len(sizes), -1, _FRAME_SAMPLES).mean(dim=2) + 1e-8).sqrt()
    return [values.pow(order).mean(dim=1) for values in (sizes, frames) for order in _MOMENTS]


def label_features(
    spectra: Spectra,
    ribs_hz: Tensor,
    partials: Tensor,
    audible: Tensor,
    segment: Tensor,
    driving: Tensor | None = None,
) -> LabelFeatures:
    """Features of segments [B, 200] with their pasts, and of what drives a filter in them, [B, N], if one does.
    spectra: by window (energy_distance.spectra); ribs_hz [B, 2]: the frequency of each family of ribs; partials [B, 2,
    28] of the segment; audible [B, 28]: mask of partials inside the band."""
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
    driven = torch.stack(_moments(segment if driving is None else driving), dim=1)
    return LabelFeatures(
        torch.cat([bins, amplitudes, noise, moments, driven], dim=1),
        torch.cat(
            [
                torch.ones_like(bins), audible, ruled, torch.ones_like(moments),
                torch.full_like(driven, 0.0 if driving is None else 1.0),
            ],
            dim=1,
        ),  # fmt: skip
    )


class LabelBalance:
    """A loss on mean spectra and moments of each label, for small errors that all segments share: running averages of
    features by label and speed class, and the loss of a batch against them. Not part of the model.

    The energy distance compares single segments, whose spectra scatter by several decibels. A resonance that is 1 dB
    too low in all segments of a label hardly shows in it, but dominates the error of the spectrum averaged over a
    minute. Here magnitudes are averaged over some hundred segments of the same label and speed, recorded and drawn, and
    the loss is half the squared difference of the averages' logarithms. The averages are running ones; the gradient of
    a batch is that of its own share in them. Moments of the samples and of 5 ms frames are compared in the same way:
    how rare and how strong a material's impacts are shows only over hundreds of segments.
    """

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

        The averages of earlier batches judge this one, and only then hold it. If they held it first, a batch that drew a
        rare impulse would raise the average and be pulled down for it, and one without would find the average too low
        but have no impulse to strengthen. Rare impulses would become weaker than recorded.
        """
        speed_class = torch.bucketize(speed_mps, torch.tensor(_SPEED_BORDERS_MPS))
        group = label * _SPEED_CLASSES + speed_class
        values = 0.5 * (drawn[0].values + drawn[1].values)
        counted = weight.unsqueeze(1) * recorded.counted
        error, mean = self._errors()
        self._remember(group, counted, recorded.values, values.detach())
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
