"""The condition inputs of rivals: material and motion."""

from __future__ import annotations

import torch
from torch import Tensor, nn

from haptoflow_paper.runs.velocity_field import MotionEncoder
from haptoflow_training.models.conditioning import EMBEDDING_SIZE


class ConditionEncoder(nn.Module):
    """Embedding [B, 64] and motion [B, 3] to one vector [B, size]."""

    def __init__(self, size: int) -> None:
        super().__init__()
        self.motion = MotionEncoder()
        self.project = nn.Linear(2 * EMBEDDING_SIZE, size)

    def forward(self, embedding: Tensor, motion: Tensor) -> Tensor:
        return self.project(torch.cat([embedding, self.motion(motion)], dim=1))
