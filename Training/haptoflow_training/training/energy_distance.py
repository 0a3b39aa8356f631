"""Spectral energy distance: what makes one evaluation of the network a whole segment.

Gritsenko et al. 2020 (A spectral energy distance for parallel speech synthesis), equation 4: with x a recorded and
y1, y2 two independently generated segments of the same condition,
loss = (D(x, y1) + D(x, y2)) / 2 - D(y1, y2) / 2. The last term rewards variety, so the conditional mean, on which one
Euler step of a plain flow lands, is not a minimum. D compares magnitudes of short spectra of [past, segment], so that
the seam counts too, and the samples themselves near the seam.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import lru_cache
from typing import TypeVar

import torch
from torch import Tensor

# The longest window spans past and segment: it resolves 5 Hz, and a ruled surface's lines smear there when the
# segment does not keep the phase of what came before it.
WINDOW_SAMPLES = (16, 32, 64, 128, 200, 400)
_SHORT_PAST_SAMPLES = 64
_SEAM_SAMPLES = 64
_POWER_FLOOR = 1e-5
_LINE_WEIGHT = 2.0

T = TypeVar("T", Tensor, list[Tensor])


@lru_cache(maxsize=None)
def _basis(window: int) -> Tensor:
    """[window, 2 * bins]: Hann-windowed cosines and sines; white noise of power 1 has mean power 1 in every bin."""
    samples = torch.arange(window, dtype=torch.float64)
    hann = 0.5 - 0.5 * torch.cos(2.0 * math.pi * samples / window)
    hann = hann / hann.square().sum().sqrt()
    bins = torch.arange(window // 2 + 1, dtype=torch.float64)
    angle = 2.0 * math.pi * samples[:, None] * bins[None, :] / window
    return torch.cat([hann[:, None] * angle.cos(), hann[:, None] * angle.sin()], dim=1).float()


def magnitudes(wave: Tensor, window: int) -> Tensor:
    """[B, N] to [B, frames, window / 2 + 1] magnitudes; hop max(4, window / 4)."""
    frames = wave.unfold(1, window, max(4, window // 4))
    # One product of matrices: of a stack, PyTorch would make one for every row of the batch.
    rows = frames.reshape(-1, window) @ _basis(window)
    real, imaginary = rows.reshape(*frames.shape[:2], -1).chunk(2, dim=2)
    return (real.square() + imaginary.square() + 1e-8).sqrt()


def spectral_distance(first: list[Tensor], second: list[Tensor]) -> Tensor:
    """[B]: mean over windows of the mean magnitude difference and the RMS over bins of the log magnitudes'."""
    total = torch.zeros(first[0].shape[0])
    for one, other in zip(first, second, strict=True):
        total = total + (one - other).abs().mean(dim=(1, 2))
        logs = 0.5 * ((one.square() + _POWER_FLOOR).log() - (other.square() + _POWER_FLOOR).log())
        total = total + (logs.square().mean(dim=2) + 1e-8).sqrt().mean(dim=1)
    return total / len(first)


def sample_distance(first: Tensor, second: Tensor) -> Tensor:
    """[B]: RMS of the difference near the seam plus half that of the whole segment; [B, 200] each."""
    difference = (first - second).square()
    near = (difference[:, :_SEAM_SAMPLES].mean(dim=1) + 1e-8).sqrt()
    return near + 0.5 * (difference.mean(dim=1) + 1e-8).sqrt()


def line_distance(first: Tensor, second: Tensor) -> Tensor:
    """[B]: RMS of the wave that the partials of first and second [B, 2, P] differ by."""
    return (0.5 * (first - second).square().sum(dim=(1, 2)) + 1e-8).sqrt()


def energy_score(recorded: T, drawn: tuple[T, T], distance: Callable[[T, T], Tensor]) -> Tensor:
    """[B]: the distance of two draws from the recorded, less half of that from each other."""
    first, second = drawn
    attraction = 0.5 * (distance(recorded, first) + distance(recorded, second))
    return attraction - 0.5 * distance(first, second)


def spectra(past: Tensor, segment: Tensor) -> list[Tensor]:
    """Magnitudes of past and segment [B, 200] by window (WINDOW_SAMPLES), [B, frames, bins] each; the shorter ones from
    the past's last samples on."""
    whole = torch.cat([past, segment], dim=1)
    near = whole[:, past.shape[1] - _SHORT_PAST_SAMPLES :]
    return [magnitudes(near if window <= near.shape[1] else whole, window) for window in WINDOW_SAMPLES]


def energy_distance_loss(
    recorded: list[Tensor],
    drawn: tuple[list[Tensor], list[Tensor]],
    weight: Tensor,
    *,
    waves: tuple[Tensor, ...] | None,
    lines: tuple[Tensor, ...],
) -> Tensor:
    """The loss of a batch from the spectra of the recording and of two draws, each with its past; weight [B].

    waves: recorded segment and draws [B, 200], where all follow the same past; None where the draws follow a past of
    the network's own, since then the samples have no reason to agree and only spectra are compared.
    lines: the partials [B, 2, P] of a ruled surface, zero for another, of recorded segment and draws, each seen from its
    own past: a line a hundredth of the band wide hardly shows in short spectra, and holds or loses its phase here.
    """
    loss = energy_score(recorded, drawn, spectral_distance)
    if waves is not None:
        loss = loss + energy_score(waves[0], (waves[1], waves[2]), sample_distance)
    loss = loss + _LINE_WEIGHT * energy_score(lines[0], (lines[1], lines[2]), line_distance)
    return (weight * loss).sum() / weight.sum()
