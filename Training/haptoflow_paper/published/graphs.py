"""ONNX graphs of a published model, in the form that the model format gives a latent tier.

The format's time runs from 0, noise, to 1, data, against the checkpoint's, and its velocity is data minus noise. Its
solvers evaluate a step at the beginning, the middle or the end. The checkpoint's Heun is the format's; its "euler"
takes the time of the middle at the point of the beginning, which is a tier of kind `average-velocity`: that kind's
solver is Euler's, and its graph is told the step's length.
"""

from __future__ import annotations

import onnx
import torch
from torch import Tensor, nn

from haptoflow_paper.published.embedding_rows import EmbeddingRows
from haptoflow_paper.published.published_model import PublishedModel
from haptoflow_training.export.onnx_graphs import export_graph
from haptoflow_training.models.conditioning import EMBEDDING_SIZE
from haptoflow_training.waveform import SEGMENT_SAMPLES

_BATCH = 2


class _Encoder(nn.Module):
    def __init__(self, model: PublishedModel) -> None:
        super().__init__()
        self.model = model

    def forward(self, waveform: Tensor) -> Tensor:
        return self.model.encode(waveform)


class _Decoder(nn.Module):
    def __init__(self, model: PublishedModel) -> None:
        super().__init__()
        self.model = model

    def forward(self, latent: Tensor) -> Tensor:
        return self.model.decode(latent)


class _Field(nn.Module):
    """The velocity with the file's time, embedding and past; the order of the arguments is the graph's."""

    def __init__(self, model: PublishedModel, rows: EmbeddingRows, guidance: float) -> None:
        super().__init__()
        self.model, self.rows, self.guidance = model, rows, guidance

    def forward(
        self,
        noisy: Tensor,
        time: Tensor,
        previous: Tensor,
        embedding: Tensor,
        motion: Tensor,
        interval: Tensor | None = None,
    ) -> Tensor:
        left = 1.0 - time if interval is None else 1.0 - time - 0.5 * interval
        condition = self.model.condition(self.rows(embedding), motion)
        past = self.model.past_features(previous)
        return -self.model.velocity(noisy, left, condition, past, self.guidance)


class _ConstantLevel(nn.Module):
    """The same level for every label: the network's output has one unit for all materials, and this is that unit."""

    def __init__(self, log_level: float) -> None:
        super().__init__()
        self.log_level = log_level

    def forward(self, motion: Tensor) -> Tensor:
        return torch.full_like(motion[:, :1], self.log_level)


def encoder_graph(model: PublishedModel) -> bytes:
    """`waveform` [B, 1, 200] to `latent`."""
    waveform = torch.zeros(_BATCH, 1, SEGMENT_SAMPLES)
    return _with_shape(export_graph(_Encoder(model), {"waveform": waveform}, "latent"), model.latent_shape)


def decoder_graph(model: PublishedModel) -> bytes:
    """`latent` to `waveform` [B, 1, 200]."""
    latent = torch.zeros(_BATCH, *model.latent_shape)
    return _with_shape(export_graph(_Decoder(model), {"latent": latent}, "waveform"), (1, SEGMENT_SAMPLES))


def field_graph(model: PublishedModel, rows: EmbeddingRows, guidance: float) -> bytes:
    """The velocity field of a tier whose solver is the checkpoint's."""
    latent = torch.zeros(_BATCH, *model.latent_shape)
    moment = torch.zeros(_BATCH, 1)
    inputs = {
        "noisy": latent,
        "time": moment,
        "previous": latent.clone(),
        "embedding": torch.zeros(_BATCH, EMBEDDING_SIZE),
        "motion": torch.full((_BATCH, 3), 0.1),
        **({"interval": moment.clone()} if model.meta.solver == "euler" else {}),
    }
    return _with_shape(export_graph(_Field(model, rows, guidance), inputs, "velocity"), model.latent_shape)


def _with_shape(graph: bytes, shape: tuple[int, int]) -> bytes:
    """The graph with its output's shape, which the exporter does not infer after slices."""
    model = onnx.load_from_string(graph)
    for dimension, size in zip(model.graph.output[0].type.tensor_type.shape.dim[1:], shape, strict=True):
        dimension.dim_value = size
    onnx.checker.check_model(model, full_check=True)
    return model.SerializeToString()


def level_graph(log_level: float) -> bytes:
    """`motion` [B, 3] to `log_level` [B, 1], the same for every motion and label."""
    return export_graph(_ConstantLevel(log_level), {"motion": torch.full((_BATCH, 3), 0.1)}, "log_level")
