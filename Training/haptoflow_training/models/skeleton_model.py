"""A skeleton over a label's embedding and level, and the network that refines it."""

from __future__ import annotations

from collections.abc import Sequence

from torch import Tensor, nn

from haptoflow_training.models.haptoflow_model import HaptoFlowModel
from haptoflow_training.models.refiner import Refiner
from haptoflow_training.models.rib_comb import RibComb
from haptoflow_training.models.skeleton import Skeleton


class SkeletonModel(HaptoFlowModel):
    """The skeleton alone, or refined."""

    def __init__(
        self,
        *,
        wave_vectors: Sequence[Sequence[tuple[float, float]]],
        level: nn.Module,
        skeleton: Skeleton,
        refiner: Refiner | None = None,
        specimens: int = 0,
    ) -> None:
        super().__init__(wave_vectors=wave_vectors, level=level, specimens=specimens)
        self.skeleton, self.refiner = skeleton, refiner
        # It has no weights: the losses measure partials with it.
        self.measured_ribs = RibComb()

    @property
    def comb(self) -> RibComb:
        return self.measured_ribs

    @property
    def network(self) -> nn.Module:
        return self.skeleton if self.refiner is None else self.refiner

    def one_step(self, noise: Tensor, previous: Tensor, embedding: Tensor, motion: Tensor, phases: Tensor) -> Tensor:
        parts = self.skeleton.parts(noise, previous, self.skeleton.gains(embedding, motion, phases), phases)
        if self.refiner is None:
            return parts.begun
        return parts.begun + self.refiner(parts, previous, embedding, motion, phases)
