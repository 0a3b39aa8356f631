"""Rib lines for rivals of the block given-the-same, added to their own output.

The partials are those of our network (models/rib_comb.py), with gains from a perceptron of material and motion. The
rival's own form models the rest.
"""

from __future__ import annotations

import torch
from torch import Tensor, nn

from haptoflow_benchmark.rivals.condition import ConditionPerceptron
from haptoflow_training.models.rib_comb import GAINS, PARTIALS, RibComb, spread_gains

_HIDDEN = 96


class RibLines(nn.Module):
    """The rib lines of a segment and of its previous waveform; zero until trained."""

    spread: Tensor

    def __init__(self) -> None:
        super().__init__()
        self.comb = RibComb()
        self.register_buffer("spread", spread_gains(), persistent=False)
        self.gains = ConditionPerceptron(GAINS, _HIDDEN)
        last = self.gains.layers[-1]
        nn.init.zeros_(last.weight)
        nn.init.zeros_(last.bias)

    def forward(self, previous: Tensor, embedding: Tensor, motion: Tensor, rib_phase: Tensor) -> tuple[Tensor, Tensor]:
        """The lines of the segment, and the previous waveform without its lines, [B, 1, 200] each, in unit scale."""
        mirrored = torch.flip(previous, dims=[2])
        ribs = self.comb.ribs(embedding, motion, rib_phase)
        gains = torch.index_select(self.gains(embedding, motion), 1, self.spread)
        lines = self.comb.partials(ribs, mirrored, gains)[1] * ribs.sounding
        rest = mirrored - (lines * self.comb.mirror).reshape(-1, 1, 2 * PARTIALS) @ ribs.waves
        return lines.reshape(-1, 1, 2 * PARTIALS) @ ribs.waves, torch.flip(rest, dims=[2])
