"""Further objectives: `own` (a rival's published training loss), `average-velocity` (MeanFlow) and `reflow`; and `filter`
of the autoregressive rival."""

from __future__ import annotations

from typing import Any

import torch
from torch import Tensor

from haptoflow_paper.objectives.mean_flow import AverageField, mean_flow_loss
from haptoflow_paper.objectives.reflow import ReflowPairs
from haptoflow_paper.rivals.autoregressive import AutoregressiveRival
from haptoflow_paper.runs.configuration import SolverConfig
from haptoflow_paper.runs.flow_matching import Field, flow_matching_loss, solve
from haptoflow_training.models.haptoflow_model import Condition, HaptoFlowModel
from haptoflow_training.models.label_embedding import WAVE_VECTORS
from haptoflow_training.models.surface_waves import FAMILIES
from haptoflow_training.training.batches import SegmentBatch
from haptoflow_training.training.filter_fitting import audible, motion_at, weighted_mean, with_floor, without_waves
from haptoflow_training.training.losses import Losses, ScaledBatch
from haptoflow_training.waveform import SEGMENT_SAMPLES


class EvaluatedLosses(Losses):
    """pairs: what the reflow objective draws from; set before its phase."""

    pairs: ReflowPairs | None = None

    def __init__(self, model: HaptoFlowModel, *, solver: SolverConfig, **named: Any) -> None:
        super().__init__(model, **named)
        self._solver = solver

    def forward(self, batch: SegmentBatch, objective: str, generator: torch.Generator) -> tuple[Tensor, Tensor]:
        if objective != "reflow":
            return super().forward(batch, objective, generator)
        if self.pairs is None:
            raise ValueError("the reflow objective needs pairs")
        level = self.level_loss(batch)
        return level, self.pairs.draw(len(batch.label), generator).loss(self.model, generator)

    def field_loss(self, given: ScaledBatch, objective: str, generator: torch.Generator) -> Tensor:
        field, motion = self.model.field, given.batch.motion
        if isinstance(field, AutoregressiveRival) and objective in ("filter", "own"):
            return self._filter_loss(field, given, objective, generator)
        if objective == "own":
            own = field.loss(given.segment, given.previous, given.embedding, motion, given.phases, generator)
            # A likelihood weighs all segments alike: weighting down unpredictable ones would bias it towards too little
            # variance.
            weight = torch.ones_like(given.power) if field.is_sampled else given.power.reciprocal()
            return (weight * own).sum() / weight.sum()
        if objective == "average-velocity":

            def bound(rows: slice) -> AverageField:
                def average(noisy: Tensor, time: Tensor, interval: Tensor) -> Tensor:
                    return field(
                        noisy, time, given.previous[rows], given.embedding[rows], motion[rows], given.phases[rows],
                        interval,
                    )  # fmt: skip

                return average

            return mean_flow_loss(bound, given.segment, generator, 1.0 / given.power)
        if objective == "flow":
            return flow_matching_loss(self._field(given.condition), given.segment, generator, 1.0 / given.power)
        return super().field_loss(given, objective, generator)

    @staticmethod
    def _filter_loss(
        field: AutoregressiveRival, given: ScaledBatch, objective: str, generator: torch.Generator
    ) -> Tensor:
        """As of the product's skeleton (training/skeleton_losses.py)."""
        segment, weight = with_floor(given.segment, given.log_level, generator), audible(given.log_level)
        if objective == "own":
            motion = motion_at(given.batch.motion_path, field.middle)
            own = field.loss(segment, given.previous, given.embedding, motion, given.phases, generator)
            return weighted_mean(own, weight)
        if field.lines is not None:
            weight = weight * without_waves(given.phases[:, FAMILIES : FAMILIES + WAVE_VECTORS])
        motion = motion_at(given.batch.motion_path, SEGMENT_SAMPLES // 2)
        return weighted_mean(field.filter_distance(segment, given.embedding, motion), weight)

    def drawn(self, objective: str, noise: Tensor, condition: Condition) -> Tensor:
        if objective == "average-velocity":
            start = torch.zeros(len(noise), 1)
            return noise + self.model.field(noise, start, *condition, torch.ones_like(start))
        if objective in ("energy", "own"):
            return super().drawn(objective, noise, condition)
        return solve(self._field(condition), noise, self._solver.kind, self._solver.steps)

    def _field(self, condition: Condition) -> Field:
        return lambda noisy, time: self.model.field(noisy, time, *condition)
