"""Waves fixed to the surface: harmonics of ribs and of stick-slip, at known phases and rates.

A surface has up to three families: ribs or threads along two wave vectors, and the relaxation oscillation of a tip that
sticks and slips. `phases` [B, 6] says where each is at a segment's first sample, in turns, and then how fast each
advances, in Hz and with sign. A recorder that knows its ribs states true phases; at run time the engine adds them up.
In training, `phases` [B, 6 + 3 * 200] also says where each family is at every sample of the segment: a hand changes its
speed within 100 ms, and ribs would blur if they were fitted at places where they are not.
"""

from __future__ import annotations

import math

import torch
from torch import Tensor, nn

from haptoflow_training.models.label_embedding import WAVE_VECTORS
from haptoflow_training.waveform import SAMPLE_RATE_HZ, SEGMENT_SAMPLES

FAMILIES = WAVE_VECTORS + 1
# Turns and rates.
PHASES = 2 * FAMILIES
# Below this rate a family stands still.
MINIMUM_HZ = 0.5


class SurfaceWaves(nn.Module):
    """Cosines and sines of the harmonics of each family, zero where the harmonic lies outside the band.

    The phase is counted in the direction of motion, so that a stroke that turns back meets the same ribs backwards.
    """

    seconds: Tensor

    def __init__(self, harmonics: int, maximum_hz: float) -> None:
        super().__init__()
        self.harmonics, self.maximum_hz = harmonics, maximum_hz
        samples = torch.arange(float(SEGMENT_SAMPLES))
        self.register_buffer("seconds", ((samples + 0.5) / SAMPLE_RATE_HZ).reshape(1, 1, -1), persistent=False)

    @torch.no_grad()
    def forward(self, phases: Tensor) -> tuple[Tensor, Tensor]:
        """phases [B, 6] to cosines and sines [B, 3, H, N], without gradient: where ribs are is not learnt."""
        turns, rates = phases[:, : 2 * FAMILIES].reshape(-1, 2, FAMILIES, 1).unbind(dim=1)
        size = rates.abs()
        path = turns + rates * self.seconds if phases.shape[1] == 2 * FAMILIES else path_of(phases)
        angle = 2.0 * math.pi * torch.where(rates < 0.0, -path, path)
        alive = (size > MINIMUM_HZ).to(phases.dtype)
        # Harmonics by rotation: cosines and sines of angles themselves take most of a training step.
        cosine, sine = torch.cos(angle), torch.sin(angle)
        turned_cosine, turned_sine = cosine * alive, sine * alive
        cosines, sines = [], []
        for order in range(1, self.harmonics + 1):
            inside = (order * size < self.maximum_hz).to(phases.dtype)
            cosines.append(inside * turned_cosine)
            sines.append(inside * turned_sine)
            turned_cosine, turned_sine = (
                turned_cosine * cosine - turned_sine * sine, turned_sine * cosine + turned_cosine * sine
            )
        return torch.stack(cosines, dim=2), torch.stack(sines, dim=2)


# Numbers that `rate_features` makes of the phases.
RATE_FEATURES = 2 * FAMILIES
_TURNING_HZ = 20.0


def rate_features(phases: Tensor) -> Tensor:
    """[B, 6]: of each family's rate the size on a logarithmic scale, and the direction, which turns smoothly through
    rest. What a surface's waves sound like depends on their rates, not on the speed alone."""
    rates = phases[:, FAMILIES : 2 * FAMILIES].detach()
    return torch.cat([rate_sizes(rates), rates / (rates.abs() + _TURNING_HZ)], dim=1)


def rate_sizes(rates_hz: Tensor) -> Tensor:
    """The sizes of rates on a logarithmic scale, about 0 to 2."""
    return 0.25 * torch.log1p(rates_hz.abs())


def path_of(phases: Tensor) -> Tensor:
    """[B, 3, 200]: the turns of each family at every sample, of phases that have them."""
    return phases[:, 2 * FAMILIES :].reshape(-1, FAMILIES, SEGMENT_SAMPLES)


def with_rates_at(phases: Tensor, sample: int) -> Tensor:
    """Phases that know their path, with the rates that each family has at a sample of it."""
    path = path_of(phases)
    rates = (path[:, :, sample + 1] - path[:, :, sample - 1]) * (0.5 * SAMPLE_RATE_HZ)
    return torch.cat([phases[:, :FAMILIES], rates, phases[:, 2 * FAMILIES :]], dim=1)


def with_path(phases: Tensor, path: Tensor) -> Tensor:
    """Phases [B, 6] with the turns [B, 3, 200] of each family at every sample."""
    return torch.cat([phases, path.flatten(1)], dim=1)


def advanced(phases: Tensor, samples: int) -> Tensor:
    """The phases of a segment that begins `samples` later, at the same rates."""
    turns, rates = phases[:, : 2 * FAMILIES].chunk(2, dim=1)
    later = turns + rates * (samples / SAMPLE_RATE_HZ)
    moved = torch.cat([later - later.floor(), rates], dim=1)
    if phases.shape[1] == 2 * FAMILIES:
        return moved
    path = path_of(phases)
    beyond = torch.arange(1.0, samples + 1.0) / SAMPLE_RATE_HZ
    ahead = path[:, :, -1:] + rates.unsqueeze(2) * beyond
    return with_path(moved, torch.cat([path[:, :, samples:], ahead], dim=2))
