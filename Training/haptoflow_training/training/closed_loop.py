"""Closed-loop rendering: the network runs on its own output, hop after hop, as it does under a stylus."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.models.label_embedding import WAVE_NUMBERS, WAVE_VECTORS
from haptoflow_training.recordings.landing import LabelInfo
from haptoflow_training.recordings.synthetic.features import LIGHTEST_SLIP_NEWTONS, SLIP_FORCE_EXPONENT
from haptoflow_training.waveform import SAMPLE_RATE_HZ, SEGMENT_SAMPLES

_Doubles = NDArray[np.float64]
_FAMILIES = WAVE_VECTORS + 1
_SLIP = WAVE_VECTORS
# A field is a sum of plane waves, whose wavelengths lie within half an octave of the field's.
_WAVES, _OCTAVES = 12, 0.5


@dataclass(frozen=True)
class SurfaceStatistics:
    """By label. slips_per_mm [L]: at 1 N, 0 for none. wander [L, 3]: of both rib families in turns, and of the logarithm
    of the stick-slip's rate; wavelengths_mm [L, 3]: of the fields that they follow."""

    slips_per_mm: _Doubles
    wander: _Doubles
    wavelengths_mm: _Doubles

    @classmethod
    def of_labels(cls, labels: Sequence[LabelInfo]) -> SurfaceStatistics:
        return cls.of_entries(
            [
                {"rib_wander": [asdict(ribs) for ribs in label.rib_wander]}
                | ({} if label.stick_slip is None else {"stick_slip": asdict(label.stick_slip)})
                for label in labels
            ]
        )

    @classmethod
    def of_entries(cls, labels: Sequence[Mapping[str, Any]]) -> SurfaceStatistics:
        """Of the labels of a model file's header (model-format.md)."""
        count = len(labels)
        slips, wander, wavelengths = np.zeros(count), np.zeros((count, _FAMILIES)), np.ones((count, _FAMILIES))
        for row, label in enumerate(labels):
            for family, ribs in enumerate(label.get("rib_wander", ())):
                wander[row, family], wavelengths[row, family] = ribs["turns"], 1e3 * ribs["wavelength_metres"]
            if slip := label.get("stick_slip"):
                slips[row] = 1e-3 / slip["length_metres"]
                wander[row, _SLIP], wavelengths[row, _SLIP] = slip["wander"], 1e3 * slip["wander_metres"]
        return cls(slips, wander, wavelengths)


def phases_of(turns: _Doubles, rates_hz: _Doubles) -> NDArray[np.float32]:
    """Turns and rates [n, 3] as phases [n, 6]."""
    # Rounding could lift a phase just below one turn to 1.
    wrapped = np.mod(np.mod(turns, 1.0).astype(np.float32), np.float32(1.0))
    return np.concatenate([wrapped, rates_hz.astype(np.float32)], axis=1)


class PhaseTrack:
    """Phases [rows, 6] (models/label_embedding.py) along one path a row. Deterministic by its seed."""

    def __init__(self, statistics: SurfaceStatistics, rows: int, seed: int) -> None:
        self._statistics = statistics
        generator = np.random.default_rng([seed, 30])
        shape = rows, _FAMILIES, _WAVES
        angle = generator.uniform(0.0, 2.0 * math.pi, shape)
        stretch = 2.0 ** generator.uniform(-_OCTAVES, _OCTAVES, shape)
        # Cycles in one wavelength of the field, along both axes.
        self._directions = np.stack([np.cos(angle), np.sin(angle)], axis=-1) / stretch[..., None]
        self._offsets = generator.uniform(0.0, 1.0, shape)
        self._place_mm, self._turns = np.zeros((rows, 2)), np.zeros((rows, _FAMILIES))
        self._rates = np.zeros((rows, _FAMILIES))

    def advance(self, motion: NDArray[np.float32], samples: int) -> None:
        """Moves on by so many samples, at the rates of the newest `at`."""
        seconds = samples / SAMPLE_RATE_HZ
        self._place_mm += 1000.0 * seconds * motion[:, :2]
        self._turns = np.mod(self._turns + self._rates * seconds, 1.0)

    def at(
        self, embeddings: NDArray[np.float32], labels: NDArray[np.int64], motion: NDArray[np.float32]
    ) -> NDArray[np.float32]:
        """The phases here under embeddings [rows, 64] of these label indices [rows] and motion [rows, 3]."""
        statistics = self._statistics
        vectors = embeddings[:, -WAVE_NUMBERS:].astype(np.float64).reshape(-1, WAVE_VECTORS, 2)
        velocity_mmps = 1000.0 * motion[:, :2].astype(np.float64)
        field, along = self._field(statistics.wavelengths_mm[labels], velocity_mmps)
        wander = statistics.wander[labels]
        speed = np.hypot(*velocity_mmps.T)
        press = np.maximum(motion[:, 2].astype(np.float64), LIGHTEST_SLIP_NEWTONS) ** SLIP_FORCE_EXPONENT
        slip_rate = speed * statistics.slips_per_mm[labels] / press * np.exp(-wander[:, _SLIP] * field[:, _SLIP])
        self._rates = np.column_stack([np.einsum("rkc,rc->rk", vectors, velocity_mmps), slip_rate])
        turns, rates = self._turns.copy(), self._rates.copy()
        turns[:, :_SLIP] += (wander * field)[:, :_SLIP]
        rates[:, :_SLIP] += (wander * along)[:, :_SLIP]
        return phases_of(turns, rates)

    def _field(self, wavelengths_mm: _Doubles, velocity_mmps: _Doubles) -> tuple[_Doubles, _Doubles]:
        """The smooth fields of RMS 1, [rows, 3], and their change per second along the path."""
        cycles = self._directions / wavelengths_mm[:, :, None, None]
        angle = 2.0 * math.pi * (np.einsum("rfmc,rc->rfm", cycles, self._place_mm) + self._offsets)
        rate = 2.0 * math.pi * np.einsum("rfmc,rc->rfm", cycles, velocity_mmps)
        size = math.sqrt(2.0 / _WAVES)
        return size * np.cos(angle).sum(axis=2), -size * (rate * np.sin(angle)).sum(axis=2)


