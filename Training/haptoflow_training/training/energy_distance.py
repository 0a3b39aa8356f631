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
    hann = 0.5 - 0.5 * torch.cos(2.0 * math.pi * samples / window)
    hann = hann / hann.square().sum().sqrt()
    bins = torch.arange(window // 2 + 1, dtype=torch.float64)
    angle = 2.0 * math.pi * samples[:, None] * bins[None, :] / window
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
    hann = 0.5 - 0.5 * torch.cos(2.0 * math.pi * samples / frames)
    hann = hann / hann.square().sum().sqrt()
    low, high, step = _MODULATION_HZ
    frequency = torch.arange(low, high + 0.5 * step, step, dtype=torch.float64)
    angle = 2.0 * math.pi * samples[:, None] * frequency[None, :] * (_MODULATION_HOP / SAMPLE_RATE_HZ)
    return torch.cat([hann[:, None] * angle.cos(), hann[:, None] * angle.sin()], dim=1).float()


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
