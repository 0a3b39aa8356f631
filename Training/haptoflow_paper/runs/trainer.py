"""The training loop with rivals, latents, ablations, the reflow phase and a budget of computing time."""

from __future__ import annotations

import dataclasses
import functools
import math
import time
from pathlib import Path
from typing import Any

import torch
from torch import Tensor
from tqdm import tqdm

from haptoflow_paper.codec.representation import build_representation
from haptoflow_paper.rivals import build_rival
from haptoflow_paper.rivals.autoregressive import AutoregressiveRival
from haptoflow_paper.runs.configuration import EvaluatedConfig, SolverConfig
from haptoflow_paper.runs.flow_matching import (
    AverageField, Field, ReflowPairs, flow_matching_loss, mean_flow_loss, own_pairs, solve
)
from haptoflow_paper.runs.networks import AverageVelocityField, EvaluatedModel
from haptoflow_paper.runs.velocity_field import VelocityField
from haptoflow_training.errors import InputError
from haptoflow_training.models.haptoflow_model import Condition, HaptoFlowModel
from haptoflow_training.models.label_embedding import FAMILIES, WAVE_VECTORS
from haptoflow_training.models.level_model import LevelModel
from haptoflow_training.training.batches import SegmentBatch
from haptoflow_training.training.budget import Budget
from haptoflow_training.training.losses import (
    Losses, ScaledBatch, audible, motion_at, weighted_mean, with_floor, without_waves
)
from haptoflow_training.training.processes import Processes
from haptoflow_training.training.trainer import Phase, TimeLimit, Trainer, WaveVectors
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
        # Bursts that the level cannot predict (an impact, the first motion after a rest) are learnt, but must not outweigh a
        # hundred ordinary segments.
        power = given.segment.square().mean(dim=(1, 2)).clamp(min=1.0)
        if isinstance(field, AutoregressiveRival) and objective in ("filter", "own"):
            return self._filter_loss(field, given, objective, generator)
        if objective == "own":
            own = field.loss(given.segment, given.previous, given.embedding, motion, given.phases, generator)
            # A likelihood weighs all segments alike: weighting down unpredictable ones would bias it towards too little
            # variance.
            weight = torch.ones_like(power) if field.is_sampled else power.reciprocal()
            return (weight * own).sum() / weight.sum()
        if objective == "average-velocity":

            def bound(rows: slice) -> AverageField:
                def average(noisy: Tensor, time: Tensor, interval: Tensor) -> Tensor:
                    return field(
                        noisy, time, given.previous[rows], given.embedding[rows], motion[rows], given.phases[rows],
                        interval,
                    )  # fmt: skip

                return average

            return mean_flow_loss(bound, given.segment, generator, 1.0 / power)
        if objective == "flow":
            return flow_matching_loss(self._field(given.condition), given.segment, generator, 1.0 / power)
        return super().field_loss(given, objective, generator)

    @staticmethod
    def _filter_loss(
        field: AutoregressiveRival, given: ScaledBatch, objective: str, generator: torch.Generator
    ) -> Tensor:
        """As of the product's skeleton (training/losses.py)."""
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


_PAIRS_AT_A_TIME = 500


