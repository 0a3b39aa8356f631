"""Measures one row of the evaluation: a generator in both protocols, condition by condition."""

from __future__ import annotations

import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from haptoflow_benchmark.label_discrimination import LabelClassifier, concatenate, window_features
from haptoflow_benchmark.waveform_metrics import level_error_db
from haptoflow_paper.report import row_metrics
from haptoflow_paper.report.cell_figures import SETTLING_SAMPLES, measure_cell
from haptoflow_paper.report.told_apart import told_apart_percent
from haptoflow_paper.rows.closed_loop import closed_loop
from haptoflow_paper.rows.engine_generator import EngineGenerator
from haptoflow_paper.rows.reference_conditions import is_on_other_label
from haptoflow_paper.rows.reference_set import ReferencePair, known_phases
from haptoflow_training.training.closed_loop import hop_positions
from haptoflow_training.waveform import SAMPLE_RATE_HZ

_Floats = NDArray[np.float32]
# The largest number of recordings in a batch. All are padded to the longest, so large batches generate many unused
# segments, and they are no faster per segment.
_MAXIMUM_ROWS = 32


@dataclass(frozen=True)
class GeneratedSet:
    """closed: one closed-loop waveform for each pair; opened: segments from true previous waveforms, concatenated,
    or empty, as for a change of label."""

    closed: list[_Floats]
    opened: list[_Floats]
    hop_starts: list[NDArray[np.int64]]


def generate_set(
    generator: EngineGenerator,
    pairs: Sequence[ReferencePair],
    *,
    update_rate_hz: float,
    seed: int,
    open_loop: bool = True,
) -> GeneratedSet:
    """Run every pair's motion through the generator. Pairs of similar length share a batch."""
    closed: list[_Floats] = [np.zeros(0, dtype=np.float32)] * len(pairs)
    opened: list[_Floats] = [np.zeros(0, dtype=np.float32)] * len(pairs)
    starts: list[NDArray[np.int64]] = [np.zeros(0, dtype=np.int64)] * len(pairs)
    order = sorted(range(len(pairs)), key=lambda index: len(pairs[index].recorded))
    for first in range(0, len(order), _MAXIMUM_ROWS):
        rows = order[first : first + _MAXIMUM_ROWS]
        longest = max(len(pairs[row].recorded) for row in rows)
        motions = np.stack(
            [np.pad(pairs[row].motion, ((0, longest - len(pairs[row].motion)), (0, 0)), mode="edge") for row in rows]
        )
        chosen = np.array([pairs[row].condition.label_index for row in rows])
        others = np.array([_other_label(pairs[row]) for row in rows])
        hops = hop_positions(longest, update_rate_hz)
        elsewhere = np.array([pairs[row].condition.kind == "change" for row in rows])
        is_other = elsewhere[:, None] & is_on_other_label(longest)[hops][None, :]
        labels = np.where(is_other, others[:, None], chosen[:, None])
        run = closed_loop(generator, motions, labels, update_rate_hz=update_rate_hz, seed=seed + first)
        for place, row in enumerate(rows):
            length = len(pairs[row].recorded)
            closed[row] = run.waves[place, :length]
            starts[row] = run.hop_starts[run.hop_starts < length]
            if open_loop and not elsewhere[place]:
                opened[row] = open_loop_wave(generator, int(chosen[place]), pairs[row], seed=seed + row)
    return GeneratedSet(closed, opened, starts)


def _other_label(pair: ReferencePair) -> int:
    """The other label of a change; elsewhere the label itself."""
    other = pair.condition.other_index
    return other if other >= 0 else pair.condition.label_index


