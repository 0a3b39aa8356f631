"""The configuration of an evaluated run: the product's, with keys for rivals, latents, other recipes and ablations."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, ClassVar

from haptoflow_paper.rivals import ARCHITECTURES, REGRESSING
from haptoflow_training.training.config import ModelConfig, OptimiserConfig, RecipeConfig, Rule, TrainingConfig


@dataclass(frozen=True)
class SolverConfig:
    """The solver the exported tier uses by default and the one used for validation figures."""

    kind: str = "midpoint"
    steps: int = 2


@dataclass(frozen=True)
class EvaluatedModelConfig(ModelConfig):
    """network: also `field`, a velocity field from noise, or a rival in its place.

    architecture: `unet` (the velocity field, with `width` to `levels`) or the name of a rival.

    ribs: the field has a rib comb, and a rival adds rib lines (raw samples only).
    impulses: a field's rare events come from the tails of the noise (raw samples only).
    sampled: a rival that predicts the mean as published (transformer, dstn, spsi) draws its segment.
    representation: table for `build_representation`.
    patch: how many positions of the representation are one of the field.
    """

    networks: ClassVar[tuple[str, ...]] = ("field", "skeleton", "refinement")

    ribs: bool = False
    impulses: bool = False
    architecture: str = "unet"
    sampled: bool = False
    patch: int = 8
    representation: dict[str, Any] = field(default_factory=lambda: {"kind": "raw"})

    @property
    def is_raw(self) -> bool:
        """Whether the network works on samples."""
        return bool(self.representation.get("kind", "raw") == "raw")

    @property
    def has_filter(self) -> bool:
        return super().has_filter or (self.network == "field" and self.architecture == "autoregressive")


@dataclass(frozen=True)
class EvaluatedOptimiserConfig(OptimiserConfig):
    """budget_seconds: time of the whole run on one core, counted in the process's own computing time, so that other
    programs do not shorten the training. The level phases keep about their steps, the network phases are lengthened or
    shortened by one factor, and the run ends when the time is used up; 0 trains exactly the stated steps.
    """

    budget_seconds: float = 0.0


@dataclass(frozen=True)
class EvaluatedRecipeConfig(RecipeConfig):
    """objective: of the first phase (`optimiser.steps`): `flow` (conditional flow matching) or `average-velocity`
    (MeanFlow).

    reflow_steps: straightens a flow on `reflow_pairs` pairs of noise and segment that the network itself made.
    """

    objective: str = "flow"
    reflow_steps: int = 0
    reflow_pairs: int = 36000
    reflow_learning_rate: float = 4e-4


@dataclass(frozen=True)
class EvaluatedConfig(TrainingConfig):
    """A whole run of the evaluation. Its keys and values are hashed into the stored rows (rows/workplace.py)."""

    trained_by: ClassVar[str] = "haptoflow_paper.runs.trainer:EvaluatedTrainer"
    exported_as: ClassVar[str] = "haptoflow_paper.runs.tier:EvaluatedTier"

    model: EvaluatedModelConfig = field(default_factory=EvaluatedModelConfig)
    optimiser: EvaluatedOptimiserConfig = field(default_factory=EvaluatedOptimiserConfig)
    recipe: EvaluatedRecipeConfig = field(default_factory=EvaluatedRecipeConfig)
    solver: SolverConfig = field(default_factory=SolverConfig)

    def rules(self) -> tuple[Rule, ...]:
        model, recipe = self.model, self.recipe
        return (
            *super().rules(),
            (self.solver.kind in ("euler", "midpoint", "heun"), "solver.kind", "'euler', 'midpoint' or 'heun'"),
            (1 <= self.solver.steps <= 16, "solver.steps", "1 to 16"),
            (self.optimiser.budget_seconds >= 0.0, "optimiser.budget_seconds", "at least 0"),
            (
                model.architecture in ("unet", *ARCHITECTURES),
                "model.architecture",
                f"'unet' or a rival: {', '.join(ARCHITECTURES)}",
            ),
            (
                not model.sampled or model.architecture in REGRESSING,
                "model.sampled",
                f"false but for {', '.join(REGRESSING)}: all else draws by itself",
            ),
            (
                model.architecture == "unet" or (recipe.objective == "flow" and recipe.reflow_steps == 0),
                "recipe",
                "no average velocity and no reflow for a rival, which has no flow",
            ),
            (
                recipe.energy_steps == 0 or model.sampled or model.architecture not in REGRESSING,
                "recipe.energy_steps",
                "0 for a rival that does not draw: set model.sampled",
            ),
            (
                recipe.energy_steps == 0 or model.ribs or model.architecture != "autoregressive",
                "recipe.energy_steps",
                "0 for an autoregressive filter without ribs, which its likelihood alone fits",
            ),
            (
                recipe.self_forcing_steps == 0 or recipe.energy_steps > 0 or model.architecture == "unet",
                "recipe.self_forcing_steps",
                "0 for a rival without energy_steps",
            ),
            (not model.ribs or model.is_raw, "model.ribs", "false with a latent representation"),
            (not model.impulses or model.is_raw, "model.impulses", "false with a latent representation"),
            (model.architecture == "unet" or model.network == "field", "model.network", "'field' for a rival"),
            (recipe.objective in ("flow", "average-velocity"), "recipe.objective", "'flow' or 'average-velocity'"),
            (
                recipe.objective == "flow" or recipe.reflow_steps == recipe.energy_steps == 0,
                "recipe.objective",
                "'flow' where reflow_steps or energy_steps follow",
            ),
            (
                recipe.energy_steps == 0 or model.is_raw,
                "recipe.energy_steps",
                "0 with a latent representation: the energy distance compares waveforms",
            ),
            (
                recipe.self_forcing_steps == 0 or recipe.energy_steps > 0 or recipe.reflow_steps == 0,
                "recipe.self_forcing_steps",
                "0 after reflow alone: its pairs have a fixed past",
            ),
        )
