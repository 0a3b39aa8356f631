"""Everything that is trained together: embedding, level model, velocity field."""

from __future__ import annotations

import torch
from torch import Tensor, nn

from haptoflow_training.models.conditioning import EMBEDDING_SIZE
from haptoflow_training.models.level_model import LevelModel
from haptoflow_training.models.representation import Representation
from haptoflow_training.models.velocity_field import VelocityField

PREVIOUS_LIMIT = 8.0


def unit_scale(wave_mps2: Tensor, log_level: Tensor) -> Tensor:
    """[B, 1, N] in m/s^2 divided by the level exp(log_level) [B, 1]."""
    return wave_mps2 * torch.exp(-log_level).unsqueeze(-1)


class HaptoFlowModel(nn.Module):
    """The trainable model behind a `.haptoflow` file, one tier."""

    def __init__(
        self,
        *,
        label_count: int,
        representation: Representation,
        width: int,
        previous_width: int,
        patch: int,
        average: bool = False,
    ) -> None:
        super().__init__()
        channels, positions = representation.shape
        self.representation = representation
        self.embedding = nn.Embedding(label_count, EMBEDDING_SIZE)
        self.level = LevelModel()
        self.field = VelocityField(
            channels=channels,
            positions=positions,
            patch=patch,
            width=width,
            previous_width=previous_width,
            average=average,
        )

    def log_level(self, label: Tensor, motion: Tensor) -> Tensor:
        """[B, 1]: natural logarithm of the RMS in m/s^2 expected for label [B] and motion [B, 3]."""
        return self.level(self.embedding(label), motion)
