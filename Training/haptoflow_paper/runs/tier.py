"""Tiers of evaluated runs: rivals and the average velocity as graphs, latents with their codec."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import torch
from torch import Tensor, nn

from haptoflow_paper.rivals.segment_network import SegmentNetwork, SegmentNetworkGraph
from haptoflow_paper.runs.configuration import EvaluatedConfig
from haptoflow_paper.runs.networks import EvaluatedModel
from haptoflow_training.export.onnx_graphs import example_inputs, export_graph, export_network
from haptoflow_training.export.trained_tier import TrainedTier
from haptoflow_training.models.haptoflow_model import Condition
from haptoflow_training.models.surface_waves import PHASES


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


class EvaluatedTier(TrainedTier):
    """kind: of a rival `direct`, of MeanFlow `average-velocity`. A latent tier has an encoder and a decoder. A tier
    with a skeleton is as the product's."""

    config: EvaluatedConfig

    @property
    def kind(self) -> str:
        if not isinstance(self.model, EvaluatedModel):
            return super().kind
        if isinstance(self.model.field, SegmentNetwork):
            return "direct"
        return "average-velocity" if self.config.recipe.objective == "average-velocity" else super().kind

    def evaluate(self, noisy: Tensor, time: Tensor, interval: Tensor, condition: Condition) -> Tensor:
        if self.kind == "average-velocity":
            return self.model.field(noisy, time, *condition, interval)
        return super().evaluate(noisy, time, interval, condition)

    def graphs(self) -> dict[str, bytes]:
        if not isinstance(self.model, EvaluatedModel):
            return super().graphs()
        graphs = {f"{self.name}.field": network_graph(self.model, self.kind)}
        if self.model.representation.is_latent:
            with tempfile.TemporaryDirectory() as folder:
                for name in ("encoder", "decoder"):
                    path = Path(folder) / f"{name}.onnx"
                    getattr(self.model.representation, f"export_{name}")(path)
                    graphs[f"{self.name}.{name}"] = path.read_bytes()
        return graphs

    def header_entry(self) -> dict[str, Any]:
        entry = super().header_entry()
        if isinstance(self.model, EvaluatedModel) and self.model.representation.is_latent:
            entry |= {"representation": "latent", "latent_shape": list(self.model.representation.shape)}
            entry |= {name: f"{self.name}.{name}" for name in ("encoder", "decoder")}
        return entry