class EvaluatedTrainer(Trainer):
    """Trains one evaluated configuration. With `optimiser.budget_seconds` the clock is the process's computing time."""

    _config: EvaluatedConfig
    _losses: EvaluatedLosses

    def __init__(self, *arguments: Any, **named: Any) -> None:
        super().__init__(*arguments, **named)
        self._clock = time.process_time
        self._pair_count = self._config.recipe.reflow_pairs

    @staticmethod
    def losses_of(config: EvaluatedConfig) -> type[Losses]:  # type: ignore[override]
        # A run with a skeleton is as the product's.
        if config.model.network != "field":
            return Trainer.losses_of(config)
        return functools.partial(EvaluatedLosses, solver=config.solver)  # type: ignore[return-value]

    @staticmethod
    def build_model(  # type: ignore[override]
        config: EvaluatedConfig, wave_vectors: WaveVectors, specimens: int = 0
    ) -> HaptoFlowModel:
        shape = config.model
        if shape.network != "field":
            return Trainer.build_model(config, wave_vectors, specimens)
        representation = build_representation(shape.representation)
        # In the product's order, so that the same seed gives the same weights.
        level = LevelModel()
        if shape.architecture == "unet":
            channels, positions = representation.shape
            field_class = AverageVelocityField if config.recipe.objective == "average-velocity" else VelocityField
            field: Any = field_class(
                channels=channels, positions=positions, patch=shape.patch, width=shape.width,
                previous_width=shape.previous_width, ribs=shape.ribs, impulses=shape.impulses, levels=shape.levels,
            )  # fmt: skip
        else:
            field = build_rival(shape.architecture, ribs=shape.ribs, sampled=shape.sampled)
        return EvaluatedModel(
            wave_vectors=wave_vectors, representation=representation, level=level, field=field, specimens=specimens
        )

    @staticmethod
    def possible_phases(config: EvaluatedConfig) -> list[Phase]:  # type: ignore[override]
        if config.model.network != "field":
            return Trainer.possible_phases(config)
        _, level, fitted_filter, field, energy, forced, polish = Trainer.possible_phases(config)
        recipe = config.recipe
        objective = "own" if config.model.architecture != "unet" else recipe.objective
        reflow = Phase("reflow", "reflow", recipe.reflow_steps, recipe.reflow_learning_rate, field.batch_size)
        if not energy.steps:
            forced = dataclasses.replace(forced, objective=reflow.objective if reflow.steps else objective)
        field = dataclasses.replace(field, objective=objective)
        return [level, fitted_filter, field, reflow, energy, forced, polish]

    @staticmethod
    def check_start(config: EvaluatedConfig, processes: Processes, base: Path | None) -> None:  # type: ignore[override]
        if config.optimiser.budget_seconds and processes.count > 1:
            raise InputError("optimiser.budget_seconds works with one process only; leave it out under torchrun")
        Trainer.check_start(config, processes, base)

    def limit_time(self, limit: TimeLimit) -> None:
        """As of every trainer: the limit by the wall clock replaces a budget."""
        super().limit_time(limit)
        self._clock = time.monotonic

    def shared_out_budget(self) -> Budget | None:
        seconds = self._config.optimiser.budget_seconds
        if self._limit is not None or not seconds:
            return super().shared_out_budget()
        return self.divided(seconds, self.rehearsed(math.inf))

    def rehearsal(self) -> EvaluatedTrainer:
        tried = super().rehearsal()
        tried._pair_count = _PAIRS_AT_A_TIME
        return tried

    def enter(self, phase: Phase) -> None:
        super().enter(phase)
        if phase.objective == "reflow":
            if self._step == phase.first_step:
                self.start_from_average()
            self._losses.pairs = self._make_pairs()

    def _make_pairs(self) -> ReflowPairs:
        """Noise and the segments that the flow makes of it. A resumed run draws new pairs with its present weights,
        because the earlier weights are gone."""
        generator = torch.Generator().manual_seed(self._config.seed + 17)
        count = self._pair_count // self._processes.count
        batches = tqdm(
            range(0, count, _PAIRS_AT_A_TIME), desc="pairs", unit="batch", disable=not self._processes.is_first
        )
        model = self.averaged_model
        return ReflowPairs.joined([own_pairs(model, self._batches.draw(_PAIRS_AT_A_TIME), generator) for _ in batches])

    def validate(self, phase: Phase | None = None) -> tuple[float, float]:
        phase = phase or self._phases[-1]
        if phase.objective == "reflow":
            # Its pairs are the network's own: what it is for is the flow.
            phase = next(entry for entry in self._phases if entry.name != "reflow" and entry.objective != "level")
        return super().validate(phase)
