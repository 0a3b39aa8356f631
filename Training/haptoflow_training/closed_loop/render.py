"""Closed-loop rendering: the network runs on its own output, hop after hop, as it does under a stylus."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.closed_loop.phase_track import PhaseTrack, SurfaceStatistics
from haptoflow_training.waveform import SAMPLE_RATE_HZ, SEGMENT_SAMPLES

SPLICE_SAMPLES = 4
UPDATE_RATE_HZ = 72.0
_CORRELATION_SAMPLES = 32

_Floats = NDArray[np.float32]


class SegmentSource(Protocol):
    """Generates segments [n, 200] in m/s^2: the engine, a trained tier, or a reference row of the benchmark."""

    def generate(
        self, embeddings: _Floats, motions: _Floats, previous_mps2: _Floats, noise: _Floats, phases: _Floats
    ) -> _Floats: ...


@dataclass(frozen=True)
class ClosedLoopRun:
    """waves [n, samples] in m/s^2; hop_starts: the sample at which each new segment takes over."""

    waves: _Floats
    hop_starts: NDArray[np.int64]


def hop_positions(samples: int, update_rate_hz: float) -> NDArray[np.int64]:
    """Sample positions of the updates, starting at 0, below `samples`."""
    count = int(np.ceil(samples * update_rate_hz / SAMPLE_RATE_HZ))
    positions = np.floor(np.arange(count) * SAMPLE_RATE_HZ / update_rate_hz + 1e-9).astype(np.int64)
    return positions[positions < samples]


def spliced(continuation: _Floats, successor: _Floats) -> _Floats:
    """The new segment [n, 200], with its first samples crossfaded from the running segment as in the engine's
    splice: gains (1 - a) / k and a / k with k = sqrt((1-a)^2 + a^2 + 2 a (1-a) rho) keep the level constant for any
    correlation rho."""
    one, other = continuation[:, :_CORRELATION_SAMPLES], successor[:, :_CORRELATION_SAMPLES]
    power = np.sqrt((one**2).sum(axis=1) * (other**2).sum(axis=1))
    product = (one * other).sum(axis=1)
    correlation = np.where(power > 1e-20, np.clip(product / np.maximum(power, 1e-20), 0.0, 1.0), 1.0)[:, None]
    progress = (np.arange(SPLICE_SAMPLES) + 1.0) / (SPLICE_SAMPLES + 1.0)
    norm = np.sqrt((1 - progress) ** 2 + progress**2 + 2 * progress * (1 - progress) * correlation)
    result = successor.copy()
    seam = (1 - progress) / norm * continuation[:, :SPLICE_SAMPLES] + progress / norm * successor[:, :SPLICE_SAMPLES]
    result[:, :SPLICE_SAMPLES] = seam
    return result


def run_closed_loop(
    source: SegmentSource,
    embeddings: _Floats,
    motions: _Floats,
    labels: NDArray[np.int64],
    statistics: SurfaceStatistics,
    *,
    update_rate_hz: float,
    seed: int,
    advance: Callable[[int], None] = lambda count: None,
) -> ClosedLoopRun:
    """Renders n waveforms from silence, one for each of `motions` [n, samples, 3]. labels: for each an index into
    `embeddings` [labels, 64], [n]; or [n, hops] where a waveform changes its label.

    The condition of each segment is the mean motion of the hop before it, because a tracker knows no more. The phases
    are integrated from the same motions, as in the engine; statistics: of the surfaces, by label. Segments that overlap
    have the same noise there, because in the engine it belongs to the place.
    """
    rows, samples, _ = motions.shape
    # The waveform is preceded by silence, long enough to be the first segment's previous waveform.
    out = np.zeros((rows, SEGMENT_SAMPLES + samples + SEGMENT_SAMPLES), dtype=np.float32)
    wave = out[:, SEGMENT_SAMPLES:]
    starts = hop_positions(samples, update_rate_hz)
    generator = np.random.default_rng(seed)
    surface_noise = generator.standard_normal((rows, samples + SEGMENT_SAMPLES), dtype=np.float32)
    track = PhaseTrack(statistics, rows, seed)
    condition = np.zeros((rows, 3), dtype=np.float32)
    before = 0
    for hop, start in enumerate(starts):
        track.advance(condition, int(start - before))
        label = labels if labels.ndim == 1 else labels[:, hop]
        embedding = embeddings[label]
        known = motions[:, before:start] if start > before else motions[:, :1]
        past = out[:, start : start + SEGMENT_SAMPLES].copy()
        noise = surface_noise[:, start : start + SEGMENT_SAMPLES].copy()
        condition = known.mean(axis=1).astype(np.float32)
        segment = source.generate(embedding, condition, past, noise, track.at(embedding, label, condition))
        if start > 0:
            segment = spliced(wave[:, start : start + SEGMENT_SAMPLES], segment)
        wave[:, start : start + SEGMENT_SAMPLES] = segment
        before = start
        advance(1)
    return ClosedLoopRun(wave[:, :samples], starts)
