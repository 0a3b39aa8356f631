"""The rows of a published label embedding as embeddings of the model format.

The format's embeddings have 64 numbers, of which the last four are wave vectors that the engine reads and does not
average in a blend (Documentation~/model-format.md). A published row may need all 64. So rows are expressed in their
principal directions: the 60 that vary most fill the texture's numbers, and what is left, the least, stands in the wave
vectors' place, so small that no motion makes ribs of it. The field graph turns it back, exactly for every label; in a
blend only the least part is the heaviest label's instead of the mean.
"""

from __future__ import annotations

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor, nn

from haptoflow_training.errors import InputError
from haptoflow_training.models.conditioning import EMBEDDING_SIZE

_TEXTURE = EMBEDDING_SIZE - 4
# Cycles per millimetre for a unit of a row: at 1 m/s a rate of 0.001 Hz, where ribs begin at 0.5 Hz.
_RIB_SCALE = 1e-6
# Directions that vary less than this share of the first one are rounding.
_LEAST_SHARE = 1e-6


class EmbeddingRows(nn.Module):
    """embeddings: [classes, 64] for the file, float32. Maps embeddings [B, 64] back to rows [B, label]."""

    def __init__(self, rows: Tensor) -> None:
        super().__init__()
        values: NDArray[np.float64] = rows.detach().double().numpy()
        mean = values.mean(axis=0)
        left, sizes, directions = np.linalg.svd(values - mean, full_matrices=False)
        count = int((sizes > _LEAST_SHARE * sizes[:1]).sum())
        if count > EMBEDDING_SIZE:
            raise InputError(
                f"label_embed.emb.weight: {len(values)} rows that vary in {count} directions; expected at most "
                f"{EMBEDDING_SIZE}, the size of an embedding of the model format"
            )
        scale = np.ones(EMBEDDING_SIZE)
        scale[_TEXTURE:] = _RIB_SCALE
        embeddings = np.zeros((len(values), EMBEDDING_SIZE))
        embeddings[:, :count] = (left * sizes)[:, :count]
        self.embeddings: NDArray[np.float32] = (embeddings * scale).astype(np.float32)
        self.turn = nn.Linear(EMBEDDING_SIZE, values.shape[1])
        weight = np.zeros((values.shape[1], EMBEDDING_SIZE))
        weight[:, :count] = directions[:count].T
        self.turn.weight.data = torch.from_numpy((weight / scale).astype(np.float32))
        self.turn.bias.data = torch.from_numpy(mean.astype(np.float32))

    def forward(self, embedding: Tensor) -> Tensor:
        return self.turn(embedding)
