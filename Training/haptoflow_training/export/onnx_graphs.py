"""The ONNX graph of a tier's network, opset 16, dynamic batch."""

from __future__ import annotations

import inspect
import io
import warnings
from collections.abc import Sequence
from typing import Any

import onnx
import torch
from torch import Tensor, nn

from haptoflow_training.models.refiner import ENTERING, Refiner
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
