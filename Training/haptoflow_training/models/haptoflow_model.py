"""The modules that are trained together: embedding, level model, and what makes the waveform."""

from __future__ import annotations

from collections.abc import Sequence

import torch
from torch import Tensor, nn

from haptoflow_training.models.conditioning import EMBEDDING_SIZE
from haptoflow_training.models.label_embedding import LabelEmbedding
from haptoflow_training.models.refiner import Refiner
from haptoflow_training.models.rib_comb import RibComb
from haptoflow_training.models.skeleton import NOISE_BEFORE, Skeleton
from haptoflow_training.waveform import SEGMENT_SAMPLES

# What a segment is generated under: what it continues in unit scale, [B, pasts, 200] or, encoded, [B, *shape];
# embedding [B, 64], motion [B, 3] and phases [B, 6] (models/label_embedding.py).
Condition = tuple[Tensor, Tensor, Tensor, Tensor]


class HaptoFlowModel(nn.Module):
    """The trainable model behind one tier of a `.haptoflow` file: embedding, level and what makes the waveform.

    shape: (channels, positions) of what the network works on. Here that is the samples of a segment; a derived model
    may encode them. pasts: waveforms that a segment continues: the one that was played, and any that goes on beneath
    it. noise_before: positions of the noise before a segment that still sound in it.
    """

    shape: tuple[int, int] = (1, SEGMENT_SAMPLES)
    pasts: int = 1
    noise_before: int = 0

    def __init__(
        self, *, wave_vectors: Sequence[Sequence[tuple[float, float]]], level: nn.Module, specimens: int = 0
    ) -> None:
        super().__init__()
        self.embedding = LabelEmbedding(EMBEDDING_SIZE, wave_vectors, specimens)
        self.level = level

    @property
    def comb(self) -> RibComb | None:
        """What projects waveforms on the partials of ribs; None for a model without ribs."""
        raise NotImplementedError

    @property
    def network(self) -> nn.Module:
        """What this tier trains beyond the embedding and the level."""
        raise NotImplementedError

    def encode(self, waveform: Tensor) -> Tensor:
        """[B, 1, 200] in unit scale to [B, *shape]."""
        return waveform

    def decode(self, encoded: Tensor) -> Tensor:
        """[B, *shape] to [B, 1, 200] in unit scale."""
        return encoded

    def start(self, noise: Tensor) -> Tensor:
        """The noise [B, *shape] from which a segment is generated where noise [B, 1, 200] is given."""
        return noise

    def one_step(self, noise: Tensor, previous: Tensor, embedding: Tensor, motion: Tensor, phases: Tensor) -> Tensor:
        """What a network trained for one step makes, [B, pasts, 200]: the segment, and what goes on beneath it; all
        waveforms in unit scale. noise [B, channels, noise_before + positions]; phases [B, 6] at the segment's first
        sample."""
        raise NotImplementedError


def parameter_count(module: nn.Module) -> int:
    """Weights of a module, buffers not counted."""
    return sum(parameter.numel() for parameter in module.parameters())


class SkeletonModel(HaptoFlowModel):
    """The skeleton alone, or refined: it continues its own past, the second one, whatever was played."""

    pasts = 2
    noise_before = NOISE_BEFORE

    def __init__(
        self,
        *,
        wave_vectors: Sequence[Sequence[tuple[float, float]]],
        level: nn.Module,
        skeleton: Skeleton,
        refiner: Refiner | None = None,
        specimens: int = 0,
    ) -> None:
        super().__init__(wave_vectors=wave_vectors, level=level, specimens=specimens)
        self.skeleton, self.refiner = skeleton, refiner
        # It has no weights: the losses measure partials with it.
        self.measured_ribs = RibComb()

    @property
    def comb(self) -> RibComb:
        return self.measured_ribs

    @property
    def network(self) -> nn.Module:
        return self.skeleton if self.refiner is None else self.refiner

    def one_step(self, noise: Tensor, previous: Tensor, embedding: Tensor, motion: Tensor, phases: Tensor) -> Tensor:
        parts = self.skeleton.parts(noise, previous[:, 1:], self.skeleton.gains(embedding, motion, phases), phases)
        played = parts.segment
        if self.refiner is not None:
            played = played + self.refiner(parts, previous, embedding, motion, phases)
        return torch.cat([played, parts.segment], dim=1)
