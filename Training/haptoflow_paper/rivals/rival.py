"""The base class of all rivals, with the rib lines of the block given-the-same."""

from __future__ import annotations

import torch
from torch import Tensor, nn

from haptoflow_paper.runs.continuing_comb import GAINS, ContinuingComb, spread_gains
from haptoflow_paper.rivals.segment_network import INPUTS, SegmentNetwork
from haptoflow_training.models.condition_perceptron import ConditionPerceptron
from haptoflow_training.models.rib_comb import PARTIALS, RibComb

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
