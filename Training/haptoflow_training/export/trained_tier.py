"""A finished run as a tier of a model file, with the solver that runs its network."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import torch
from torch import Tensor

from haptoflow_training.errors import InputError
from haptoflow_training.export.onnx_graphs import export_network, export_refinement
from haptoflow_training.export.skeleton_tensors import Tensors, condition_tensors
from haptoflow_training.extensions import located
from haptoflow_training.models.haptoflow_model import Condition, HaptoFlowModel
from haptoflow_training.models.skeleton import Skeleton
from haptoflow_training.models.skeleton_model import SkeletonModel
from haptoflow_training.models.velocity_field import parameter_count
from haptoflow_training.training.config import TIER_NAMES, TrainingConfig
from haptoflow_training.training.flow_matching import solve
from haptoflow_training.training.trainer import load_trained

_ONE_STEP = ("direct", "skeleton", "refine")


@dataclass(frozen=True)
class TrainedTier:
    """kind, solver and steps as in model-format.md. folder: of the run, if it was read from one."""

    config: TrainingConfig
    labels: list[str]
    model: HaptoFlowModel
    folder: Path | None = None

    @property
    def name(self) -> str:
        return self.config.tier

    @property
    def kind(self) -> str:
        if isinstance(self.model, SkeletonModel):
            return "skeleton" if self.model.refiner is None else "refine"
        return "direct" if self.config.recipe.energy_steps else "flow"

    @property
    def solver(self) -> str:
        return self.config.solver.kind if self.kind == "flow" else "euler"

    @property
    def steps(self) -> int:
        return self.config.solver.steps if self.kind == "flow" else 1

    def evaluate(self, noisy: Tensor, time: Tensor, interval: Tensor, condition: Condition) -> Tensor:
        """The output of the exported graph: the velocity, or the segment of a direct tier. interval [B, 1]: the flow
        time of a step, which only a derived tier may read."""
        if self.kind in _ONE_STEP:
            return self.model.one_step(noisy, *condition)
        return self.model.field(noisy, time, *condition)

    def generate(self, noise: Tensor, condition: Condition, solver: str, steps: int) -> Tensor:
        """A segment in unit scale [B, 1, 200] from noise, computed as in the engine."""

        def field(noisy: Tensor, time: Tensor) -> Tensor:
            interval = torch.full_like(time, 1.0 / steps)
            return self.evaluate(noisy, time, interval, condition)

        if self.kind in _ONE_STEP:
            return field(noise, torch.zeros(noise.shape[0], 1))
        return solve(field, noise, solver if self.kind == "flow" else "euler", steps)

    @property
    def works_on_samples(self) -> bool:
        """Whether the noise that a segment begins with has the segment's shape, as golden vectors need it."""
        return self.model.shape == HaptoFlowModel.shape

    @property
    def skeleton(self) -> Skeleton | None:
        """The skeleton that this tier plays or refines; None for a velocity field."""
        return self.model.skeleton if isinstance(self.model, SkeletonModel) else None

    def graphs(self) -> dict[str, bytes]:
        """The graphs of this tier alone, by their names in the file."""
        if isinstance(self.model, SkeletonModel):
            refiner = self.model.refiner
            return {} if refiner is None else {f"{self.name}.field": export_refinement(refiner)}
        return {f"{self.name}.field": export_network(self.model, self.kind)}

    def tensors(self) -> Tensors:
        """The tensors of this tier alone, by their names in the file."""
        if isinstance(self.model, SkeletonModel) and self.model.refiner is not None:
            return condition_tensors(self.name, self.model.refiner)
        return {}

    def header_entry(self) -> dict[str, Any]:
        """The tier's entry in the file's header."""
        if self.skeleton is not None:
            graph = {"field": f"{self.name}.field"} if self.kind == "refine" else {}
            parameters = parameter_count(self.model.network)
            return {"name": self.name, "kind": self.kind, **graph, "parameters": parameters, "accuracy": {}, "cost": {}}
        return {
            "name": self.name,
            "kind": self.kind,
            "field": f"{self.name}.field",
            "level": "level",
            "solver": self.solver,
            "steps": self.steps,
            "parameters": parameter_count(self.model.network),
            "representation": "raw",
            "accuracy": {},
            "cost": {},
        }


def tier_of(config: TrainingConfig, labels: list[str], model: HaptoFlowModel, folder: Path | None = None) -> TrainedTier:
    """The tier of a run, of the class that its configuration names."""
    tier: TrainedTier = located(config.exported_as)(config, labels, model, folder)
    return tier


def load_tiers(folders: list[Path]) -> list[TrainedTier]:
    """The finished runs in `folders`, in the order of the file; they must share labels, embedding and level."""
    tiers = [tier_of(*load_trained(folder), folder) for folder in folders]
    first = tiers[0]
    if len({tier.skeleton is None for tier in tiers}) > 1:
        raise InputError(f"{', '.join(map(str, folders))}: tiers with a skeleton and tiers without do not share a file")
    for tier, folder in zip(tiers, folders, strict=True):
        shared = [(tier.model.embedding, first.model.embedding), (tier.model.level, first.model.level)]
        if tier.skeleton is not None and first.skeleton is not None:
            shared.append((tier.skeleton, first.skeleton))
        same = all(
            torch.equal(own, other)
            for module, base in shared
            for own, other in zip(module.state_dict().values(), base.state_dict().values(), strict=True)
        )
        if tier.labels != first.labels or not same:
            raise InputError(
                f"{folder}: does not share labels, embedding and level with {folders[0]}: train it with --base"
            )
    names = [tier.name for tier in tiers]
    if len(set(names)) != len(names):
        raise InputError(f"tiers {', '.join(names)}: each may stand once in a file; set `tier` in the configurations")
    return sorted(tiers, key=lambda tier: TIER_NAMES.index(tier.name))
