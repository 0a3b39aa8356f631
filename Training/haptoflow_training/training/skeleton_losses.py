"""The losses of a skeleton and of its refinement: `filter`, `likelihood` and `energy`."""

from __future__ import annotations

import torch
from torch import Tensor

from haptoflow_training.models.label_embedding import surface_path
from haptoflow_training.models.skeleton_model import SkeletonModel
from haptoflow_training.models.surface_waves import FAMILIES, MINIMUM_HZ, advanced, with_path
from haptoflow_training.training.batches import SegmentBatch
from haptoflow_training.training.losses import Losses, ScaledBatch

# Samples by which the second pass of the shift's loss is begun later: up to the hop of an update at 72 Hz.
_MAXIMUM_SHIFT = 27
_SHIFT_WEIGHT = 1.0
_SMALL = 1e-6
# Noise added to recordings before a filter is fitted, in unit scale: 45 dB below the level, where nothing is felt, a
# filter has better uses for its poles.
_FLOOR = 10.0 ** (-45.0 / 20.0)
# A vibration of this RMS weighs half.
_FAINT_MPS2 = 0.03


class SkeletonLosses(Losses):
    """In the energy phases a skeleton keeps its likelihood, because the embedding would drift away from the filter
    without it. A refinement, for which the skeleton is given, also learns that a segment begun later says the same of
    the same samples: a network of patches would else depend on where its patches lie, and be heard at every hop."""

    model: SkeletonModel

    def field_loss(self, given: ScaledBatch, objective: str, generator: torch.Generator) -> Tensor:
        if self.model.refiner is None:
            return self._skeleton_loss(given, objective, generator)
        return self._refinement_loss(given, generator)

    def phases(self, batch: SegmentBatch, embedding: Tensor) -> Tensor:
        path = surface_path(embedding, batch.position_path_mm, batch.wander_path)
        return with_path(super().phases(batch, embedding), path)

    def drawn(self, objective: str, noise: Tensor, condition: tuple[Tensor, Tensor, Tensor, Tensor]) -> Tensor:
        return self.model.one_step(noise, *condition)

    def _skeleton_loss(self, given: ScaledBatch, objective: str, generator: torch.Generator) -> Tensor:
        skeleton = self.model.skeleton
        condition = given.embedding, given.batch.motion, given.phases
        segment = given.segment + _FLOOR * self._noise(given, generator)
        if objective == "filter":
            # Burg's method takes lines for resonances.
            still = (given.phases[:, FAMILIES : 2 * FAMILIES].abs() <= MINIMUM_HZ).all(dim=1).to(segment.dtype)
            return _mean(skeleton.filter_distance(segment, *condition), self._audible(given) * still)
        gains = skeleton.gains(*condition)
        likelihood = _mean(skeleton.likelihood(segment, gains, given.phases), self._audible(given))
        if objective == "likelihood":
            return likelihood
        drawn = tuple(
            skeleton.parts(self._noise(given, generator), given.previous, gains, given.phases).begun for _ in range(2)
        )
        return likelihood + self.one_step_loss(given, (drawn[0], drawn[1]))

    def _audible(self, given: ScaledBatch) -> Tensor:
        """[B]: near 1 where the expected level can be felt, 0 at rest, where nothing is recorded. All other segments
        weigh alike: weighting down unpredictable ones would bias a likelihood towards too little variance."""
        with torch.no_grad():
            power = self.model.level(given.embedding, given.batch.motion).squeeze(1).mul(2.0).exp()
        return power / (power + _FAINT_MPS2**2)

    def _refinement_loss(self, given: ScaledBatch, generator: torch.Generator) -> Tensor:
        model = self.model
        noise = self._noise(given, generator)
        # Both draws in one pass: few large matrix products are faster than many small ones.
        both = torch.cat([noise, self._noise(given, generator)])
        condition = [torch.cat([part, part]) for part in given.condition]
        first, second = model.one_step(both, *condition).chunk(2)
        loss = self.one_step_loss(given, (first, second))
        later = int(torch.randint(1, _MAXIMUM_SHIFT + 1, (1,), generator=generator))
        again = model.one_step(
            torch.cat([noise[:, :, later:], self._noise(given, generator)[:, :, :later]], dim=2),
            torch.cat([given.previous[:, :, later:], first[:, :, :later]], dim=2),
            given.embedding, given.batch.motion, advanced(given.phases, later),
        )  # fmt: skip
        difference = again[:, 0, : again.shape[2] - later] - first[:, 0, later:]
        shift = _mean((difference.square().mean(dim=1) + _SMALL).sqrt(), given.steadiness)
        return loss + _SHIFT_WEIGHT * shift

    @staticmethod
    def _noise(given: ScaledBatch, generator: torch.Generator) -> Tensor:
        return torch.randn(given.segment.shape, generator=generator)


def _mean(values: Tensor, weight: Tensor) -> Tensor:
    return (weight * values).sum() / (weight.sum() + _SMALL)
