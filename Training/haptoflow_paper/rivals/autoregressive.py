"""The autoregressive rival (after Culbertson et al. 2014): white noise through an all-pole filter.

The published models fit a filter of order 14 to 20 at every recorded speed and force and interpolate line spectral
frequencies over a Delaunay triangulation of that plane, one plane for each material. Ours is of order 16, and a
perceptron predicts reflection coefficients. It therefore also follows directions and blended labels, for which a
triangulated plane has no place, and tanh keeps every filter stable, as the order of the line spectral frequencies does
there.
"""

from __future__ import annotations

import torch
from torch import Tensor

from haptoflow_paper.rivals.rival import Rival, reads
from haptoflow_training.models.all_pole_filter import AllPoleFilter, PredictedFilter, burg_distance, prediction_errors
from haptoflow_training.models.conditioning import ConditionPerceptron
from haptoflow_training.models.level_model import PREVIOUS_LIMIT
from haptoflow_training.models.skeleton import LIKELIHOOD_END

ORDER = 16


class AutoregressiveRival(Rival):
    """Predicts a filter and a level from material and motion; noise continues the previous waveform through the filter.

    With ribs, it continues the previous waveform without its rib lines, and the lines are added.
    """

    # Amid the samples of a segment that the likelihood counts.
    middle = (ORDER + LIKELIHOOD_END) // 2

    def __init__(self, *, ribs: bool = False) -> None:
        super().__init__(ribs=ribs)
        self.inputs = reads("noisy", "previous", ribs=ribs)
        self.perceptron = ConditionPerceptron(ORDER + 1)
        self.filter = AllPoleFilter(ORDER)
        self.predicted = PredictedFilter(ORDER)

    def process(self, embedding: Tensor, motion: Tensor) -> tuple[Tensor, Tensor]:
        """Coefficients a_1..a_16 [B, 16] of A(z) and the log RMS [B, 1] of the noise that drives it."""
        return self.predicted(self.perceptron(embedding, motion))

    def own_form(self, noisy: Tensor, previous: Tensor, embedding: Tensor, motion: Tensor) -> Tensor:
        # Only the likelihood fits the filter; the energy distance, which trains the lines, would only blur it.
        coefficients, log_gain = (part.detach() for part in self.process(embedding, motion))
        drive = noisy[:, 0] * log_gain.exp()
        wave = self.filter(drive, coefficients, previous[:, 0, -ORDER:])
        # A past from another filter can drive a slowly decaying one far out of range; the networks' input limit applies
        # here too.
        return wave.clamp(-PREVIOUS_LIMIT, PREVIOUS_LIMIT).unsqueeze(1)

    def loss(
        self,
        segment: Tensor,
        previous: Tensor,
        embedding: Tensor,
        motion: Tensor,
        phases: Tensor,
        generator: torch.Generator,
    ) -> Tensor:
        """[B]: Gaussian negative log-likelihood per sample of the one-step prediction errors, without the rib lines, from
        the filter's 17th sample to its 88th, as of the product's skeleton: what was before the segment may be silence or
        another material, and later a hand moves otherwise."""
        coefficients, log_gain = self.process(embedding, motion)
        rest, _ = self.rest(segment, previous, embedding, motion, phases)
        error = prediction_errors(rest[:, 0, :LIKELIHOOD_END], coefficients)
        return (log_gain + 0.5 * error.square() * torch.exp(-2.0 * log_gain)).mean(dim=1)

    def filter_distance(self, segment: Tensor, embedding: Tensor, motion: Tensor) -> Tensor:
        """[B]: of the predicted filter from Burg's of a recorded segment [B, 1, 200] (models/all_pole_filter.py)."""
        return burg_distance(self.perceptron(embedding, motion), segment[:, 0])
