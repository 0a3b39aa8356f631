"""What all baselines share: one signature, one way into a graph, one way to hear of material and motion."""

from __future__ import annotations

import torch
from torch import Tensor, nn

from haptoflow_training.models.conditioning import EMBEDDING_SIZE, MotionEncoder, MotionFeatures

SEGMENT_SAMPLES = 200
INPUTS = ("noisy", "previous", "embedding", "motion")


class Baseline(nn.Module):
    """A network that returns the whole segment in one pass, in unit scale (waves are divided by the level).

    `inputs` names what its exported graph reads, in the order of `INPUTS`; the rest of forward's arguments do
    not reach its output.
    """

    inputs: tuple[str, ...] = INPUTS

    def forward(self, noisy: Tensor, previous: Tensor, embedding: Tensor, motion: Tensor) -> Tensor:
        """Segment [B, 1, 200] from standard normal noise and previous waveform [B, 1, 200], embedding [B, 64]
        and motion [B, 3] (vx, vy in m/s, force in N)."""
        raise NotImplementedError

    def loss(
        self, segment: Tensor, previous: Tensor, embedding: Tensor, motion: Tensor, generator: torch.Generator
    ) -> Tensor:
        """[B]: what this baseline is trained to make small for recorded segments [B, 1, 200], row by row."""
        raise NotImplementedError


class DeterministicBaseline(Baseline):
    """One answer for one question: trained by mean squared error on the segment, no noise read."""

    inputs = ("previous", "embedding", "motion")

    def loss(
        self, segment: Tensor, previous: Tensor, embedding: Tensor, motion: Tensor, generator: torch.Generator
    ) -> Tensor:
        answer = self(torch.zeros_like(segment), previous, embedding, motion)
        return (answer - segment).square().mean(dim=(1, 2))


class BaselineGraph(nn.Module):
    """A baseline with exactly the arguments that its graph has: `inputs`, in order."""

    def __init__(self, baseline: Baseline) -> None:
        super().__init__()
        self.baseline = baseline

    def forward(self, *given: Tensor) -> Tensor:
        named = dict(zip(self.baseline.inputs, given, strict=True))
        # Only what the baseline does not read is missing, so nothing of the stand-in is left in the graph.
        stand_in = given[0].new_zeros(())
        return self.baseline(*(named.get(name, stand_in) for name in INPUTS))


class ConditionEncoder(nn.Module):
    """Embedding [B, 64] and motion [B, 3] to one vector [B, size]."""

    def __init__(self, size: int) -> None:
        super().__init__()
        self.motion = MotionEncoder()
        self.project = nn.Linear(2 * EMBEDDING_SIZE, size)

    def forward(self, embedding: Tensor, motion: Tensor) -> Tensor:
        return self.project(torch.cat([embedding, self.motion(motion)], dim=1))


class ConditionPerceptron(nn.Module):
    """Embedding [B, 64] and motion features through two hidden layers to [B, outputs]."""

    def __init__(self, outputs: int, hidden: int = 256) -> None:
        super().__init__()
        self.features = MotionFeatures()
        self.layers = nn.Sequential(
            nn.Linear(EMBEDDING_SIZE + self.features.size, hidden),
            nn.SiLU(),
            nn.Linear(hidden, hidden),
            nn.SiLU(),
            nn.Linear(hidden, outputs),
        )

    def forward(self, embedding: Tensor, motion: Tensor) -> Tensor:
        return self.layers(torch.cat([embedding, self.features(motion)], dim=1))
