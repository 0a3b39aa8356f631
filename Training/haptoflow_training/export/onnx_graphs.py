"""ONNX graphs of a tier's network and of the level model, opset 16, dynamic batch."""

from __future__ import annotations

import inspect
import io
import warnings
from collections.abc import Sequence
from typing import Any

import onnx
import torch
from torch import Tensor, nn

from haptoflow_training.models.conditioning import EMBEDDING_SIZE
from haptoflow_training.models.haptoflow_model import FieldModel, HaptoFlowModel
from haptoflow_training.models.refiner import ENTERING, Refiner
from haptoflow_training.models.surface_waves import PHASES
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


class _Refinement(nn.Module):
    """The refinement without what native code computes: the skeleton's segment and the FiLM parameters are inputs."""

    def __init__(self, refiner: Refiner) -> None:
        super().__init__()
        self.refiner = refiner

    def forward(self, entering: Tensor, past: Tensor, film: Tensor) -> Tensor:
        return self.refiner.through(entering, past, film)


def export_refinement(refiner: Refiner) -> bytes:
    """The graph of a tier of kind "refine": inputs entering, past, film; output correction."""
    batch, sizes = 2, sum(refiner.film_sizes)
    inputs = {
        "entering": torch.zeros(batch, ENTERING, 1, SEGMENT_SAMPLES),
        "past": torch.zeros(batch, 1, 1, SEGMENT_SAMPLES),
        "film": torch.zeros(batch, sizes),
    }
    return export_graph(_Refinement(refiner), inputs, "correction")


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
