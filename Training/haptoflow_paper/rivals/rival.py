"""The base class of all rivals, with the rib lines of the block given-the-same."""

from __future__ import annotations

import torch
from torch import Tensor, nn

from haptoflow_paper.runs.continuing_comb import GAINS, ContinuingComb, spread_gains
from haptoflow_paper.runs.velocity_field import MotionEncoder
from haptoflow_training.models.conditioning import EMBEDDING_SIZE, ConditionPerceptron
from haptoflow_training.models.rib_comb import PARTIALS, RibComb

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
        motion [B, 3] (vx, vy in m/s, force in N) and phases [B, 6] (models/label_embedding.py)."""
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


RIB_INPUTS = ("previous", "phases")
_HIDDEN = 96


class RibLines(nn.Module):
    """The rib lines of a segment and of its previous waveform; zero until trained.

    The partials are those of our network (models/rib_comb.py), with gains from a perceptron of material and motion.
    The rival's own form models the rest.
    """

    spread: Tensor

    def __init__(self) -> None:
        super().__init__()
        self.comb = ContinuingComb()
        self.register_buffer("spread", spread_gains(), persistent=False)
        self.gains = ConditionPerceptron(GAINS, _HIDDEN)
        last = self.gains.layers[-1]
        nn.init.zeros_(last.weight)
        nn.init.zeros_(last.bias)

    def forward(self, previous: Tensor, embedding: Tensor, motion: Tensor, phases: Tensor) -> tuple[Tensor, Tensor]:
        """The lines of the segment, and the previous waveform without its lines, [B, 1, 200] each, in unit scale."""
        mirrored = torch.flip(previous, dims=[2])
        ribs = self.comb.ribs(phases)
        gains = torch.index_select(self.gains(embedding, motion), 1, self.spread)
        lines = self.comb.partials(ribs, mirrored, gains)[1] * ribs.sounding
        rest = mirrored - (lines * self.comb.mirror).reshape(-1, 1, 2 * PARTIALS) @ ribs.waves
        return lines.reshape(-1, 1, 2 * PARTIALS) @ ribs.waves, torch.flip(rest, dims=[2])


class Rival(SegmentNetwork):
    """A segment network that may add rib lines to what its published form makes of the rest."""

    def __init__(self, *, ribs: bool = False) -> None:
        super().__init__()
        self.lines = RibLines() if ribs else None

    @property
    def comb(self) -> RibComb | None:
        return None if self.lines is None else self.lines.comb

    def forward(self, noisy: Tensor, previous: Tensor, embedding: Tensor, motion: Tensor, phases: Tensor) -> Tensor:
        if self.lines is None:
            return self.own_form(noisy, previous, embedding, motion)
        lines, rest = self.lines(previous, embedding, motion, phases)
        return lines + self.own_form(noisy, rest, embedding, motion)

    def own_form(self, noisy: Tensor, previous: Tensor, embedding: Tensor, motion: Tensor) -> Tensor:
        """[B, 1, 200]: the output of the published form, from the previous waveform without its rib lines."""
        raise NotImplementedError

    def rest(
        self, segment: Tensor, previous: Tensor, embedding: Tensor, motion: Tensor, phases: Tensor
    ) -> tuple[Tensor, Tensor]:
        """A recorded segment and its previous waveform without their rib lines, [B, 1, 200] each, to which the
        published form is fitted."""
        if self.lines is None:
            return segment, previous
        lines, rest = self.lines(previous, embedding, motion, phases)
        return segment - lines, rest


class RegressingRival(Rival):
    """A rival that predicts the mean: trained by mean squared error on the segment, without noise input. `sampled`:
    it reads noise, and the mean squared error is only its first training phase."""

    def __init__(self, *, ribs: bool = False, sampled: bool = False) -> None:
        super().__init__(ribs=ribs)
        self.is_sampled = sampled
        self.inputs = reads(*(("noisy",) if sampled else ()), "previous", ribs=ribs)

    def loss(
        self,
        segment: Tensor,
        previous: Tensor,
        embedding: Tensor,
        motion: Tensor,
        phases: Tensor,
        generator: torch.Generator,
    ) -> Tensor:
        noise = torch.randn(segment.shape, generator=generator)
        answer = self(noise, previous, embedding, motion, phases)
        return (answer - segment).square().mean(dim=(1, 2))


def reads(*own: str, ribs: bool) -> tuple[str, ...]:
    """The inputs of a rival in the order of `INPUTS`: its own, material and motion, and those of the rib lines."""
    wanted = {*own, "embedding", "motion", *(RIB_INPUTS if ribs else ())}
    return tuple(name for name in INPUTS if name in wanted)


class ConditionEncoder(nn.Module):
    """Embedding [B, 64] and motion [B, 3] to one vector [B, size]."""

    def __init__(self, size: int) -> None:
        super().__init__()
        self.motion = MotionEncoder()
        self.project = nn.Linear(2 * EMBEDDING_SIZE, size)

    def forward(self, embedding: Tensor, motion: Tensor) -> Tensor:
        return self.project(torch.cat([embedding, self.motion(motion)], dim=1))