def open_loop_wave(generator: EngineGenerator, label: int, pair: ReferencePair, *, seed: int) -> _Floats:
    """Segments end to end, each generated from the true waveform before it (the paper's protocol); the first 200
    samples, which have none, are left out."""
    embedding = generator.embeddings[label]
    count = len(pair.recorded) // 200 - 1
    previous = pair.recorded[: count * 200].reshape(count, 200)
    motion = pair.motion[: count * 200].reshape(count, 200, 3)[:, -28:].mean(axis=1)
    noise = np.random.default_rng(seed).standard_normal((count, 200)).astype(np.float32)
    phases = known_phases(pair, embedding, 200 * np.arange(1, count + 1))
    condition_embeddings = np.tile(embedding, (count, 1))
    return generator.generate(condition_embeddings, motion.astype(np.float32), previous, noise, phases).reshape(-1)


def measure(pairs: Sequence[ReferencePair], made: GeneratedSet) -> list[dict[str, Any]]:
    """Every figure of every pair, one cell for each."""
    told_apart = told_apart_percent(pairs, made.closed)
    cells = []
    for pair, closed, opened, starts, percent in zip(
        pairs, made.closed, made.opened, made.hop_starts, told_apart, strict=True
    ):
        cell = measure_cell(pair, closed, opened, starts)
        cells.append(cell if percent is None else {**cell, "told_apart_percent": percent})
    return cells


@dataclass(frozen=True)
class Yardstick:
    """The references that all rows are compared with. classifier: trained on the independent recordings."""

    pairs: list[ReferencePair]
    classifier: LabelClassifier
    checksum: int


def make_yardstick(pairs: list[ReferencePair]) -> Yardstick:
    """Train the classifier and fingerprint the recordings, once for all rows."""
    training: dict[str, list[Any]] = {}
    for pair in pairs:
        if pair.condition.kind != "change":
            training.setdefault(pair.condition.label, []).append(window_features(pair.independent, pair.motion))
    classifier = LabelClassifier({label: concatenate(parts) for label, parts in training.items()})
    # Of levels to a tenth of a decibel: the last bits of a recording differ from processor to processor.
    levels = [level_error_db(pair.recorded, np.ones(1)) for pair in pairs]
    return Yardstick(pairs, classifier, zlib.crc32(np.round(10.0 * np.array(levels)).astype(np.int32).tobytes()))


def every_fourth(pairs: Sequence[ReferencePair]) -> list[ReferencePair]:
    """A quarter of the pairs, another quarter for each label, so that over the labels every condition counts alike."""
    places: dict[int, int] = {}
    chosen = []
    for pair in pairs:
        label = pair.condition.label_index
        place = places.get(label, 0)
        places[label] = place + 1
        if (place + label) % 4 == 0:
            chosen.append(pair)
    return chosen


def label_discrimination(classifier: LabelClassifier, pairs: Sequence[ReferencePair], waves: Sequence[_Floats]) -> float:
    """Share of waveforms, one for each pair of one label, that the classifier assigns to their own label."""
    right, asked = 0, 0
    for pair, wave in zip(pairs, waves, strict=True):
        if pair.condition.kind == "change":
            continue
        features = window_features(wave, pair.motion)
        if len(features):
            right += classifier.name(features) == pair.condition.label
            asked += 1
    return right / max(1, asked)


def drift_db_per_minute(
    generator: EngineGenerator,
    labels: NDArray[np.int64],
    *,
    seconds: float,
    update_rate_hz: float,
    seed: int,
) -> tuple[float, float]:
    """(median, worst) over these label indices of the absolute drift at 0.15 m/s and 1 N."""
    samples = int(seconds * SAMPLE_RATE_HZ)
    motion = np.array([0.15, 0.0, 1.0], dtype=np.float32)
    motions = np.broadcast_to(motion, (len(labels), samples, 3))
    run = closed_loop(generator, motions, labels, update_rate_hz=update_rate_hz, seed=seed)
    drifts = [abs(row_metrics.drift_db_per_minute(wave[SETTLING_SAMPLES:])) for wave in run.waves]
    return float(np.median(drifts)), float(np.max(drifts))
