"""Labels as vectors: learnt numbers, and the known wave vectors of their ribs or threads.

The last four of the 64 numbers are two wave vectors (x and y, cycles per millimetre). They are physical quantities, not
weights: a ruled surface under a stylus at velocity v vibrates at |k . v|, whatever the network has learnt. Blending two
labels blends their wave vectors too. A label without ribs has zeros there.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import torch
from torch import Tensor, nn

from haptoflow_training.waveform import SAMPLE_RATE_HZ, SEGMENT_SAMPLES

WAVE_VECTORS = 2
WAVE_NUMBERS = 2 * WAVE_VECTORS
# How many numbers tell the specimens of a label apart, and the initial size of their directions in the embedding.
_SPREAD_DIRECTIONS, _INITIAL_SPREAD = 4, 0.1


class LabelEmbedding(nn.Module):
    """[B] label indices to [B, 64]. wave_vectors: for each label, up to two (x, y) in cycles per millimetre.

    specimens: how many pieces of each label are recorded. Each has an offset of its own within a few directions that
    all labels share; over the specimens of a label they add up to zero, so that a label is the mean of its pieces.
    """

    wave_numbers: Tensor

    def __init__(self, size: int, wave_vectors: Sequence[Sequence[tuple[float, float]]], specimens: int = 0) -> None:
        super().__init__()
        self.learnt = nn.Embedding(len(wave_vectors), size - WAVE_NUMBERS)
        self.specimens = specimens
        # Processes that train together cannot share parameters of size 0.
        self.pieces: nn.Parameter | None = None
        self.directions: nn.Parameter | None = None
        if specimens:
            self.pieces = nn.Parameter(torch.zeros(len(wave_vectors), specimens, _SPREAD_DIRECTIONS))
            self.directions = nn.Parameter(_INITIAL_SPREAD * torch.randn(_SPREAD_DIRECTIONS, size - WAVE_NUMBERS))
        known = torch.zeros(len(wave_vectors), WAVE_NUMBERS)
        for row, vectors in enumerate(wave_vectors):
            for place, (x, y) in enumerate(vectors[:WAVE_VECTORS]):
                known[row, 2 * place : 2 * place + 2] = torch.tensor([x, y])
        self.register_buffer("wave_numbers", known)

    @property
    def weight(self) -> Tensor:
        """[labels, 64]: the table of a model file."""
        return torch.cat([self.learnt.weight, self.wave_numbers], dim=1)

    @property
    def offsets(self) -> Tensor:
        """[labels, specimens, 60]: of each specimen from its label."""
        if self.pieces is None or self.directions is None:
            return self.learnt.weight.new_zeros(len(self.wave_numbers), 0, self.learnt.embedding_dim)
        return (self.pieces - self.pieces.mean(dim=1, keepdim=True)) @ self.directions

    def forward(self, label: Tensor, specimen: Tensor | None = None) -> Tensor:
        """specimen [B]: the piece, -1 for the label itself, as without it."""
        learnt = self.learnt(label)
        if specimen is not None and self.specimens:
            known = (specimen >= 0).to(learnt.dtype).unsqueeze(1)
            learnt = learnt + known * self.offsets[label, specimen.clamp(min=0)]
        return torch.cat([learnt, self.wave_numbers[label]], dim=1)


def signed_rib_frequencies_hz(embedding: Tensor, motion: Tensor) -> Tensor:
    """[B, 2, 1]: k . v of both wave vectors for embedding [B, 64] and motion [B, 3] (m/s); negative for motion
    against them."""
    vectors = embedding[:, -WAVE_NUMBERS:].reshape(-1, WAVE_VECTORS, 2)
    velocity_mmps = 1000.0 * motion[:, 0:2].unsqueeze(2)
    return vectors @ velocity_mmps


def rib_frequencies_hz(embedding: Tensor, motion: Tensor) -> Tensor:
    """[B, 2, 1]: |k . v| of both wave vectors for embedding [B, 64] and motion [B, 3] (m/s)."""
    return signed_rib_frequencies_hz(embedding, motion).abs()


def surface_path(embedding: Tensor, position_mm: Tensor, wander_turns: Tensor) -> Tensor:
    """[B, 3, N]: the turns of each family in the middle of N samples, from the places [B, N + 1, 2] and the wander [B, N
    + 1, 3] at their beginnings and at the end; whole turns at the first sample are left out."""
    vectors = embedding[:, -WAVE_NUMBERS:].detach().double().reshape(-1, WAVE_VECTORS, 2)
    placed = position_mm.double() @ vectors.transpose(1, 2)
    slips = wander_turns[:, :, WAVE_VECTORS:].double()
    steps = slips[:, 1:] - slips[:, :-1]
    slipped = torch.cat([slips[:, :1], slips[:, :1] + (steps - steps.round()).cumsum(dim=1)], dim=1)
    turns = torch.cat([placed + wander_turns[:, :, :WAVE_VECTORS].double(), slipped], dim=2)
    turns = turns - turns[:, :1].floor()
    return (0.5 * (turns[:, 1:] + turns[:, :-1])).transpose(1, 2).to(embedding.dtype)


def surface_phases(embedding: Tensor, motion: Tensor, position_mm: Tensor, wander: Tensor) -> Tensor:
    """[B, 6]: the phases (models/label_embedding.py) at position_mm [B, 2], for embedding [B, 64] and motion [B, 3].

    Doubles for the position: a stroke of metres crosses thousands of ribs. wander [B, 6]: by how much each family is
    displaced from k . x, in turns, and how fast that changes, in Hz; of stick-slip, which no position fixes, all of it.
    """
    vectors = embedding[:, -WAVE_NUMBERS:].detach().double().reshape(-1, WAVE_VECTORS, 2)
    placed = (vectors @ position_mm.double().unsqueeze(2)).squeeze(2)
    crossed = signed_rib_frequencies_hz(embedding.detach(), motion).squeeze(2)
    nothing = torch.zeros(len(embedding), 1)
    turns = torch.cat([placed, nothing.double()], dim=1) + wander[:, : WAVE_VECTORS + 1].double()
    rates = torch.cat([crossed, nothing], dim=1) + wander[:, WAVE_VECTORS + 1 :]
    wrapped = (turns - turns.floor()).to(rates.dtype)
    # Rounding could lift a phase just below one turn to 1.
    return torch.cat([wrapped - wrapped.floor(), rates], dim=1)


# Waves fixed to the surface: harmonics of ribs and of stick-slip, at known phases and rates.
# A surface has up to three families: ribs or threads along two wave vectors, and the relaxation oscillation of a tip
# that sticks and slips. `phases` [B, 6] says where each is at a segment's first sample, in turns, and then how fast
# each advances, in Hz and with sign. A recorder that knows its ribs states true phases; at run time the engine adds
# them up. In training, `phases` [B, 6 + 3 * 200] also says where each family is at every sample of the segment: a
# hand changes its speed within 100 ms, and ribs would blur if they were fitted at places where they are not.
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


# `rate_features` has two numbers for each family of waves: the size of its rate and its direction.
RATE_FEATURES = 2 * FAMILIES
_TURNING_HZ = 20.0


def rate_features(phases: Tensor) -> Tensor:
    """[B, 6]: the sizes of the three families' rates on a logarithmic scale, then their directions from -1 to 1, which
    pass smoothly through 0 at rest. The network needs rates because they, and not the speed alone, decide how a
    surface's waves sound."""
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
