"""The level error of a finished network for each label, in closed loop.

The level model is fitted to recordings, the network to the shape of their waveforms. Together, in closed loop, they
miss the recorded level by a tenth or two of a decibel, differently for each label. The error is measured here so that
the exported level model can be shifted by it. A shift of the level scales the closed loop's output and changes nothing
else, because the previous waveform is divided by the level.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import torch
from numpy.typing import NDArray
from tqdm import tqdm

from haptoflow_training.export.exponents import LabelExponents, fit_exponents
from haptoflow_training.export.level_table import LevelTable, MeasuredLevels, bin_speed_mps, speed_bins, table_through
from haptoflow_training.export.trained_tier import TrainedTier, load_tiers
from haptoflow_training.models.level_model import scaled_previous
from haptoflow_training.preprocessing.store import SegmentStore, StoredRecording
from haptoflow_training.training.batches import HeldOut
from haptoflow_training.training.closed_loop import (
    UPDATE_RATE_HZ, SegmentSource, SurfaceStatistics, hop_positions, run_closed_loop
)

if TYPE_CHECKING:
    from haptoflow_training.training.recordings_source import Source

_Floats = NDArray[np.float32]

_RECORDINGS_PER_LABEL = 24
_SEED = 17
_WINDOW_SAMPLES = 200
# The loop starts from silence, while a recording may start in the middle of a stroke.
_SETTLING_WINDOWS = 2
_SPEED_BORDERS_MPS = (0.02, 0.05, 0.1, 0.2, 0.4, 0.8, 1.6)
_MINIMUM_WINDOWS = 10


# From label indices [n] and specimens [n], -1 for the label itself, to embeddings [n, 64].
EmbeddingOf = Callable[[NDArray[np.int64], NDArray[np.int64]], _Floats]


@dataclass(frozen=True)
class Extent:
    """How much is compared: recordings of each label, and the samples of each recording from its beginning (None for
    all)."""

    recordings_per_label: int = _RECORDINGS_PER_LABEL
    longest_samples: int | None = None


@dataclass(frozen=True)
class ClosedLoopLevels:
    """Windows of 0.1 s. powers [n, 2]: generated and recorded mean square, (m/s^2)^2; speeds_mps, forces_newtons
    [n]; owners [n]: label indices; specimens [n]: the recorded pieces, -1 where none is known."""

    powers: NDArray[np.float64]
    speeds_mps: NDArray[np.float64]
    forces_newtons: NDArray[np.float64]
    owners: NDArray[np.int64]
    specimens: NDArray[np.int64]


def hops(store: SegmentStore, extent: Extent = Extent()) -> int:
    """The number of hops that `closed_loop_levels` renders, for a progress bar."""
    longest = max(_length(recording, extent) for recording in _chosen(store, extent))
    return len(hop_positions(longest, UPDATE_RATE_HZ))


def offsets_db(levels: ClosedLoopLevels, labels: int) -> list[float]:
    """For each label, the generated level over the recorded level in dB; 0 where too little was recorded. It is the
    mean over classes of speed (borders from 20 mm/s to 1.6 m/s), so that a speed that is recorded often does not weigh
    more than another, and within a class over specimens, in dB: a label is the mean of its pieces, not the loudest."""
    classes = np.digitize(levels.speeds_mps, _SPEED_BORDERS_MPS)
    owned = [levels.owners == label for label in range(labels)]
    return [_offset_db(levels.powers[own], classes[own], levels.specimens[own]) for own in owned]


def closed_loop_levels(
    source: SegmentSource,
    embeddings: _Floats,
    store: SegmentStore,
    statistics: SurfaceStatistics,
    held_out: HeldOut,
    advance: Callable[[int], None] = lambda count: None,
    extent: Extent = Extent(),
    labels_wanted: frozenset[int] | None = None,
    embedding_of: EmbeddingOf | None = None,
) -> ClosedLoopLevels:
    """The levels that `source` generates for the motion of training recordings in closed loop at 72 Hz, with the
    recorded ones. embeddings [labels, 64]; statistics: of the surfaces, by label. labels_wanted: only
    these label indices; None for all. embedding_of: so that each recording is compared with a render of its own
    specimen; None to compare all with their label.

    Recordings of the test split are not used, and windows with a sample in a held-out band are not compared.
    """
    chosen = [one for one in _chosen(store, extent) if labels_wanted is None or one.label_index in labels_wanted]
    longest = max(_length(recording, extent) for recording in chosen)
    motions = np.stack([_padded(store.motion[_span(recording, extent)], longest) for recording in chosen])
    labels = np.array([recording.label_index for recording in chosen])
    specimens = np.array([_specimen_of(recording) for recording in chosen])
    run = run_closed_loop(
        source, embeddings, motions, labels, statistics, update_rate_hz=UPDATE_RATE_HZ, seed=_SEED, advance=advance,
        own_embeddings=None if embedding_of is None else embedding_of(labels, specimens),
    )  # fmt: skip
    made, recorded_powers, speeds, forces, owners, pieces = [], [], [], [], [], []
    for recording, specimen, wave in zip(chosen, specimens, run.waves, strict=True):
        recorded = store.waveform[_span(recording, extent)] * store.peak_mps2
        motion = store.motion[_span(recording, extent)]
        count = len(motion) // _WINDOW_SAMPLES
        held = held_out.holds(motion[: count * _WINDOW_SAMPLES]).reshape(count, _WINDOW_SAMPLES).any(axis=1)
        compared = np.flatnonzero(~held[_SETTLING_WINDOWS:]) + _SETTLING_WINDOWS
        for values, into in ((wave, made), (recorded, recorded_powers)):
            windows = values[: count * _WINDOW_SAMPLES].reshape(count, _WINDOW_SAMPLES)
            into.append(np.square(windows, dtype=np.float64).mean(axis=1)[compared])
        speed = np.hypot(motion[:, 0], motion[:, 1])[: count * _WINDOW_SAMPLES].reshape(count, _WINDOW_SAMPLES)
        speeds.append(speed.mean(axis=1)[compared])
        forces.append(motion[: count * _WINDOW_SAMPLES, 2].reshape(count, _WINDOW_SAMPLES).mean(axis=1)[compared])
        owners.append(np.full(len(speeds[-1]), recording.label_index))
        pieces.append(np.full(len(speeds[-1]), specimen))
    return ClosedLoopLevels(
        np.stack([np.concatenate(made), np.concatenate(recorded_powers)], axis=1),
        np.concatenate(speeds),
        np.concatenate(forces),
        np.concatenate(owners),
        np.concatenate(pieces),
    )


def _offset_db(powers: NDArray[np.float64], classes: NDArray[np.int64], specimens: NDArray[np.int64]) -> float:
    """The mean level difference in dB. powers [n, 2]: generated and recorded, one row for each window."""
    by_class = []
    for speed_class in range(1, len(_SPEED_BORDERS_MPS)):
        ratios = []
        for specimen in np.unique(specimens):
            inside = powers[(classes == speed_class) & (specimens == specimen)]
            if len(inside) >= _MINIMUM_WINDOWS and inside[:, 1].sum() > 0.0:
                generated, recorded = inside.sum(axis=0)
                ratios.append(10.0 * np.log10((generated + 1e-12) / recorded))
        if ratios:
            by_class.append(np.mean(ratios))
    return float(np.mean(by_class)) if by_class else 0.0


def _specimen_of(recording: StoredRecording) -> int:
    return -1 if recording.specimen is None else recording.specimen


def _chosen(store: SegmentStore, extent: Extent) -> list[StoredRecording]:
    """The same number of recordings for each label, spread evenly over its specimens and what there is of each."""
    chosen = []
    for label in range(len(store.labels)):
        own = [entry for entry in store.recordings if entry.label_index == label and entry.split != "test"]
        # Protocols repeat their specimens in cycles, and every fourth of them would meet two pieces of eight.
        own.sort(key=_specimen_of)
        places = np.linspace(0, len(own) - 1, min(len(own), extent.recordings_per_label)).round().astype(int)
        chosen += [own[place] for place in places]
    return chosen


def _length(recording: StoredRecording, extent: Extent) -> int:
    return recording.length if extent.longest_samples is None else min(recording.length, extent.longest_samples)


def _span(recording: StoredRecording, extent: Extent) -> slice:
    return slice(recording.start, recording.start + _length(recording, extent))


def _padded(motion: _Floats, samples: int) -> _Floats:
    return np.pad(motion, ((0, samples - len(motion)), (0, 0)), mode="edge")


class TierSource:
    """A trained tier as a source of segments, without the engine: calibration runs before the model file exists.
    tables: level tables by label index."""

    def __init__(self, tier: TrainedTier, tables: Mapping[int, LevelTable] | None = None) -> None:
        self._tier = tier
        self.pasts, self.noise_before = tier.model.pasts, tier.model.noise_before
        self.embeddings: _Floats = tier.model.embedding.weight.detach().numpy()
        self._tables = {self.embeddings[label].tobytes(): table for label, table in (tables or {}).items()}

    @torch.no_grad()
    def embedding_of(self, labels: NDArray[np.int64], specimens: NDArray[np.int64]) -> _Floats:
        """As `EmbeddingOf`."""
        embedding: _Floats = self._tier.model.embedding(torch.from_numpy(labels), torch.from_numpy(specimens)).numpy()
        return embedding

    @torch.no_grad()
    def generate(
        self, embeddings: _Floats, motions: _Floats, previous_mps2: _Floats, noise: _Floats, phases: _Floats
    ) -> _Floats:
        """As SegmentSource."""
        model, tier = self._tier.model, self._tier
        embedding, motion = torch.from_numpy(embeddings), torch.from_numpy(motions)
        log_level = model.level(embedding, motion)
        for row, own in enumerate(embeddings if self._tables else ()):
            table = self._tables.get(np.ascontiguousarray(own).tobytes())
            if table is not None:
                speed = float(np.hypot(motions[row, 0], motions[row, 1]))
                log_level[row, 0] = float(table.log_level(speed, motions[row, 2]))
        previous = model.encode(scaled_previous(torch.from_numpy(previous_mps2), log_level))
        drawn = model.start(torch.from_numpy(noise).unsqueeze(1))
        condition = previous, embedding, motion, torch.from_numpy(phases)
        made = tier.generate(drawn, condition, tier.solver, tier.steps)
        segments: _Floats = (model.decode(made) * log_level.exp().unsqueeze(-1)).numpy()
        return segments


# The smallest perceptible change of a vibration's amplitude is 2.2 to 2.5 dB.
FELT_DB = 2.5
_MINIMUM_WINDOWS_OF_A_SPEED = 8
_MINIMUM_SPEED_MPS = 0.005
_ROUNDS = 2
_NATURAL_PER_DB = math.log(10.0) / 20.0

Measure = Callable[[Mapping[int, LevelTable]], ClosedLoopLevels]


def level_tables(
    levels: ClosedLoopLevels, exponents: Mapping[int, LabelExponents], measure: Measure
) -> dict[int, LevelTable]:
    """Level tables by label index, for the labels that need one. levels: measured with the level model alone.
    exponents: of every label. measure: measures the labels that have tables, with these tables."""
    labels = len(exponents)
    offsets = offsets_db(levels, labels)
    tables: dict[int, LevelTable] = {}
    for label in range(labels):
        bins, recorded, excess = _by_speed(levels, label, exponents[label])
        if len(bins) >= 2 and np.abs(excess - offsets[label]).max() > FELT_DB:
            tables[label] = _table(levels, label, bins, recorded, exponents[label])
    for _ in range(_ROUNDS if tables else 0):
        measured = measure(tables)
        tables = {label: _corrected(table, measured, label, exponents[label]) for label, table in tables.items()}
    return tables


def _by_speed(
    levels: ClosedLoopLevels, label: int, exponents: LabelExponents
) -> tuple[NDArray[np.int64], NDArray[np.float64], NDArray[np.float64]]:
    """Bins of speed with enough windows; natural log of the recorded RMS at the label's median force in each bin;
    and by how many decibels more was generated."""
    own = (levels.owners == label) & (levels.speeds_mps > _MINIMUM_SPEED_MPS) & (levels.forces_newtons > 0.02)
    bins = speed_bins(levels.speeds_mps[own])
    powers = levels.powers[own] + 1e-8
    force = np.log(levels.forces_newtons[own] / _usual_force(levels, label))
    at_usual_force = powers[:, 1] * np.exp(-2.0 * exponents.level_force * force)
    numbers, counts = np.unique(bins, return_counts=True)
    numbers = numbers[counts >= _MINIMUM_WINDOWS_OF_A_SPEED]
    recorded = np.array([0.5 * math.log(float(at_usual_force[bins == number].mean())) for number in numbers])
    excess = [10.0 * math.log10(float(np.divide(*powers[bins == number].sum(axis=0)))) for number in numbers]
    return numbers, recorded, np.array(excess)


def _usual_force(levels: ClosedLoopLevels, label: int) -> float:
    own = (levels.owners == label) & (levels.speeds_mps > _MINIMUM_SPEED_MPS) & (levels.forces_newtons > 0.02)
    return float(np.clip(np.median(levels.forces_newtons[own]), 0.05, 50.0))


def _table(
    levels: ClosedLoopLevels,
    label: int,
    bins: NDArray[np.int64],
    log_levels: NDArray[np.float64],
    exponents: LabelExponents,
) -> LevelTable:
    return table_through(
        np.array([bin_speed_mps(int(number)) for number in bins]),
        log_levels,
        force_newtons=_usual_force(levels, label),
        force_exponent=exponents.level_force,
        speed_exponent=exponents.level_speed,
    )


def _corrected(table: LevelTable, measured: ClosedLoopLevels, label: int, exponents: LabelExponents) -> LevelTable:
    """The table, lowered by the level error that is still measured at each speed."""
    bins, _, excess = _by_speed(measured, label, exponents)
    speeds = np.array([bin_speed_mps(int(number)) for number in bins])
    levels = table.log_level(speeds, table.force_newtons) - _NATURAL_PER_DB * excess
    return _table(measured, label, bins, levels, exponents)


def measured_levels(folder: Path, source: Source, extent: Extent = Extent()) -> MeasuredLevels:
    """Measure the finished run in `folder`. Tables are made only for recordings from folders: the levels of
    synthetic recordings follow the law by construction."""
    torch.set_num_threads(1)
    tier = load_tiers([folder])[0]
    held_out = HeldOut.of(tier.config.batch)
    statistics = SurfaceStatistics.of_labels(source.labels)

    def measure(tables: Mapping[int, LevelTable]) -> ClosedLoopLevels:
        made = TierSource(tier, tables)
        wanted = frozenset(tables) or None
        with tqdm(total=hops(source.store, extent), unit="hop", desc="levels") as bar:
            return closed_loop_levels(
                made, made.embeddings, source.store, statistics, held_out, bar.update, extent, wanted, made.embedding_of
            )

    levels = measure({})
    offsets = offsets_db(levels, len(source.labels))
    if tier.config.data.source != "folders":
        return MeasuredLevels(offsets)
    exponents = {
        row: fit_exponents(source.store, row, periodic=info.periodic, seed=tier.config.seed, held_out=held_out)
        for row, info in enumerate(source.labels)
    }
    return MeasuredLevels(offsets, level_tables(levels, exponents, measure))


def seconds_of_a_measurement(tier: TrainedTier, source: Source, extent: Extent) -> float:
    """How long one round of `measured_levels` takes, in seconds, estimated from a few of its hops."""
    torch.set_num_threads(1)
    made = TierSource(tier)
    few = Extent(extent.recordings_per_label, _TRIED_SAMPLES)
    begun = time.monotonic()
    statistics = SurfaceStatistics.of_labels(source.labels)
    closed_loop_levels(made, made.embeddings, source.store, statistics, HeldOut.of(tier.config.batch), extent=few)
    return (time.monotonic() - begun) * hops(source.store, extent) / hops(source.store, few)


_TRIED_SAMPLES = 600


def by_label(measured: MeasuredLevels, source: Source) -> dict[str, Any]:
    """The measured levels as export.json states them; empty where none were measured."""
    if measured.offsets_db is None:
        return {}
    names = [info.name for info in source.labels]
    described: dict[str, Any] = {
        "level_offsets_db": {name: round(offset, 3) for name, offset in zip(names, measured.offsets_db, strict=True)}
    }
    if measured.tables:
        described["level_tables"] = [names[row] for row in measured.tables]
    return described