SPLICE_SAMPLES = 4
UPDATE_RATE_HZ = 72.0
_CORRELATION_SAMPLES = 32

_Floats = NDArray[np.float32]


class SegmentSource(Protocol):
    """Generates segments in m/s^2: the engine, a trained tier, or a reference row of the benchmark.

    `generate` continues `pasts` waveforms, [n, pasts, 200], the one that was played first, and returns as many; [n,
    200] where it is one. Its noise [n, noise_before + 200] begins before the segment.
    """

    pasts: int
    noise_before: int

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
    own_embeddings: _Floats | None = None,
) -> ClosedLoopRun:
    """Renders n waveforms from silence, one for each of `motions` [n, samples, 3]. labels: for each an index into
    `embeddings` [labels, 64], [n]; or [n, hops] where a waveform changes its label. own_embeddings [n, 64]: of each
    waveform's specimen, in place of its label's.

    The condition of each segment is the mean motion of the hop before it, because a tracker knows no more. The phases
    are integrated from the same motions, as in the engine; statistics: of the surfaces, by label. Segments that overlap
    have the same noise there, because in the engine it belongs to the place.
    """
    rows, samples, _ = motions.shape
    # The waveforms are preceded by silence, long enough to be what the first segment continues.
    out = np.zeros((rows, source.pasts, SEGMENT_SAMPLES + samples + SEGMENT_SAMPLES), dtype=np.float32)
    wave = out[:, 0, SEGMENT_SAMPLES:]
    starts = hop_positions(samples, update_rate_hz)
    generator = np.random.default_rng(seed)
    surface_noise = generator.standard_normal((rows, samples + SEGMENT_SAMPLES), dtype=np.float32)
    surface_noise = np.pad(surface_noise, ((0, 0), (source.noise_before, 0)))
    track = PhaseTrack(statistics, rows, seed)
    condition = np.zeros((rows, 3), dtype=np.float32)
    before = 0
    for hop, start in enumerate(starts):
        track.advance(condition, int(start - before))
        label = labels if labels.ndim == 1 else labels[:, hop]
        embedding = embeddings[label] if own_embeddings is None else own_embeddings
        known = motions[:, before:start] if start > before else motions[:, :1]
        past = out[:, :, start : start + SEGMENT_SAMPLES].copy()
        noise = surface_noise[:, start : start + source.noise_before + SEGMENT_SAMPLES].copy()
        condition = known.mean(axis=1).astype(np.float32)
        made = source.generate(embedding, condition, past, noise, track.at(embedding, label, condition))
        made = made.reshape(past.shape)
        if start > 0:
            # What goes on beneath is never spliced: it continues itself.
            made[:, 0] = spliced(wave[:, start : start + SEGMENT_SAMPLES], made[:, 0])
        out[:, :, SEGMENT_SAMPLES + start : 2 * SEGMENT_SAMPLES + start] = made
        before = start
        advance(1)
    return ClosedLoopRun(wave[:, :samples], starts)
