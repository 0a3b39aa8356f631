"""Fits the embedding of a material by gradient descent through a frozen tier, on the energy distance between the
recording and the tier's output.

Half of every batch follows recorded previous waveforms. The other half follows the network's own output hop by hop
along the recording, so that the fit covers what is rendered in closed loop.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor

from haptoflow_training.fewshot.label_prior import LabelPrior
from haptoflow_training.fewshot.level_law import MINIMUM_SPEED_MPS, LevelLaw
from haptoflow_training.fewshot.stroke_recording import StrokeRecording
from haptoflow_training.models.file_model import FileModel, FileTier
from haptoflow_training.models.label_embedding import WAVE_NUMBERS, WAVE_VECTORS
from haptoflow_training.models.rib_comb import RibComb
from haptoflow_training.training.energy_distance import (
    energy_score,
    envelope_distance,
    envelopes,
    halves_of,
    line_distance,
    sample_distance,
    spectra,
    spectral_distance,
)
from haptoflow_training.waveform import SEGMENT_SAMPLES

HOP_SAMPLES = 28
_PREVIOUS_LIMIT = 16.0
_EMPTY_PAST_SHARE = 0.05
_LINE_WEIGHT = 2.0
# Below this speed, sensor noise outweighs the texture; above this unsteadiness, the next samples are unpredictable.
_MINIMUM_SPEED_MPS, _MAXIMUM_UNSTEADINESS = 0.01, 0.8
_TRIED_LABELS, _TRIED_OFFSETS, _PLACED_RECORDINGS = 4, 8, 8


@dataclass(frozen=True)
class EmbeddingFit:
    """embedding [64]; turns: rib phase [n, 2] of each recording's samples as the networks count it (the profiles of
    the labels begin at places of their own); nearest: index of the label that the fit started from; start_loss and
    loss: on the same segments."""

    embedding: NDArray[np.float32]
    turns: tuple[NDArray[np.float32], ...]
    nearest: int
    start_loss: float
    loss: float


@dataclass(frozen=True)
class FitOptions:
    """steps: of the optimiser; rows: segments a step, each drawn twice; pull: weight of the prior that the labels
    give."""

    steps: int = 80
    rows: int = 24
    learning_rate: float = 0.06
    pull: float = 0.002


class _Corpus:
    """The recordings end to end in unit scale: each sample divided by the level at its time."""

    def __init__(
        self, recordings: Sequence[StrokeRecording], level: LevelLaw, wave_numbers: NDArray[np.float32], seed: int
    ) -> None:
        long_enough = [each for each in recordings if len(each) > 2 * SEGMENT_SAMPLES]
        wave = np.concatenate([each.wave_mps2 for each in long_enough])
        self.motion = torch.from_numpy(np.concatenate([each.motion for each in long_enough]))
        # The level changes slowly, so it is computed at 100 Hz and interpolated.
        knots = np.append(np.arange(0, len(wave), 20), len(wave) - 1)
        log_level = np.interp(np.arange(len(wave)), knots, level.log_level(self.motion.numpy()[knots]))
        self.log_level = torch.from_numpy(log_level.astype(np.float32))
        self.wave_mps2 = torch.from_numpy(wave)
        self.unit = self.wave_mps2 * torch.exp(-self.log_level)
        self.lengths = [len(each) for each in long_enough]
        self.owner = torch.repeat_interleave(torch.arange(len(self.lengths)), torch.tensor(self.lengths))
        self.turns = torch.from_numpy(_aligned_turns(long_enough, self.unit.numpy(), wave_numbers))
        ends = np.cumsum([len(each) for each in long_enough])
        begins = ends - [len(each) for each in long_enough]
        starts = np.concatenate(
            [np.arange(begin + SEGMENT_SAMPLES, end - SEGMENT_SAMPLES) for begin, end in zip(begins, ends, strict=True)]
        )
        speed = np.hypot(*self.motion.numpy()[:, :2].T)
        moved = np.log(speed + 0.002)
        unsteadiness = np.abs(moved[starts + SEGMENT_SAMPLES - 1] - moved[starts])
        speed = speed[starts]
        moving = (speed > _MINIMUM_SPEED_MPS) & (unsteadiness < _MAXIMUM_UNSTEADINESS)
        if moving.sum() < SEGMENT_SAMPLES:
            moving = speed > MINIMUM_SPEED_MPS
        self.starts, speed = (starts[moving], speed[moving]) if moving.any() else (starts, speed)
        self._limits = np.sort(ends)
        # Classes of log speed are drawn equally often, so that speeds that are recorded often do not dominate.
        classes = np.floor(2.0 * np.log(speed + 1e-4)).astype(int)
        counts = {each: int((classes == each).sum()) for each in np.unique(classes)}
        share = np.array([1.0 / np.sqrt(counts[each]) for each in classes])
        self._share = share / share.sum()
        self._rng = np.random.default_rng(seed)

    def draw(self, count: int) -> NDArray[np.int64]:
        return self._rng.choice(self.starts, size=count, p=self._share)

    def fits(self, starts: NDArray[np.int64]) -> NDArray[np.bool_]:
        """For each start, whether the segment and the segment before it lie in one recording."""
        end = np.searchsorted(self._limits, starts - 1, side="right")
        return starts + SEGMENT_SAMPLES <= self._limits[np.minimum(end, len(self._limits) - 1)]

    def stretch(self, values: Tensor, starts: NDArray[np.int64], before: int, after: int) -> Tensor:
        index = torch.from_numpy(starts)[:, None] + torch.arange(-before, after)[None, :]
        return values[index]

    def known_motion(self, starts: NDArray[np.int64]) -> Tensor:
        """[B, 3]: the mean motion of the hop before each start, which is all that a tracker knows."""
        return self.stretch(self.motion, starts, HOP_SAMPLES, 0).mean(dim=1)


def _aligned_turns(
    recordings: Sequence[StrokeRecording], unit: NDArray[np.float32], wave_numbers: NDArray[np.float32]
) -> NDArray[np.float32]:
    """[n, 2]: rib phase of every sample in turns. The starting place of a recording on the surface is unknown, so
    each is shifted until the fundamental of its ribs has about the same phase as in all others."""
    vectors = np.asarray(wave_numbers, dtype=np.float64).reshape(WAVE_VECTORS, 2)
    found, begin = [], 0
    for recording in recordings:
        turns = recording.position_mm.astype(np.float64) @ vectors.T
        wave = unit[begin : begin + len(recording)]
        for index in range(WAVE_VECTORS):
            line = np.mean(wave * np.exp(-2j * np.pi * turns[:, index]))
            turns[:, index] += np.angle(line) / (2.0 * np.pi)
        found.append(turns - np.floor(turns))
        begin += len(recording)
    return np.concatenate(found).astype(np.float32)


class _Chains:
    """Rows that continue the network's own output, hop by hop along the recording; past in m/s^2."""

    def __init__(self, corpus: _Corpus, rows: int) -> None:
        self._corpus = corpus
        self.starts = corpus.draw(rows)
        self.past = corpus.stretch(corpus.wave_mps2, self.starts, SEGMENT_SAMPLES, 0)

    def advance(self, segment_mps2: Tensor) -> None:
        self.past = torch.cat([self.past[:, HOP_SAMPLES:], segment_mps2[:, :HOP_SAMPLES]], dim=1)
        self.starts = self.starts + HOP_SAMPLES
        lost = ~self._corpus.fits(self.starts)
        if lost.any():
            self.starts[lost] = self._corpus.draw(int(lost.sum()))
            recorded = self._corpus.stretch(self._corpus.wave_mps2, self.starts, SEGMENT_SAMPLES, 0)
            self.past = torch.where(torch.from_numpy(lost)[:, None], recorded, self.past)


