"""ONNX graphs of a tier's network and of the level model, opset 16, dynamic batch."""

from __future__ import annotations

import io
import warnings

import onnx
import torch
from torch import Tensor, nn

from haptoflow_training.models.conditioning import EMBEDDING_SIZE
from haptoflow_training.models.haptoflow_model import HaptoFlowModel
from haptoflow_training.models.segment_network import SegmentNetwork, SegmentNetworkGraph

OPSET = 16


def _export(module: nn.Module, inputs: dict[str, Tensor], output: str) -> bytes:
    buffer = io.BytesIO()
    with warnings.catch_warnings():
        # Tracing warns about Python integers that are constants of the architecture, and the exporter about shapes that
        # it does not infer. The checker below finds the errors that matter.
        warnings.simplefilter("ignore")
        torch.onnx.export(
            module.eval(),
            tuple(inputs.values()),
            buffer,
            opset_version=OPSET,
            input_names=list(inputs),
            output_names=[output],
            dynamic_axes={name: {0: "batch"} for name in (*inputs, output)},
            do_constant_folding=True,
        )
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
        self, noisy: Tensor, previous: Tensor, embedding: Tensor, motion: Tensor, rib_phase: Tensor | None = None
    ) -> Tensor:
        phase = noisy.new_zeros(()) if rib_phase is None else rib_phase
        return self.model.one_step(noisy, previous, embedding, motion, phase)


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
        rib_phase: Tensor | None = None,
    ) -> Tensor:
        return self.field(noisy, time, previous, embedding, motion, rib_phase, interval)


def _export_segment_network(network: SegmentNetwork) -> bytes:
    """The graph of a direct tier, with the inputs that the network reads."""
    wave = torch.zeros(2, 1, 200)
    examples = {
        "noisy": wave,
        "previous": wave.clone(),
        "embedding": torch.zeros(2, EMBEDDING_SIZE),
        "motion": torch.full((2, 3), 0.1),
        "rib_phase": torch.full((2, 2), 0.25),
    }
    return _export(SegmentNetworkGraph(network), {name: examples[name] for name in network.inputs}, "segment")


def export_network(model: HaptoFlowModel, kind: str) -> bytes:
    """The graph of a tier of `kind` "flow", "average-velocity" or "direct" (model-format.md, Graphs).

    A direct tier's graph has no flow time: a field trained by the energy distance is valid only for one step from time
    0.
    """
    batch, field = 2, model.field
    if isinstance(field, SegmentNetwork):
        return _export_segment_network(field)
    wave = torch.zeros(batch, field.channels, field.positions)
    moment = torch.zeros(batch, 1)
    conditions = {
        "previous": wave.clone(),
        "embedding": torch.zeros(batch, EMBEDDING_SIZE),
        "motion": torch.full((batch, 3), 0.1),
    }
    if field.comb is not None:
        conditions["rib_phase"] = torch.full((batch, 2), 0.25)
    if kind == "flow":
        return _export(field, {"noisy": wave, "time": moment, **conditions}, "velocity")
    if kind == "average-velocity":
        return _export(
            _AverageVelocity(field),
            {"noisy": wave, "time": moment, "interval": moment.clone(), **conditions},
            "velocity",
        )
    if kind == "direct":
        return _export(_OneStep(model), {"noisy": wave, **conditions}, "segment")
    raise ValueError(f"unknown tier kind '{kind}'")


def export_level_model(level: nn.Module) -> bytes:
    """The graph of the level model: inputs embedding, motion; output log_level."""
    batch = 2
    return _export(
        level, {"embedding": torch.zeros(batch, EMBEDDING_SIZE), "motion": torch.full((batch, 3), 0.1)}, "log_level"
    )
