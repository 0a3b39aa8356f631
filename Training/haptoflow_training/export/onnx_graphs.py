"""ONNX graphs of the velocity field and the level model, opset 16, dynamic batch."""

from __future__ import annotations

import io
import warnings

import onnx
import torch
from torch import Tensor, nn

from haptoflow_training.models.conditioning import EMBEDDING_SIZE
from haptoflow_training.models.level_model import LevelModel
from haptoflow_training.models.velocity_field import VelocityField

OPSET = 16


def _export(module: nn.Module, inputs: dict[str, Tensor], output: str) -> bytes:
    buffer = io.BytesIO()
    with warnings.catch_warnings():
        # Tracing warns about Python integers that are constants of the architecture here, and the exporter about
        # shapes that it does not infer; the checker below says what matters.
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
    # The exporter's notes on source lines would carry paths of the machine that trained.
    for node in graph.graph.node:
        node.doc_string = ""
    return graph.SerializeToString()


def export_velocity_field(field: VelocityField) -> bytes:
    """Inputs noisy, time, previous, embedding, motion; output velocity (model-format.md, Graphs)."""
    batch = 2
    wave = torch.zeros(batch, field.channels, field.positions)
    return _export(
        field,
        {
            "noisy": wave,
            "time": torch.zeros(batch, 1),
            "previous": wave.clone(),
            "embedding": torch.zeros(batch, EMBEDDING_SIZE),
            "motion": torch.full((batch, 3), 0.1),
        },
        "velocity",
    )


def export_level_model(level: LevelModel) -> bytes:
    """Inputs embedding, motion; output log_level."""
    batch = 2
    return _export(
        level, {"embedding": torch.zeros(batch, EMBEDDING_SIZE), "motion": torch.full((batch, 3), 0.1)}, "log_level"
    )
