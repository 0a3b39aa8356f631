"""What all baselines share: one signature, one way into a graph, and the ribs' lines where they are given the same."""

from __future__ import annotations

import torch
from torch import Tensor, nn

from haptoflow_training.models.baselines.rib_lines import RibLines
from haptoflow_training.models.rib_comb import RibComb

SEGMENT_SAMPLES = 200
INPUTS = ("noisy", "previous", "embedding", "motion", "rib_phase")
RIB_INPUTS = ("previous", "rib_phase")


class Baseline(nn.Module):
    """A network that returns the whole segment in one pass, in unit scale (waves are divided by the level).

    `inputs` names what its exported graph reads, in the order of `INPUTS`; the rest of forward's arguments do
    not reach its output. `is_sampled`: it draws a segment instead of stating a mean, so that a distance between
    distributions can teach it. `comb` is that of its ribs' lines, None without them.
    """

    inputs: tuple[str, ...] = INPUTS
    is_sampled = True

    def __init__(self, *, ribs: bool = False) -> None:
        super().__init__()
        self.lines = RibLines() if ribs else None

    @property
    def comb(self) -> RibComb | None:
        return None if self.lines is None else self.lines.comb

    def forward(self, noisy: Tensor, previous: Tensor, embedding: Tensor, motion: Tensor, rib_phase: Tensor) -> Tensor:
        """Segment [B, 1, 200] from standard normal noise and previous waveform [B, 1, 200], embedding [B, 64],
        motion [B, 3] (vx, vy in m/s, force in N) and rib phase [B, 2] (turns)."""
        if self.lines is None:
            return self.own_form(noisy, previous, embedding, motion)
        lines, rest = self.lines(previous, embedding, motion, rib_phase)
        return lines + self.own_form(noisy, rest, embedding, motion)

    def own_form(self, noisy: Tensor, previous: Tensor, embedding: Tensor, motion: Tensor) -> Tensor:
        """[B, 1, 200]: what the rival makes in the form that was published, from the past as the ribs' lines leave it."""
        raise NotImplementedError

    def loss(
        self,
        segment: Tensor,
        previous: Tensor,
        embedding: Tensor,
        motion: Tensor,
        rib_phase: Tensor,
        generator: torch.Generator,
    ) -> Tensor:
        """[B]: what this baseline is trained to make small for recorded segments [B, 1, 200], row by row."""
        raise NotImplementedError

    def rest(
        self, segment: Tensor, previous: Tensor, embedding: Tensor, motion: Tensor, rib_phase: Tensor
    ) -> tuple[Tensor, Tensor]:
        """What the ribs' lines leave of a recorded segment and of the past before it, [B, 1, 200] each: what the published
        form is fitted to."""
        if self.lines is None:
            return segment, previous
        lines, rest = self.lines(previous, embedding, motion, rib_phase)
        return segment - lines, rest


class RegressingBaseline(Baseline):
    """One answer for one question: trained by mean squared error on the segment, no noise read. `sampled`: it reads
    noise, and the mean squared error is no more than a start."""

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
        rib_phase: Tensor,
        generator: torch.Generator,
    ) -> Tensor:
        noise = torch.randn(segment.shape, generator=generator)
        answer = self(noise, previous, embedding, motion, rib_phase)
        return (answer - segment).square().mean(dim=(1, 2))


def reads(*own: str, ribs: bool) -> tuple[str, ...]:
    """The inputs of a baseline in their order: its own, material and motion, and what the ribs' lines read."""
    wanted = {*own, "embedding", "motion", *(RIB_INPUTS if ribs else ())}
    return tuple(name for name in INPUTS if name in wanted)


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
