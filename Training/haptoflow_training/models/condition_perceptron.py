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

    def forward(self, embedding: Tensor, motion: Tensor, further: Tensor | None = None) -> Tensor:
        given = [embedding, self.features(motion)] + ([] if further is None else [further])
        return self.layers(torch.cat(given, dim=1))
