"""The refinement: a network's correction of the skeleton, in one evaluation.

The flow begins at the skeleton instead of at white noise, a data-dependent prior as in PriorGrad (Lee et al. 2022) and
SpecGrad (Koizumi et al. 2022), and takes one step; the energy distance trains that step directly. The correction starts
at zero, so the untrained network is the skeleton. Material and motion act through FiLM parameters, which a perceptron
predicts outside the graph, in native code.
"""

from __future__ import annotations

import torch
from torch import Tensor

from haptoflow_training.models.condition_perceptron import ConditionPerceptron
from haptoflow_training.models.patch_unet import PatchUnet
from haptoflow_training.models.skeleton import SWING_HARMONICS, SkeletonParts
from haptoflow_training.models.surface_waves import RATE_FEATURES, rate_features

ENTERING = 2 + 2 * SWING_HARMONICS
_HIDDEN = 128


class Refiner(PatchUnet):
    """Corrections [B, 1, 200] of skeletons, in unit scale."""

    film_factors: Tensor

    def __init__(self, *, width: int = 48, previous_width: int = 16, levels: int = 2) -> None:
        super().__init__(entering=ENTERING, width=width, previous_width=previous_width, levels=levels)
        factors, starts = self.film_scales()
        self.condition = ConditionPerceptron(len(factors), _HIDDEN, RATE_FEATURES)
        self.register_buffer("film_factors", factors, persistent=False)
        with torch.no_grad():
            self.condition.layers[-1].bias += starts

    def film(self, embedding: Tensor, motion: Tensor, phases: Tensor) -> Tensor:
        """FiLM parameters [B, F]."""
        return self.condition(embedding, motion, rate_features(phases)) * self.film_factors

    @staticmethod
    def entering(parts: SkeletonParts) -> Tensor:
        """What the network sees, [B, 12, 200]: the skeleton, the impulses that drove it, and the harmonics of the
        surface's waves, those of all families added."""
        waves = torch.cat([parts.cosines.sum(dim=1), parts.sines.sum(dim=1)], dim=1)
        return torch.cat([parts.begun, parts.struck, waves], dim=1)

    def forward(
        self, parts: SkeletonParts, previous: Tensor, embedding: Tensor, motion: Tensor, phases: Tensor
    ) -> Tensor:
        mirrored = previous[:, :, self.newest_first]
        film = self.film(embedding, motion, phases)
        return self.through(self.entering(parts).unsqueeze(2), mirrored.unsqueeze(2), film)
