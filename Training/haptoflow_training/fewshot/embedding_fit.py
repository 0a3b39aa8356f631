"""The embedding of a material by gradient through a frozen tier: the energy distance between recording and own output.

Half of every batch follows recorded pasts, half lives on the network's own output and walks on along the recording, so
that what is fitted is what will be heard in closed loop.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor

from haptoflow_training.fewshot.label_prior import LabelPrior
from haptoflow_training.fewshot.level_law import SLOWEST_MPS, LevelLaw
from haptoflow_training.fewshot.material_recording import MaterialRecording
from haptoflow_training.models.file_model import FileModel, FileTier
from haptoflow_training.models.label_embedding import WAVE_NUMBERS, WAVE_VECTORS, rib_phase
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

SEGMENT_SAMPLES = 200
HOP_SAMPLES = 28
_PREVIOUS_LIMIT = 16.0
_EMPTY_PAST_SHARE = 0.05
_LINE_WEIGHT = 2.0
_TRIED_LABELS, _TRIED_OFFSETS = 4, 8


@dataclass(frozen=True)
class EmbeddingFit:
    """embedding [64]; rib_offset [2]: turns to be added to the recording's own rib phase, since a label's profile has its
    own beginning; nearest: index of the label that it started from; start_loss and loss: on the same segments."""

    embedding: NDArray[np.float32]
    rib_offset: tuple[float, float]
    nearest: int
    start_loss: float
    loss: float


@dataclass(frozen=True)
class FitOptions:
    """steps: of the optimiser; rows: segments a step, each drawn twice; pull: weight of the labels' spread."""

    steps: int = 120
    rows: int = 24
    learning_rate: float = 0.06
    pull: float = 0.002


class _Corpus:
    """The recordings end to end, in unit scale: each sample divided by the level of its own moment."""

    def __init__(self, recordings: Sequence[MaterialRecording], level: LevelLaw, seed: int) -> None:
        long_enough = [each for each in recordings if len(each) > 2 * SEGMENT_SAMPLES]
        wave = np.concatenate([each.wave_mps2 for each in long_enough])
        self.motion = torch.from_numpy(np.concatenate([each.motion for each in long_enough]))
        self.position_mm = torch.from_numpy(np.concatenate([each.position_mm for each in long_enough]))
        # The level is smooth: at 100 Hz it is known everywhere.
        knots = np.append(np.arange(0, len(wave), 20), len(wave) - 1)
        log_level = np.interp(np.arange(len(wave)), knots, level.log_level(self.motion.numpy()[knots]))
        self.log_level = torch.from_numpy(log_level.astype(np.float32))
        self.wave_mps2 = torch.from_numpy(wave)
        self.unit = self.wave_mps2 * torch.exp(-self.log_level)
        ends = np.cumsum([len(each) for each in long_enough])
        begins = ends - [len(each) for each in long_enough]
        starts = np.concatenate(
            [np.arange(begin + SEGMENT_SAMPLES, end - SEGMENT_SAMPLES) for begin, end in zip(begins, ends, strict=True)]
        )
        speed = np.hypot(*self.motion.numpy()[starts, :2].T)
        moving = speed > SLOWEST_MPS
        self.starts, speed = (starts[moving], speed[moving]) if moving.any() else (starts, speed)
        self._last = {int(begin): int(end) for begin, end in zip(begins, ends, strict=True)}
        self._limits = np.sort(ends)
        # Evenly over classes of log speed, so that where hands linger counts no more than elsewhere.
        classes = np.floor(2.0 * np.log(speed + 1e-4)).astype(int)
        counts = {each: int((classes == each).sum()) for each in np.unique(classes)}
        share = np.array([1.0 / np.sqrt(counts[each]) for each in classes])
        self._share = share / share.sum()
        self._rng = np.random.default_rng(seed)

    def draw(self, count: int) -> NDArray[np.int64]:
        return self._rng.choice(self.starts, size=count, p=self._share)

    def fits(self, starts: NDArray[np.int64]) -> NDArray[np.bool_]:
        """Whether a segment at each start lies in one recording with the segment before it."""
        end = np.searchsorted(self._limits, starts - 1, side="right")
        return starts + SEGMENT_SAMPLES <= self._limits[np.minimum(end, len(self._limits) - 1)]

    def stretch(self, values: Tensor, starts: NDArray[np.int64], before: int, after: int) -> Tensor:
        index = torch.from_numpy(starts)[:, None] + torch.arange(-before, after)[None, :]
        return values[index]

    def told(self, starts: NDArray[np.int64]) -> Tensor:
        """[B, 3]: the mean motion of the hop before each start, which is all that a tracker can know."""
        return self.stretch(self.motion, starts, HOP_SAMPLES, 0).mean(dim=1)


