"""The interface of a network that returns a whole segment in one pass, in place of a velocity."""

from __future__ import annotations

import torch
from torch import Tensor, nn

from haptoflow_training.models.rib_comb import RibComb

INPUTS = ("noisy", "previous", "embedding", "motion", "phases")


class SegmentNetwork(nn.Module):
    """A network that returns the whole segment in one pass, in unit scale (waves are divided by the level).

    inputs: the names of what its exported graph reads, in the order of `INPUTS`; the other arguments of `forward` do
    not affect its output. is_sampled: it draws a segment instead of predicting the mean, so that a distance between
    distributions can train it.
    """

    inputs: tuple[str, ...] = INPUTS
    is_sampled = True

    @property
    def comb(self) -> RibComb | None:
        """The comb of its rib partials; None for a network without ribs."""
        raise NotImplementedError

    def forward(self, noisy: Tensor, previous: Tensor, embedding: Tensor, motion: Tensor, phases: Tensor) -> Tensor:
        """Segment [B, 1, 200] from standard normal noise and previous waveform [B, 1, 200], embedding [B, 64],
        motion [B, 3] (vx, vy in m/s, force in N) and phases [B, 6] (models/surface_waves.py)."""
        raise NotImplementedError

    def loss(
        self,
        segment: Tensor,
        previous: Tensor,
        embedding: Tensor,
        motion: Tensor,
        phases: Tensor,
        generator: torch.Generator,
    ) -> Tensor:
        """[B]: this network's own training loss for recorded segments [B, 1, 200], row by row."""
        raise NotImplementedError


class SegmentNetworkGraph(nn.Module):
    """A segment network with exactly the arguments of its exported graph: `inputs`, in order."""

    def __init__(self, network: SegmentNetwork) -> None:
        super().__init__()
        self.network = network

    def forward(self, *given: Tensor) -> Tensor:
        named = dict(zip(self.network.inputs, given, strict=True))
        # Only arguments that the network ignores are missing, so the placeholder does not end in the graph.
        placeholder = given[0].new_zeros(())
        return self.network(*(named.get(name, placeholder) for name in INPUTS))
