"""Labels as vectors: learnt numbers, and the known wave vectors of their ribs or threads.

The last four of the 64 numbers are two wave vectors (x and y, cycles per millimetre). They are physical quantities, not
weights: a ruled surface under a stylus at velocity v vibrates at |k . v|, whatever the network has learnt. Blending two
labels blends their wave vectors too. A label without ribs has zeros there.
"""

from __future__ import annotations

from collections.abc import Sequence

import torch
from torch import Tensor, nn

WAVE_VECTORS = 2
WAVE_NUMBERS = 2 * WAVE_VECTORS


class LabelEmbedding(nn.Module):
    """[B] label indices to [B, 64]. wave_vectors: for each label, up to two (x, y) in cycles per millimetre."""

    wave_numbers: Tensor

    def __init__(self, size: int, wave_vectors: Sequence[Sequence[tuple[float, float]]]) -> None:
        super().__init__()
        self.learnt = nn.Embedding(len(wave_vectors), size - WAVE_NUMBERS)
        known = torch.zeros(len(wave_vectors), WAVE_NUMBERS)
        for row, vectors in enumerate(wave_vectors):
            for place, (x, y) in enumerate(vectors[:WAVE_VECTORS]):
                known[row, 2 * place : 2 * place + 2] = torch.tensor([x, y])
        self.register_buffer("wave_numbers", known)

    @property
    def weight(self) -> Tensor:
        """[labels, 64]: the table of a model file."""
        return torch.cat([self.learnt.weight, self.wave_numbers], dim=1)

    def forward(self, label: Tensor) -> Tensor:
        return torch.cat([self.learnt(label), self.wave_numbers[label]], dim=1)


def signed_rib_frequencies_hz(embedding: Tensor, motion: Tensor) -> Tensor:
    """[B, 2, 1]: k . v of both wave vectors for embedding [B, 64] and motion [B, 3] (m/s); negative for motion
    against them."""
    vectors = embedding[:, -WAVE_NUMBERS:].reshape(-1, WAVE_VECTORS, 2)
    velocity_mmps = 1000.0 * motion[:, 0:2].unsqueeze(2)
    return vectors @ velocity_mmps


def rib_frequencies_hz(embedding: Tensor, motion: Tensor) -> Tensor:
    """[B, 2, 1]: |k . v| of both wave vectors for embedding [B, 64] and motion [B, 3] (m/s)."""
    return signed_rib_frequencies_hz(embedding, motion).abs()


def rib_phase(embedding: Tensor, position_mm: Tensor) -> Tensor:
    """[B, 2]: the rib phase k . x of both wave vectors in turns, wrapped to [0, 1), at position_mm [B, 2] (doubles: a
    stroke of metres crosses thousands of ribs)."""
    vectors = embedding[:, -WAVE_NUMBERS:].detach().double().reshape(-1, WAVE_VECTORS, 2)
    turns = (vectors @ position_mm.double().unsqueeze(2)).squeeze(2)
    return (turns - turns.floor()).to(embedding.dtype)
