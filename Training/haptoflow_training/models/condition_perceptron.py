"""A perceptron of material, motion and rib rates: what native code evaluates in place of a graph."""

from __future__ import annotations

import torch
from torch import Tensor, nn

from haptoflow_training.models.conditioning import EMBEDDING_SIZE, MotionFeatures


class ConditionPerceptron(nn.Module):
    """Embedding [B, 64] and motion features, and `further` numbers [B, F] if any, through two hidden layers to
    [B, outputs]."""

    def __init__(self, outputs: int, hidden: int = 256, further: int = 0) -> None:
        super().__init__()
        self.features = MotionFeatures()
        self.layers = nn.Sequential(
            nn.Linear(EMBEDDING_SIZE + self.features.size + further, hidden),
            nn.SiLU(),
            nn.Linear(hidden, hidden),
            nn.SiLU(),
            nn.Linear(hidden, outputs),
        )

    def forward(
        self, embedding: Tensor, motion: Tensor, further: Tensor | None = None, *, last_layer_only: bool = False
    ) -> Tensor:
        """last_layer_only: gradients reach no other layer."""
        given = [embedding, self.features(motion)] + ([] if further is None else [further])
        hidden = self.layers[:-1](torch.cat(given, dim=1))
        return self.layers[-1](hidden.detach() if last_layer_only else hidden)