class _Chains:
    """Rows that live on the network's own output, hop by hop along the recording; past in m/s^2."""

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
    """Fits the 60 learnt numbers of one material; the four wave numbers are given."""

    def __init__(
        self,
        model: FileModel,
        tiers: Sequence[FileTier],
        prior: LabelPrior,
        recordings: Sequence[MaterialRecording],
        level: LevelLaw,
        wave_numbers: NDArray[np.float32],
        *,
        seed: int,
        options: FitOptions = FitOptions(),
    ) -> None:
        self._labels = model.label_embeddings[:, :-WAVE_NUMBERS]
        self._tiers, self._options = tiers, options
        self._corpus = _Corpus(recordings, level, seed)
        self._wave_numbers = torch.from_numpy(np.asarray(wave_numbers, dtype=np.float32))
        self._generator = torch.Generator().manual_seed(seed)
        self._mean = torch.from_numpy(prior.embedding_mean).float()
        self._axes = torch.from_numpy(prior.axes).float()
        self._spreads = torch.from_numpy(prior.spreads).float()
        self._comb = RibComb() if self._wave_numbers.any() else None

    def fit(self, advance: Callable[[], None] = lambda: None) -> EmbeddingFit:
        options, corpus = self._options, self._corpus
        nearest, found_offset, start_loss = self._nearest()
        learnt = self._labels[nearest].clone().requires_grad_()
        offset = found_offset.clone().requires_grad_()
        optimiser = torch.optim.Adam([learnt, offset], lr=options.learning_rate, betas=(0.9, 0.98))
        half = options.rows // 2
        chains = [_Chains(corpus, options.rows - half) for _ in self._tiers]
        average, kept = learnt.detach().clone(), 0.0
        for step in range(options.steps):
            share = step / options.steps
            optimiser.param_groups[0]["lr"] = options.learning_rate * min(1.0, 2.0 * (1.0 - share))
            which = step % len(self._tiers)
            chain = chains[which]
            starts = np.concatenate([corpus.draw(half), chain.starts])
            loss = self._loss(self._tiers[which], learnt, offset, starts, chain) + options.pull * self._distance(learnt)
            optimiser.zero_grad()
            loss.backward()
            torch.nn.utils.clip_grad_norm_([learnt], 2.0)
            optimiser.step()
            if share > 0.5:
                # The mean of the second half: single steps are noisy.
                kept += 1.0
                average += (learnt.detach() - average) / kept
            advance()
        final = average if kept else learnt.detach()
        embedding = torch.cat([final, self._wave_numbers])
        turns = offset.detach() - offset.detach().floor()
        return EmbeddingFit(
            embedding.numpy().copy(),
            (float(turns[0]), float(turns[1])),
            nearest,
            start_loss,
            self._held_loss(final, offset.detach()),
        )

    def _distance(self, learnt: Tensor) -> Tensor:
        """Squared, in standard deviations along the labels' axes, and in the smallest of them off these."""
        offset = learnt - self._mean
        along = self._axes @ offset
        rest = offset - self._axes.t() @ along
        return (along / self._spreads).square().sum() + (rest / self._spreads[-1]).square().sum()

    def _nearest(self) -> tuple[int, Tensor, float]:
        """The label with the smallest loss and, of a ruled surface, the beginning of its profile that fits best."""
        start = torch.zeros(WAVE_VECTORS)
        losses = [self._held_loss(label, start) for label in self._labels]
        ruled = [index for index in range(WAVE_VECTORS) if self._wave_numbers[2 * index : 2 * index + 2].any()]
        order = np.argsort(losses)[: _TRIED_LABELS if ruled else 1]
        best = int(order[0]), start, losses[int(order[0])]
        for label in order:
            offset = start.clone()
            for index in ruled:
                tried = []
                for turns in np.arange(_TRIED_OFFSETS) / _TRIED_OFFSETS:
                    offset[index] = float(turns)
                    tried.append(self._held_loss(self._labels[label], offset))
                offset[index] = float(np.argmin(tried)) / _TRIED_OFFSETS
                if min(tried) < best[2]:
                    best = int(label), offset.clone(), min(tried)
        return best

    @torch.no_grad()
    def _held_loss(self, learnt: Tensor, offset: Tensor) -> float:
        """On segments and noise that are the same for every embedding."""
        rng = np.random.default_rng(5)
        starts = rng.choice(self._corpus.starts, size=48)
        generator, self._generator = self._generator, torch.Generator().manual_seed(5)
        loss = float(self._loss(self._tiers[0], learnt, offset, starts, None))
        self._generator = generator
        return loss

    def _loss(
        self, tier: FileTier, learnt: Tensor, offset: Tensor, starts: NDArray[np.int64], chain: _Chains | None
    ) -> Tensor:
        corpus, rows = self._corpus, len(starts)
        motion = corpus.told(starts)
        embedding = torch.cat([learnt, self._wave_numbers]).expand(rows, -1)
        phase = rib_phase(embedding, corpus.position_mm[torch.from_numpy(starts)]) + offset
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
        heard = [spectra(recorded, segment), *halves_of(spectra(torch.cat([past, past]), drawn))]
        shapes = [envelopes(recorded, segment), *zip(*(part.chunk(2) for part in envelopes(torch.cat([past, past]), drawn)))]
        loss = energy_score(heard[0], (heard[1], heard[2]), spectral_distance)
        loss = loss + energy_score(shapes[0], (list(shapes[1]), list(shapes[2])), envelope_distance)
        followed = energy_score(segment, (first, second), sample_distance)
        if own:
            # Rows that follow a past of their own have no samples to agree in.
            followed = torch.cat([followed[:-own], torch.zeros(own)])
        if self._comb is not None:
            partials, _ = self._comb.profile(embedding, motion, phase, torch.stack([segment, first, second], dim=1))
            lines = partials.unbind(dim=1)
            loss = loss + _LINE_WEIGHT * energy_score(lines[0], (lines[1], lines[2]), line_distance)
        loud = recorded.square().mean(dim=1).div(4.0).clamp(min=1.0).rsqrt()
        return (loud * (loss + followed)).sum() / loud.sum()
