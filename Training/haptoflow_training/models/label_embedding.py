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
    """[B, 6]: the phases (models/surface_waves.py) at position_mm [B, 2], for embedding [B, 64] and motion [B, 3].

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
