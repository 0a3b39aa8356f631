"""The ribs of a ruled surface for rivals that are given the same: lines beside what their own form makes.

The lines are those of our network (models/rib_comb.py), their gains a perceptron's of material and motion. What the
rival's own form has to make is the rest.
"""

from __future__ import annotations

import torch
from torch import Tensor, nn

from haptoflow_training.models.baselines.condition import ConditionPerceptron
from haptoflow_training.models.rib_comb import COMB_CHANNELS, GAINS, RibComb

_HIDDEN = 96


class RibLines(nn.Module):
    """Lines to add to a segment; silent until trained."""

    def __init__(self) -> None:
        super().__init__()
        self.comb = RibComb()
        self.gains = ConditionPerceptron(GAINS, _HIDDEN)
        last = self.gains.layers[-1]
        nn.init.zeros_(last.weight)
        nn.init.zeros_(last.bias)

    def forward(self, noisy: Tensor, previous: Tensor, embedding: Tensor, motion: Tensor, rib_phase: Tensor) -> Tensor:
        """[B, 1, 200]: the lines of the segment, in unit scale."""
        mirrored = torch.flip(previous, dims=[2])
        return self.comb(noisy, mirrored, embedding, motion, self.gains(embedding, motion))[:, COMB_CHANNELS:]

    def rest_of_past(self, previous: Tensor, embedding: Tensor, motion: Tensor) -> Tensor:
        """[B, 1, 200]: the previous waveform without its partials, for a filter that must not ring on with them."""
        mirrored = torch.flip(previous, dims=[2])
        waves, audible = self.comb.waves(embedding, motion)
        # Seen from the seam, the past's partials run backwards: cosines are the same, sines change their sign.
        going_on = self.comb.amplitudes(waves, audible, mirrored, torch.zeros_like(previous))[:, :1]
        partials = (going_on * going_on.new_tensor([1.0, -1.0])).reshape(-1, 1, waves.shape[1])
        return previous - torch.flip(partials @ waves, dims=[2])
