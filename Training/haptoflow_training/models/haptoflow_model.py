"""Everything that is trained together: embedding, level model, velocity field."""

from __future__ import annotations

from torch import Tensor, nn

from haptoflow_training.models.baselines import Baseline
from haptoflow_training.models.conditioning import EMBEDDING_SIZE
from haptoflow_training.models.representation import Representation
from haptoflow_training.models.velocity_field import VelocityField

class HaptoFlowModel(nn.Module):
    """The trainable model behind one tier of a `.haptoflow` file: embedding, level and the network itself."""

    def __init__(
        self, *, label_count: int, representation: Representation, level: nn.Module, field: VelocityField | Baseline
    ) -> None:
        super().__init__()
        self.representation = representation
        self.embedding = nn.Embedding(label_count, EMBEDDING_SIZE)
        self.level = level
        self.field = field

    def log_level(self, label: Tensor, motion: Tensor) -> Tensor:
        """[B, 1]: natural logarithm of the RMS in m/s^2 expected for label [B] and motion [B, 3]."""
        return self.level(self.embedding(label), motion)
