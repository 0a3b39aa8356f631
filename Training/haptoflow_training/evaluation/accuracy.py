"""One row of the evaluation: a generator through both protocols, condition by condition, then summed up."""

from __future__ import annotations

import zlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.evaluation import metrics
from haptoflow_training.evaluation.closed_loop import SAMPLE_RATE_HZ, SegmentSource, hop_positions, run_closed_loop
from haptoflow_training.evaluation.label_classifier import LabelClassifier, concatenate, window_features
from haptoflow_training.evaluation.reference_set import ReferencePair

_Floats = NDArray[np.float32]
# The loop starts from silence; what it needs to swing in is not what is asked about.
_SETTLING_SAMPLES = 400
_MAXIMUM_ROWS = 256
_BOOTSTRAP_DRAWS = 500


@dataclass(frozen=True)
class GeneratedSet:
    """closed: one closed-loop wave for each pair; opened: segments from true previous waveforms, joined, or empty."""

    closed: list[_Floats]
    opened: list[_Floats]
    hop_starts: list[NDArray[np.int64]]


def generate_set(
    source: SegmentSource,
    embeddings: _Floats,
    pairs: Sequence[ReferencePair],
    *,
    update_rate_hz: float,
    seed: int,
    advance: Callable[[int], None] = lambda count: None,
    open_loop: bool = True,
) -> GeneratedSet:
    """Run every pair's motion through `source`; embeddings [labels, 64] by label index.

    Pairs of similar length share a batch.
    """
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
        chosen = np.stack([embeddings[pairs[row].condition.label_index] for row in rows])
        run = run_closed_loop(
            source, chosen, motions, update_rate_hz=update_rate_hz, seed=seed + first, advance=advance
        )
        for place, row in enumerate(rows):
            length = len(pairs[row].recorded)
            closed[row] = run.waves[place, :length]
            starts[row] = run.hop_starts[run.hop_starts < length]
            if open_loop:
                opened[row] = open_loop_wave(source, chosen[place], pairs[row], seed=seed + row)
    return GeneratedSet(closed, opened, starts)


def open_loop_wave(source: SegmentSource, embedding: _Floats, pair: ReferencePair, *, seed: int) -> _Floats:
    """Segments end to end, each from the true waveform before it (the paper's protocol); the first 200 samples, which
    have none, are left out."""
    count = len(pair.recorded) // 200 - 1
    previous = pair.recorded[: count * 200].reshape(count, 200)
    motion = pair.motion[: count * 200].reshape(count, 200, 3)[:, -28:].mean(axis=1)
    noise = np.random.default_rng(seed).standard_normal((count, 200)).astype(np.float32)
    return source.generate(np.tile(embedding, (count, 1)), motion.astype(np.float32), previous, noise).reshape(-1)


def measure(pairs: Sequence[ReferencePair], made: GeneratedSet) -> list[dict[str, Any]]:
    """Every metric of every pair."""
    return [
        _measure_pair(pair, closed, opened, starts)
        for pair, closed, opened, starts in zip(pairs, made.closed, made.opened, made.hop_starts, strict=True)
    ]


def _measure_pair(
    pair: ReferencePair, closed: _Floats, opened: _Floats, hop_starts: NDArray[np.int64]
) -> dict[str, Any]:
    generated, recorded = closed[_SETTLING_SAMPLES:], pair.recorded[_SETTLING_SAMPLES:]
    segments = opened if len(opened) else closed[200:]
    truth = pair.recorded[200 : 200 + len(segments)]
    condition = pair.condition
    result: dict[str, Any] = {
        "label": condition.label,
        "kind": condition.kind,
        "speed_mps": condition.speed_mps,
        "force_newtons": condition.force_newtons,
        "level_error_db": metrics.level_error_db(generated, recorded),
        "gfc_recording": metrics.gfc_recording(generated, recorded),
        "gfc_segment": metrics.gfc_segment(segments, truth),
        "rmse": metrics.relative_rmse(segments, truth),
        "lsd_db": metrics.log_spectral_distance_db(generated, recorded),
        "band_errors_db": metrics.critical_band_errors_db(generated, recorded).tolist(),
        "continuity": metrics.hop_jump_ratio(generated, hop_starts - _SETTLING_SAMPLES) if len(hop_starts) else None,
    }
    if condition.expected_fundamental_hz and metrics.rms(generated) > 0.0:
        truth_hz = metrics.fundamental_hz(recorded, condition.expected_fundamental_hz)
        made_hz = metrics.fundamental_hz(generated, condition.expected_fundamental_hz)
        result["f0_error_percent"] = 100.0 * abs(made_hz / truth_hz - 1.0)
        result["harmonic_share"] = metrics.harmonic_share(generated, truth_hz) / (
            metrics.harmonic_share(recorded, truth_hz) + 1e-9
        )
    return result


@dataclass(frozen=True)
class Yardstick:
    """What every row is held against. classifier: trained on the independent recordings."""

    pairs: list[ReferencePair]
    classifier: LabelClassifier
    checksum: int


