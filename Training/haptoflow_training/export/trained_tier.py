"""A finished run as a tier of a model file, and the ONNX graph of its network, opset 16, dynamic batch."""

from __future__ import annotations

import inspect
import io
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import onnx
import torch
from torch import Tensor, nn

from haptoflow_training.errors import InputError
from haptoflow_training.export.model_file import ModelFile
from haptoflow_training.export.skeleton_tensors import Tensors, condition_tensors, skeleton_header, skeleton_tensors
from haptoflow_training.extensions import located
from haptoflow_training.models.haptoflow_model import Condition, HaptoFlowModel, SkeletonModel, parameter_count
from haptoflow_training.models.refiner import ENTERING, Refiner
from haptoflow_training.models.skeleton import Skeleton
from haptoflow_training.preprocessing.store import SegmentStore
from haptoflow_training.training.config import TIER_NAMES, TrainingConfig
from haptoflow_training.training.trainer import load_trained
from haptoflow_training.waveform import SEGMENT_SAMPLES

OPSET = 16


def trace_graph(
    module: nn.Module, examples: tuple[Tensor, ...], file: Any, inputs: Sequence[str], outputs: Sequence[str]
) -> None:
    """Write the graph of a module into a file by tracing, with a free batch; `file` as of torch.onnx.export.

    From PyTorch 2.9 on the exporter is another one by default, which writes other graphs and needs the package
    onnxscript.
    """
    is_told = "dynamo" in inspect.signature(torch.onnx.export).parameters
    torch.onnx.export(
        module.eval(),
        examples,
        file,
        opset_version=OPSET,
        input_names=list(inputs),
        output_names=list(outputs),
        dynamic_axes={name: {0: "batch"} for name in (*inputs, *outputs)},
        do_constant_folding=True,
        **({"dynamo": False} if is_told else {}),
    )


def export_graph(module: nn.Module, inputs: dict[str, Tensor], output: str) -> bytes:
    """The checked graph of a module; inputs: examples by name, in order."""
    buffer = io.BytesIO()
    with warnings.catch_warnings():
        # Tracing warns about Python integers that are constants of the architecture, and the exporter about shapes that
        # it does not infer. The checker below finds the errors that matter.
        warnings.simplefilter("ignore")
        trace_graph(module, tuple(inputs.values()), buffer, list(inputs), [output])
    graph = onnx.load_from_string(buffer.getvalue())
    onnx.checker.check_model(graph, full_check=True)
    # The exporter stores source locations, which would contain paths of this machine.
    for node in graph.graph.node:
        node.doc_string = ""
    return graph.SerializeToString()


class _Refinement(nn.Module):
    """The refinement without what native code computes: the skeleton's segment and the FiLM parameters are inputs."""

    def __init__(self, refiner: Refiner) -> None:
        super().__init__()
        self.refiner = refiner

    def forward(self, entering: Tensor, past: Tensor, own: Tensor, film: Tensor) -> Tensor:
        return self.refiner.through(entering, torch.cat([past, own], dim=1), film)


def export_refinement(refiner: Refiner) -> bytes:
    """The graph of a tier of kind "refine": inputs entering, past (what was played), own (the skeleton's own past),
    film; output correction."""
    batch, sizes = 2, sum(refiner.film_sizes)
    inputs = {
        "entering": torch.zeros(batch, ENTERING, 1, SEGMENT_SAMPLES),
        "past": torch.zeros(batch, 1, 1, SEGMENT_SAMPLES),
        "own": torch.zeros(batch, 1, 1, SEGMENT_SAMPLES),
        "film": torch.zeros(batch, sizes),
    }
    return export_graph(_Refinement(refiner), inputs, "correction")


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
        return "skeleton" if self.skeleton_model.refiner is None else "refine"

    @property
    def solver(self) -> str:
        return "euler"

    @property
    def steps(self) -> int:
        return 1

    @property
    def golden_solvers(self) -> tuple[tuple[str, int], ...]:
        """Solvers and steps that golden vectors cover; none for a tier that has no golden vectors."""
        return ((self.solver, self.steps),)

    def generate(self, noise: Tensor, condition: Condition, solver: str, steps: int) -> Tensor:
        """A segment in unit scale from noise, computed as in the engine, and what goes on beneath it, [B, pasts,
        200]."""
        return self.model.one_step(noise, *condition)

    @property
    def skeleton_model(self) -> SkeletonModel:
        """The model of a tier with a skeleton."""
        assert isinstance(self.model, SkeletonModel)
        return self.model

    @property
    def skeleton(self) -> Skeleton | None:
        """The skeleton that this tier plays or refines; None for a tier of another kind."""
        return self.model.skeleton if isinstance(self.model, SkeletonModel) else None

    def graphs(self) -> dict[str, bytes]:
        """The graphs of this tier alone, by their names in the file."""
        refiner = self.skeleton_model.refiner
        return {} if refiner is None else {f"{self.name}.field": export_refinement(refiner)}

    def tensors(self) -> Tensors:
        """The tensors of this tier alone, by their names in the file."""
        if isinstance(self.model, SkeletonModel) and self.model.refiner is not None:
            return condition_tensors(self.name, self.model.refiner)
        return {}

    def shared(self, store: SegmentStore) -> ModelFile:
        """What all tiers of the file share beside the embedding: entries of the header, tensors and graphs."""
        model = self.skeleton_model
        tensors = skeleton_tensors(model.level, model.skeleton)
        if model.embedding.specimens:
            tensors["pieces"] = model.embedding.offsets.detach().numpy().copy()
        return ModelFile({"skeleton": skeleton_header(model.skeleton)}, tensors, {})

    def header_entry(self) -> dict[str, Any]:
        """The tier's entry in the file's header."""
        graph = {"field": f"{self.name}.field"} if self.kind == "refine" else {}
        parameters = parameter_count(self.model.network)
        return {"name": self.name, "kind": self.kind, **graph, "parameters": parameters, "accuracy": {}, "cost": {}}


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