class EmbeddingFitter:
    """Fits the 60 learnt numbers of one material's embedding; the four wave numbers are given."""

    def __init__(
        self,
        model: FileModel,
        tiers: Sequence[FileTier],
        prior: LabelPrior,
        recordings: Sequence[StrokeRecording],
        level: LevelLaw,
        wave_numbers: NDArray[np.float32],
        *,
        seed: int,
        options: FitOptions = FitOptions(),
        weights: Sequence[Tensor] = (),
        weights_learning_rate: float = 5e-4,
    ) -> None:
        """weights: of a trainable tier, fitted together with the embedding."""
        self._weights, self._weights_learning_rate = list(weights), weights_learning_rate
        self._labels = model.label_embeddings[:, :-WAVE_NUMBERS]
        self._tiers, self._options = tiers, options
        self._corpus = _Corpus(recordings, level, wave_numbers, seed)
        self._wave_numbers = torch.from_numpy(np.asarray(wave_numbers, dtype=np.float32))
        self._generator = torch.Generator().manual_seed(seed)
        self._mean = torch.from_numpy(prior.embedding_mean).float()
        self._axes = torch.from_numpy(prior.axes).float()
        self._spreads = torch.from_numpy(prior.spreads).float()
        families = self._wave_numbers.reshape(WAVE_VECTORS, 2)
        self._families = [index for index in range(WAVE_VECTORS) if families[index].any()]
        self._comb = RibComb() if self._families else None

    def fit(self, advance: Callable[[], None] = lambda: None) -> EmbeddingFit:
        options, corpus = self._options, self._corpus
        nearest, found_offset, start_loss = self._nearest()
        learnt = self._labels[nearest].clone().requires_grad_()
        # The starting place of each recording on the surface is fitted together with the embedding.
        offset = found_offset.repeat(len(corpus.lengths), 1).requires_grad_()
        groups = [{"params": [learnt, offset], "lr": options.learning_rate}]
        if self._weights:
            groups.append({"params": self._weights, "lr": self._weights_learning_rate})
        optimiser = torch.optim.Adam(groups, betas=(0.9, 0.98))
        rates = [group["lr"] for group in groups]
        half = options.rows // 2
        chains = [_Chains(corpus, options.rows - half) for _ in self._tiers]
        average, kept = learnt.detach().clone(), 0.0
        for step in range(options.steps):
            share = step / options.steps
            if self._comb is not None and step in (options.steps // 6, options.steps // 2):
                self._place(learnt.detach(), offset)
            for group, rate in zip(optimiser.param_groups, rates, strict=True):
                group["lr"] = rate * min(1.0, 2.0 * (1.0 - share))
            which = step % len(self._tiers)
            chain = chains[which]
            starts = np.concatenate([corpus.draw(half), chain.starts])
            loss = self._loss(self._tiers[which], learnt, offset, starts, chain) + options.pull * self._distance(learnt)
            optimiser.zero_grad()
            loss.backward()
            torch.nn.utils.clip_grad_norm_([learnt, *self._weights], 2.0)
            optimiser.step()
            if share > 0.5:
                # Average over the second half of the steps, because single steps are noisy.
                kept += 1.0
                average += (learnt.detach() - average) / kept
            advance()
        final = average if kept else learnt.detach()
        embedding = torch.cat([final, self._wave_numbers])
        found = offset.detach()
        turns = torch.remainder(corpus.turns + found[corpus.owner], 1.0).numpy()
        return EmbeddingFit(
            embedding.numpy().copy(),
            tuple(np.split(turns, np.cumsum(corpus.lengths)[:-1])),
            nearest,
            start_loss,
            self._held_loss(final, found),
        )

    def _distance(self, learnt: Tensor) -> Tensor:
        """Squared distance from the labels: in standard deviations along their principal axes, and in units of the
        smallest one in all other directions."""
        offset = learnt - self._mean
        along = self._axes @ offset
        rest = offset - self._axes.t() @ along
        if not len(self._spreads):
            # A single label has no spread.
            return rest.square().sum()
        return (along / self._spreads).square().sum() + (rest / self._spreads[-1]).square().sum()

    def _nearest(self) -> tuple[int, Tensor, float]:
        """The label with the smallest loss and, for a ruled surface, the phase offset of its profile that fits best."""
        start = torch.zeros(WAVE_VECTORS)
        losses = [self._held_loss(label, start) for label in self._labels]
        order = np.argsort(losses)[: _TRIED_LABELS if self._families else 1]
        best = int(order[0]), start, losses[int(order[0])]
        for label in order:
            offset = start.clone()
            for index in self._families:
                tried = []
                for turns in np.arange(_TRIED_OFFSETS) / _TRIED_OFFSETS:
                    offset[index] = float(turns)
                    tried.append(self._held_loss(self._labels[label], offset))
                offset[index] = float(np.argmin(tried)) / _TRIED_OFFSETS
                if min(tried) < best[2]:
                    best = int(label), offset.clone(), min(tried)
        return best

    @torch.no_grad()
    def _place(self, learnt: Tensor, offset: Tensor) -> None:
        """The starting place of each recording on the surface, by trial: a gradient finds an offset only within half
        a rib."""
        for index in range(min(len(offset), _PLACED_RECORDINGS)):
            for family in self._families:
                tried = []
                for turns in np.arange(_TRIED_OFFSETS) / _TRIED_OFFSETS:
                    moved = offset.detach().clone()
                    moved[index, family] += float(turns)
                    tried.append(self._held_loss(learnt, moved, index))
                offset[index, family] += float(np.argmin(tried)) / _TRIED_OFFSETS

    @torch.no_grad()
    def _held_loss(self, learnt: Tensor, offset: Tensor, recording: int | None = None) -> float:
        """The loss on segments and noise that are the same for every embedding; of one recording if it is given."""
        rng = np.random.default_rng(5)
        starts = self._corpus.starts
        if recording is not None:
            own = starts[self._corpus.owner.numpy()[starts] == recording]
            starts = own if len(own) else starts
        starts = rng.choice(starts, size=48)
        generator, self._generator = self._generator, torch.Generator().manual_seed(5)
        loss = float(self._loss(self._tiers[0], learnt, offset, starts, None))
        self._generator = generator
        return loss

    def _loss(
        self, tier: FileTier, learnt: Tensor, offset: Tensor, starts: NDArray[np.int64], chain: _Chains | None
    ) -> Tensor:
        corpus, rows = self._corpus, len(starts)
        motion = corpus.known_motion(starts)
        embedding = torch.cat([learnt, self._wave_numbers]).expand(rows, -1)
        begun = torch.from_numpy(starts)
        # One offset for all recordings, or one for each.
        phase = corpus.turns[begun] + (offset if offset.dim() == 1 else offset[corpus.owner[begun]])
        segment = corpus.stretch(corpus.unit, starts, 0, SEGMENT_SAMPLES)
        log_level = corpus.log_level[torch.from_numpy(starts)].unsqueeze(1)
        recorded = corpus.stretch(corpus.wave_mps2, starts, SEGMENT_SAMPLES, 0)
        recorded = (recorded * torch.exp(-log_level)).clamp(-_PREVIOUS_LIMIT, _PREVIOUS_LIMIT)
        past, own = recorded, 0
        if chain is not None:
            own = len(chain.starts)
            lived = (chain.past * torch.exp(-log_level[-own:])).clamp(-_PREVIOUS_LIMIT, _PREVIOUS_LIMIT)
            past = torch.cat([recorded[:-own], lived])
            empty = torch.rand(rows, 1, generator=self._generator) < _EMPTY_PAST_SHARE
            past = past.masked_fill(empty, 0.0)
        noise = torch.randn(2 * rows, 1, SEGMENT_SAMPLES, generator=self._generator)
        twice = [torch.cat([part, part]) for part in (past.unsqueeze(1), embedding, motion, phase)]
        drawn = tier.segment(noise, *twice).squeeze(1)
        if chain is not None:
            with torch.no_grad():
                chain.advance(drawn[rows - own : rows] * torch.exp(log_level[-own:]))
        first, second = drawn.chunk(2)
        all_spectra = [spectra(recorded, segment), *halves_of(spectra(torch.cat([past, past]), drawn))]
        own_shapes = [part.chunk(2) for part in envelopes(torch.cat([past, past]), drawn)]
        shapes = [envelopes(recorded, segment), *zip(*own_shapes, strict=True)]
        loss = energy_score(all_spectra[0], (all_spectra[1], all_spectra[2]), spectral_distance)
        loss = loss + energy_score(shapes[0], (list(shapes[1]), list(shapes[2])), envelope_distance)
        followed = energy_score(segment, (first, second), sample_distance)
        if own:
            # Rows that continue their own past have no recorded samples to agree with.
            followed = torch.cat([followed[:-own], torch.zeros(own)])
        if self._comb is not None:
            partials, _ = self._comb.profile(embedding, motion, phase, torch.stack([segment, first, second], dim=1))
            lines = partials.unbind(dim=1)
            loss = loss + _LINE_WEIGHT * energy_score(lines[0], (lines[1], lines[2]), line_distance)
        loud = recorded.square().mean(dim=1).div(4.0).clamp(min=1.0).rsqrt()
        return (loud * (loss + followed)).sum() / loud.sum()