def make_yardstick(pairs: list[ReferencePair]) -> Yardstick:
    """Train the classifier and fingerprint the recordings, once for all rows."""
    training: dict[str, list[Any]] = {}
    for pair in pairs:
        training.setdefault(pair.condition.label, []).append(window_features(pair.independent, pair.motion))
    classifier = LabelClassifier({label: concatenate(parts) for label, parts in training.items()})
    return Yardstick(pairs, classifier, zlib.crc32(b"".join(pair.recorded.tobytes() for pair in pairs)))


def every_fourth(pairs: Sequence[ReferencePair]) -> list[ReferencePair]:
    """A quarter of the pairs: of each label another quarter, so that over the labels every condition counts alike."""
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
    """Share of waves, one for each pair, that the classifier gives their own label."""
    right, asked = 0, 0
    for pair, wave in zip(pairs, waves, strict=True):
        features = window_features(wave, pair.motion)
        if len(features):
            right += classifier.name(features) == pair.condition.label
            asked += 1
    return right / max(1, asked)


def drift_db_per_minute(
    source: SegmentSource,
    embeddings: _Floats,
    *,
    seconds: float,
    update_rate_hz: float,
    seed: int,
    advance: Callable[[int], None] = lambda count: None,
) -> tuple[float, float]:
    """(median, worst) over labels of the absolute drift at 0.15 m/s and 1 N."""
    samples = int(seconds * SAMPLE_RATE_HZ)
    motion = np.array([0.15, 0.0, 1.0], dtype=np.float32)
    motions = np.broadcast_to(motion, (len(embeddings), samples, 3))
    run = run_closed_loop(source, embeddings, motions, update_rate_hz=update_rate_hz, seed=seed, advance=advance)
    drifts = [abs(metrics.drift_db_per_minute(wave[_SETTLING_SAMPLES:])) for wave in run.waves]
    return float(np.median(drifts)), float(np.max(drifts))


def hops_of(pairs: Sequence[ReferencePair], update_rate_hz: float) -> int:
    """Closed-loop hops that `generate_set` makes: what its progress counts."""
    lengths = sorted(len(pair.recorded) for pair in pairs)
    batches = [lengths[first : first + _MAXIMUM_ROWS] for first in range(0, len(lengths), _MAXIMUM_ROWS)]
    return sum(len(hop_positions(batch[-1], update_rate_hz)) for batch in batches)


def summary(rows: Sequence[dict[str, Any]], seed: int = 0) -> dict[str, Any]:
    """Medians over labels of each label's mean, tails over conditions, 95 % bootstrap intervals over recordings."""
    result: dict[str, Any] = {}
    for key in ("level_error_db", "gfc_recording", "gfc_segment", "rmse", "lsd_db", "continuity"):
        _add(result, key, rows, seed)
    result["level_error_p90_db"] = level_error_p90_db(rows)
    result["level_error_worst_db"] = float(np.max(np.abs([row["level_error_db"] for row in rows])))
    result["band_error_db"] = float(np.median(np.abs([row["band_errors_db"] for row in rows])))
    result["gfc_label_worst"] = min(float(np.mean(values)) for values in _by_label(rows, "gfc_recording").values())
    periodic = [row for row in rows if "f0_error_percent" in row]
    result["f0_error_percent"] = float(np.median([row["f0_error_percent"] for row in periodic])) if periodic else None
    result["harmonic_share"] = float(np.median([row["harmonic_share"] for row in periodic])) if periodic else None
    return result


def level_error_p90_db(rows: Sequence[dict[str, Any]]) -> float:
    """What the size of the level error of nine in ten recordings stays below."""
    return float(np.quantile(np.abs([row["level_error_db"] for row in rows]), 0.9))


def over_labels(rows: Sequence[dict[str, Any]], key: str) -> float | None:
    """Median over labels of each label's mean; None where no row has the figure."""
    return _median_of_means(_by_label(rows, key))


def _median_of_means(grouped: dict[str, list[float]]) -> float | None:
    return float(np.median([np.mean(values) for values in grouped.values()])) if grouped else None


def _by_label(rows: Sequence[dict[str, Any]], key: str) -> dict[str, list[float]]:
    grouped: dict[str, list[float]] = {}
    for row in rows:
        if row[key] is not None:
            grouped.setdefault(row["label"], []).append(row[key])
    return grouped


def _add(result: dict[str, Any], key: str, rows: Sequence[dict[str, Any]], seed: int) -> None:
    if not _by_label(rows, key):
        result[key] = None
        return
    result[key], *interval = with_interval(rows, key, seed)
    result[f"{key}_interval"] = interval


def with_interval(rows: Sequence[dict[str, Any]], key: str, seed: int = 0) -> tuple[float, float, float]:
    """Median over labels of each label's mean, and the ends of its 95 % bootstrap interval over the label's recordings.
    At least one row has the figure."""
    grouped = _by_label(rows, key)
    generator = np.random.default_rng(seed)
    draws = [
        np.median([np.mean(generator.choice(values, size=len(values))) for values in grouped.values()])
        for _ in range(_BOOTSTRAP_DRAWS)
    ]
    low, high = np.quantile(draws, [0.025, 0.975])
    return float(np.median([np.mean(values) for values in grouped.values()])), float(low), float(high)
