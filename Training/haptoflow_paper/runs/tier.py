"""Tiers of evaluated runs: rivals and the average velocity as graphs, latents with their codec."""

from __future__ import annotations

import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor, nn

from haptoflow_paper.rivals.rival import SegmentNetwork, SegmentNetworkGraph
from haptoflow_paper.runs.configuration import EvaluatedConfig
from haptoflow_paper.runs.flow_matching import solve
from haptoflow_paper.runs.networks import EvaluatedModel
from haptoflow_paper.runs.velocity_field import FieldModel
from haptoflow_training.export.exponents import RecordedWindows, draw_windows
from haptoflow_training.export.model_file import ModelFile
from haptoflow_training.export.trained_tier import TrainedTier, export_graph
from haptoflow_training.models.conditioning import EMBEDDING_SIZE
from haptoflow_training.models.haptoflow_model import Condition, HaptoFlowModel, parameter_count
from haptoflow_training.models.label_embedding import PHASES
from haptoflow_training.preprocessing.store import SegmentStore
from haptoflow_training.training.batches import HeldOut

SEED_SAMPLES = 400
_SPEEDS_MPS = (0.008, 0.02, 0.04, 0.07, 0.12, 0.2, 0.35, 0.6, 0.9, 1.3)
_FORCES_NEWTONS = (0.4, 1.2, 3.0)
_FARTHEST = 0.5


@dataclass(frozen=True)
class SeedBank:
    """waves [N, 400], each of RMS 1. entries: label, velocity_mps and force_newtons of each row, and for labels with
    ribs rib_phase: turns along each wave vector at sample 200, the first one that is played."""

    waves: NDArray[np.float32]
    entries: list[dict[str, object]]


def _condition_distance(windows: RecordedWindows, speed_mps: float, force_newtons: float) -> NDArray[np.float64]:
    return np.sqrt(
        np.square(np.log((windows.speed_mps + 0.002) / (speed_mps + 0.002)))
        + np.square(0.5 * np.log((windows.motion[:, 2] + 0.05) / (force_newtons + 0.05)))
        + np.square(windows.unsteadiness)
    )


def build_seed_bank(
    store: SegmentStore, wave_numbers: NDArray[np.float32], *, seed: int, held_out: HeldOut, candidates: int = 3000
) -> SeedBank:
    """For every label, the steadiest recorded window nearest to each point of a grid of speeds and forces.

    Grid points without a nearby window outside the held-out bands are left out; each label keeps at least its steadiest
    window. wave_numbers [labels, 4]: k1x, k1y, k2x, k2y of each label's ribs in cycles per millimetre, 0 for none.
    """
    waves: list[NDArray[np.float32]] = []
    entries: list[dict[str, object]] = []
    for index, label in enumerate(store.labels):
        windows = draw_windows(store, index, samples=SEED_SAMPLES, count=candidates, seed=seed, held_out=held_out)
        chosen: set[int] = set()
        for speed_mps in _SPEEDS_MPS:
            for force_newtons in _FORCES_NEWTONS:
                distance = _condition_distance(windows, speed_mps, force_newtons)
                nearest = int(distance.argmin())
                if distance[nearest] < _FARTHEST:
                    chosen.add(nearest)
        if not chosen:
            chosen.add(int(_condition_distance(windows, 0.06, 1.0).argmin()))
        for row in sorted(chosen):
            wave = windows.waves[row]
            rms = float(np.sqrt(np.square(wave, dtype=np.float64).mean()))
            if rms <= 0.0:
                continue
            waves.append((wave / rms).astype(np.float32))
            entry: dict[str, object] = {
                "label": label,
                "velocity_mps": [round(float(value), 5) for value in windows.motion[row, :2]],
                "force_newtons": round(float(windows.motion[row, 2]), 4),
            }
            wave_vectors = wave_numbers[index].astype(np.float64).reshape(2, 2)
            if wave_vectors.any():
                turns = np.mod(wave_vectors @ windows.position_mm[row].astype(np.float64), 1.0)
                # Rounding could lift a phase just below one turn to 1, which is out of range.
                entry["rib_phase"] = [round(float(turn), 5) % 1.0 for turn in turns]
            entries.append(entry)
    return SeedBank(np.stack(waves), entries)


class _OneStep(nn.Module):
    """A network trained to produce the whole segment in one step, as a graph: noise in, segment out, with the flow
    time as a constant."""

    def __init__(self, model: HaptoFlowModel) -> None:
        super().__init__()
        self.model = model

    def forward(
        self, noisy: Tensor, previous: Tensor, embedding: Tensor, motion: Tensor, phases: Tensor | None = None
    ) -> Tensor:
        phase = noisy.new_zeros(()) if phases is None else phases
        return self.model.one_step(noisy, previous, embedding, motion, phase)


def example_inputs(model: HaptoFlowModel) -> tuple[Tensor, dict[str, Tensor]]:
    """A batch of two for the model's network: what it works on, and by name all other inputs but the flow time."""
    batch = 2
    wave = torch.zeros(batch, *model.shape)
    conditions = {
        "previous": wave.clone(),
        "embedding": torch.zeros(batch, EMBEDDING_SIZE),
        "motion": torch.full((batch, 3), 0.1),
    }
    if model.comb is not None:
        conditions["phases"] = torch.full((batch, PHASES), 0.25)
    return wave, conditions


def export_network(model: FieldModel, kind: str) -> bytes:
    """The graph of a tier of `kind` "flow" or "direct" (model-format.md, Graphs).

    A direct tier's graph has no flow time: a field trained by the energy distance is valid only for one step from time
    0.
    """
    wave, conditions = example_inputs(model)
    if kind == "flow":
        return export_graph(model.field, {"noisy": wave, "time": torch.zeros(len(wave), 1), **conditions}, "velocity")
    if kind == "direct":
        return export_graph(_OneStep(model), {"noisy": wave, **conditions}, "segment")
    raise ValueError(f"unknown tier kind '{kind}'")


def export_level_model(level: nn.Module) -> bytes:
    """The graph of the level model: inputs embedding, motion; output log_level."""
    batch = 2
    return export_graph(
        level, {"embedding": torch.zeros(batch, EMBEDDING_SIZE), "motion": torch.full((batch, 3), 0.1)}, "log_level"
    )


class _AverageVelocity(nn.Module):
    """The average velocity field, with its inputs in the order of the model format."""

    def __init__(self, field: nn.Module) -> None:
        super().__init__()
        self.field = field

    def forward(
        self,
        noisy: Tensor,
        time: Tensor,
        interval: Tensor,
        previous: Tensor,
        embedding: Tensor,
        motion: Tensor,
        phases: Tensor | None = None,
    ) -> Tensor:
        return self.field(noisy, time, previous, embedding, motion, phases, interval)


def network_graph(model: EvaluatedModel, kind: str) -> bytes:
    """As `export_network`, for a rival and for tiers of `kind` "average-velocity" too."""
    wave, conditions = example_inputs(model)
    if isinstance(model.field, SegmentNetwork):
        examples = {"noisy": wave, **conditions, "phases": torch.full((len(wave), PHASES), 0.25)}
        inputs = {name: examples[name] for name in model.field.inputs}
        return export_graph(SegmentNetworkGraph(model.field), inputs, "segment")
    if kind == "average-velocity":
        moment = torch.zeros(len(wave), 1)
        inputs = {"noisy": wave, "time": moment, "interval": moment.clone(), **conditions}
        return export_graph(_AverageVelocity(model.field), inputs, "velocity")
    return export_network(model, kind)


_GOLDEN_SOLVERS = {
    "flow": (("euler", 1), ("euler", 8), ("midpoint", 2), ("heun", 3), ("midpoint", 4)),
    "average-velocity": (("euler", 1), ("euler", 2), ("euler", 4)),
    "direct": (("euler", 1),),
}


class EvaluatedTier(TrainedTier):
    """kind: of a field `flow`, or `direct` after the energy distance; of a rival `direct`, of MeanFlow `average-velocity`.
    A latent tier has an encoder and a decoder. A tier with a skeleton is as the product's."""

    config: EvaluatedConfig

    @property
    def is_latent(self) -> bool:
        return isinstance(self.model, EvaluatedModel) and self.model.representation.is_latent

    @property
    def kind(self) -> str:
        if not isinstance(self.model, EvaluatedModel):
            return super().kind
        if isinstance(self.model.field, SegmentNetwork):
            return "direct"
        if self.config.recipe.objective == "average-velocity":
            return "average-velocity"
        return "direct" if self.config.recipe.energy_steps else "flow"

    @property
    def solver(self) -> str:
        return self.config.solver.kind if self.kind == "flow" else super().solver

    @property
    def steps(self) -> int:
        return self.config.solver.steps if self.kind == "flow" else super().steps

    @property
    def golden_solvers(self) -> tuple[tuple[str, int], ...]:
        # Golden vectors cover tiers of samples: a latent one starts from noise of another shape, which only the engine
        # draws.
        return () if self.is_latent else _GOLDEN_SOLVERS.get(self.kind, super().golden_solvers)

    def generate(self, noise: Tensor, condition: Condition, solver: str, steps: int) -> Tensor:
        kind = self.kind
        if kind not in ("flow", "average-velocity"):
            return super().generate(noise, condition, solver, steps)

        def field(noisy: Tensor, time: Tensor) -> Tensor:
            interval = (torch.full_like(time, 1.0 / steps),) if kind == "average-velocity" else ()
            return self.model.field(noisy, time, *condition, *interval)

        return solve(field, noise, solver if kind == "flow" else "euler", steps)

    def graphs(self) -> dict[str, bytes]:
        if not isinstance(self.model, EvaluatedModel):
            return super().graphs()
        graphs = {f"{self.name}.field": network_graph(self.model, self.kind)}
        if self.is_latent:
            with tempfile.TemporaryDirectory() as folder:
                for name in ("encoder", "decoder"):
                    path = Path(folder) / f"{name}.onnx"
                    getattr(self.model.representation, f"export_{name}")(path)
                    graphs[f"{self.name}.{name}"] = path.read_bytes()
        return graphs

    def shared(self, store: SegmentStore) -> ModelFile:
        if not isinstance(self.model, EvaluatedModel):
            return super().shared(store)
        bank = build_seed_bank(
            store, self.model.embedding.wave_numbers.numpy(), seed=self.config.seed, held_out=HeldOut.of(self.config.batch)
        )
        header = {"seed_bank": {"samples": SEED_SAMPLES, "tensor": "seeds", "entries": bank.entries}}
        return ModelFile(header, {"seeds": bank.waves}, {"level": export_level_model(self.model.level)})

    def header_entry(self) -> dict[str, Any]:
        if not isinstance(self.model, EvaluatedModel):
            return super().header_entry()
        entry = {
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
        if self.is_latent:
            entry |= {"representation": "latent", "latent_shape": list(self.model.representation.shape)}
            entry |= {name: f"{self.name}.{name}" for name in ("encoder", "decoder")}
        return entry
