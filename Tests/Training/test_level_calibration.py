"""The closed-loop level of a network is measured and corrected, label by label."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest
import torch
from numpy.typing import NDArray

from haptoflow_training.training.level_calibration import (
    ClosedLoopLevels, Extent, TierSource, closed_loop_levels, hops, level_tables, offsets_db
)
from haptoflow_training.export.exponents import LabelExponents, fit_exponents
from haptoflow_training.export.exporter import export_run
from haptoflow_training.export.level_table import LevelTable, MeasuredLevels, table_through
from haptoflow_training.export.model_file import read_model_file
from haptoflow_training.export.trained_tier import TrainedTier, load_tiers
from haptoflow_training.models.skeleton import NOISE_BEFORE
from haptoflow_training.models.level_model import LevelModel, level_loss, shift_level
from haptoflow_training.preprocessing.pipeline import preprocess_recording
from haptoflow_training.recordings.synthetic import load_materials, machine_conditions, record_condition, record_condition_of
from haptoflow_training.recordings.synthetic.materials import select_materials
from haptoflow_training.training.batches import HeldOut
from haptoflow_training.training.config import ModelConfig, TrainingConfig
from haptoflow_training.training.recordings_source import Source
from haptoflow_training.training.trainer import Trainer, build_model
from test_export import INFOS, PROVENANCE
from test_trainer import ALONE, _config
from training_fixtures import (
    RATE_HZ, FakeRecording, FakeStore, level_offsets_db, make_store, still_surfaces, travelled_mm
)

_Floats = NDArray[np.float32]


class _KnownSource:
    """Noise at the store's own level, multiplied by `gain_db` of each label; the embedding's first value identifies
    it."""

    pasts, noise_before = 1, 0

    def __init__(self, gain_db: tuple[float, float]) -> None:
        self._gain = 10.0 ** (np.array(gain_db) / 20.0)

    def generate(
        self, embeddings: _Floats, motions: _Floats, previous_mps2: _Floats, noise: _Floats, phases: _Floats
    ) -> _Floats:
        del previous_mps2
        speed, force = np.hypot(motions[:, 0], motions[:, 1]), motions[:, 2]
        label = embeddings[:, 0].astype(int)
        level = np.where(label == 0, 2.0 * speed * force**0.3, 5.0 * np.sqrt(speed)) * self._gain[label]
        return (noise * level[:, None]).astype(np.float32)


def test_the_level_error_of_a_label_is_measured_in_closed_loop() -> None:
    store = make_store(seconds=10.0, recordings_per_split=6)
    embeddings = np.zeros((2, 64), dtype=np.float32)
    embeddings[1, 0] = 1.0
    counted = []
    found = level_offsets_db(_KnownSource((2.0, -1.0)), embeddings, store, HeldOut(), counted.append)
    assert found == pytest.approx([2.0, -1.0], abs=0.3)
    assert sum(counted) == hops(store)


def _on_four_specimens(level_db: Sequence[float]) -> FakeStore:
    """Noise at one speed, 16 recordings that cycle through specimens of these levels relative to the label's."""
    generator, length = np.random.default_rng(5), int(4.0 * RATE_HZ)
    motion = np.tile(np.array([0.1, 0.0, 1.0], dtype=np.float32), (16 * length, 1))
    gains = 10.0 ** (np.array(level_db)[np.arange(16) % 4] / 20.0)
    wave = generator.standard_normal(16 * length) * np.repeat(0.02 * gains, length)
    recordings = [FakeRecording(0, "hand", "train", row * length, length, row % 4) for row in range(16)]
    return FakeStore(wave.astype(np.float32), motion, travelled_mm(motion), 10.0, ["one"], recordings)


@pytest.mark.parametrize("count", [4, 6, 8, 16])
def test_a_label_has_the_mean_level_of_its_specimens_in_db_whichever_recordings_are_compared(count: int) -> None:
    store = _on_four_specimens((-5.0, -1.0, 0.0, 6.0))
    levels = closed_loop_levels(
        _KnownSource((0.0, 0.0)), np.zeros((1, 64), dtype=np.float32), store, still_surfaces(1), HeldOut(),
        extent=Extent(recordings_per_label=count),
    )  # fmt: skip
    assert set(levels.specimens) == {0, 1, 2, 3}
    assert offsets_db(levels, 1) == pytest.approx([0.0], abs=0.2)


def test_a_recording_is_compared_with_a_render_of_its_own_specimen() -> None:
    class OfSpecimens(_KnownSource):
        def generate(self, embeddings: _Floats, *others: _Floats) -> _Floats:
            return super().generate(np.zeros_like(embeddings), *others) * 10.0 ** (embeddings[:, 1:2] / 20.0)

    store = _on_four_specimens((-5.0, -1.0, 0.0, 6.0))
    two_pieces = [entry for entry in store.recordings if entry.specimen in (0, 3)]
    specimens = np.zeros((1, 4, 64), dtype=np.float32)
    specimens[0, :, 1] = (-5.0, -1.0, 0.0, 6.0)
    levels = closed_loop_levels(
        OfSpecimens((0.0, 0.0)), np.zeros((1, 64), dtype=np.float32), replace(store, recordings=two_pieces),
        still_surfaces(1), HeldOut(), embedding_of=lambda labels, pieces: specimens[labels, pieces],
    )  # fmt: skip
    assert offsets_db(levels, 1) == pytest.approx([0.0], abs=0.1)


def test_a_level_shift_affects_its_label_only_and_is_the_same_at_every_motion() -> None:
    torch.manual_seed(2)
    level, embedding = LevelModel(), torch.randn(20, 64)
    shift = torch.linspace(-0.3, 0.5, 20)
    motions = torch.tensor([[0.05, 0.0, 1.0], [0.9, 0.4, 0.2], [0.0, 0.0, 0.0]])
    before = torch.stack([level(embedding, motion.expand(20, 3)).squeeze(1) for motion in motions])
    shift_level(level, embedding, shift)
    after = torch.stack([level(embedding, motion.expand(20, 3)).squeeze(1) for motion in motions])
    assert torch.allclose(after - before, shift.expand(3, 20), atol=1e-4)


@pytest.mark.long(
    because="two models are trained and exported to compare their sound; that a shifted level is the label's own is "
    "tested on the network alone"
)
def test_a_level_shift_in_the_file_scales_the_closed_loop_by_the_same_factor(tmp_path: Path) -> None:
    store = make_store(seconds=6.0, recordings_per_split=4)
    Trainer(_config(), store, tmp_path / "run", ALONE).run()
    recorded, levels = Source(store, INFOS, PROVENANCE), MeasuredLevels([1.5, -0.5])
    export_run(tmp_path / "run", recorded, tmp_path / "plain.haptoflow")
    export_run(tmp_path / "run", recorded, tmp_path / "level.haptoflow", levels=levels)
    files = [read_model_file(tmp_path / f"{name}.haptoflow") for name in ("plain", "level")]
    assert files[1].header["measurements"]["level_offsets_db"] == [1.5, -0.5]
    differ = {name for name, values in files[0].tensors.items() if not np.array_equal(values, files[1].tensors[name])}
    assert differ == {"level.law.weight"}

    tier = load_tiers([tmp_path / "run"])[0]
    source = TierSource(tier)
    before = level_offsets_db(source, source.embeddings, store, HeldOut())
    shift_level(tier.model.level, tier.model.embedding.weight, torch.tensor([-1.5, 0.5]) * (np.log(10.0) / 20.0))
    after = level_offsets_db(source, source.embeddings, store, HeldOut())
    assert np.subtract(after, before) == pytest.approx([-1.5, 0.5], abs=0.05)


RISE_DB = 14.0
SECONDS = 40.0


def brick_log_level(speed: np.ndarray) -> np.ndarray:
    """RMS 2 v^0.6 m/s^2 up to 60 mm/s, 14 dB more from 80 mm/s on."""
    rise = np.interp(np.log(speed), np.log([0.06, 0.08]), [0.0, RISE_DB]) * np.log(10.0) / 20.0
    return np.log(2.0) + 0.6 * np.log(speed) + rise


def brick_and_wood() -> FakeStore:
    """Brick, which rises by 14 dB between 60 and 80 mm/s, and wood, RMS 3 v: strokes from 10 to 400 mm/s, 0.5 to 2 N."""
    generator = np.random.default_rng(4)
    time = np.arange(int(SECONDS * RATE_HZ)) / RATE_HZ
    speed = np.exp(np.interp(np.sin(2 * np.pi * time / 7.0), [-1.0, 1.0], np.log([0.01, 0.4])))
    waves, motions, recordings = [], [], []
    for label in range(2):
        force = np.exp(0.7 * np.sin(2 * np.pi * time / 3.1 + label))
        log_level = (brick_log_level(speed) if label == 0 else np.log(3.0 * speed)) + 0.3 * np.log(force)
        waves.append(generator.standard_normal(len(time)) * np.exp(log_level))
        motions.append(np.column_stack([speed, 0.0 * speed, force]))
        recordings.append(FakeRecording(label, "hand", "train", label * len(time), len(time)))
    return FakeStore(
        (np.concatenate(waves) / 10.0).astype(np.float32), np.concatenate(motions).astype(np.float32),
        np.concatenate([travelled_mm(motion) for motion in motions]), 10.0, ["brick", "wood"], recordings,
    )  # fmt: skip


class LawOrTables:
    """A perfect network whose level model has power laws only, or tables: noise of that level."""

    LAWS = ((2.6, 1.0), (3.0, 1.0))
    pasts, noise_before = 1, 0

    def __init__(self, tables: Mapping[int, LevelTable]) -> None:
        self._tables = tables

    def generate(
        self, embeddings: np.ndarray, motions: np.ndarray, previous: np.ndarray, noise: np.ndarray, phase: np.ndarray
    ) -> np.ndarray:
        speed = np.maximum(np.hypot(motions[:, 0], motions[:, 1]), 1e-4)
        level = np.empty(len(motions))
        for row, label in enumerate(embeddings[:, 0].astype(int)):
            if label in self._tables:
                level[row] = self._tables[label].log_level(speed[row], motions[row, 2])
            else:
                factor, exponent = self.LAWS[label]
                level[row] = np.log(factor) + exponent * np.log(speed[row]) + 0.3 * np.log(motions[row, 2])
        return (noise * np.exp(level)[:, None]).astype(np.float32)


@pytest.fixture(scope="module")
def followed() -> tuple[dict[int, LevelTable], FakeStore]:
    store = brick_and_wood()
    embeddings = np.zeros((2, 64), dtype=np.float32)
    embeddings[1, 0] = 1.0
    exponents = {row: fit_exponents(store, row, periodic=False, seed=1, held_out=HeldOut()) for row in range(2)}

    def measure(tables: Mapping[int, LevelTable]) -> ClosedLoopLevels:
        wanted = frozenset(tables) or None
        source, still = LawOrTables(tables), still_surfaces(2)
        return closed_loop_levels(source, embeddings, store, still, HeldOut(), labels_wanted=wanted)

    return level_tables(measure({}), exponents, measure), store


def test_a_table_follows_a_rise_of_14_db_within_the_recorded_speeds_and_the_law_continues_beyond(
    followed: tuple[dict[int, LevelTable], FakeStore],
) -> None:
    tables, _ = followed
    table = tables[0]
    inside = np.array([0.015, 0.03, 0.05, 0.058, 0.09, 0.15, 0.3])
    error_db = 20.0 / np.log(10.0) * (table.log_level(inside, 1.0) - brick_log_level(inside))
    assert np.abs(error_db).max() < 1.5
    risen_db = 20.0 / np.log(10.0) * np.diff(table.log_level([0.057, 0.085], 1.0))[0]
    assert risen_db == pytest.approx(RISE_DB + 0.6 * 20.0 * np.log10(85.0 / 57.0), abs=1.5)
    last = table.speeds_mps[-1]
    beyond = table.log_level([last, 4.0 * last], 1.0)
    assert beyond[1] - beyond[0] == pytest.approx(table.speed_exponent * np.log(4.0), rel=0.01)
    at_forces = table.log_level(0.05, [0.5, 2.0])
    assert at_forces[1] - at_forces[0] == pytest.approx(table.force_exponent * np.log(4.0))
    assert table.force_exponent == pytest.approx(0.3, abs=0.1)


def test_a_label_that_follows_the_level_model_gets_no_table(followed: tuple[dict[int, LevelTable], FakeStore]) -> None:
    assert set(followed[0]) == {0}


def test_a_level_table_scales_only_its_own_label_in_the_closed_loop() -> None:
    config = TrainingConfig(model=ModelConfig(hidden=(8, 8)))
    tier = TrainedTier(config, ["brick", "wood"], build_model(config, [(), ()]).eval().requires_grad_(False))
    table = LevelTable((0.05, 0.5), (1.0, 2.0), 1.0, 0.5, 1.0)
    embeddings = TierSource(tier).embeddings
    motions = np.array([[0.2, 0.0, 2.0], [0.2, 0.0, 2.0]], dtype=np.float32)
    nothing = np.zeros((2, 2, 200), dtype=np.float32)
    noise = np.random.default_rng(1).standard_normal((2, NOISE_BEFORE + 200)).astype(np.float32)
    phases = np.zeros((2, 6), dtype=np.float32)
    plain = TierSource(tier).generate(embeddings, motions, nothing, noise, phases)
    tabled = TierSource(tier, {0: table}).generate(embeddings, motions, nothing, noise, phases)
    again = TierSource(tier, {0: LevelTable((0.05,), (0.0,), 1.0, 0.0, 0.0)}).generate(
        embeddings, motions, nothing, noise, phases
    )
    np.testing.assert_array_equal(tabled[1], plain[1])
    ratio = np.sqrt(np.square(tabled[0]).mean() / np.square(again[0]).mean())
    assert np.log(ratio) == pytest.approx(float(table.log_level(0.2, 2.0)), abs=1e-3)


def test_a_smooth_curve_takes_few_speeds_and_a_kinked_one_sixteen_at_most() -> None:
    speeds = np.exp(np.linspace(np.log(0.01), np.log(1.0), 40))
    law = {"force_newtons": 1.0, "force_exponent": 0.0, "speed_exponent": 1.0}
    assert len(table_through(speeds, np.log(speeds + 0.0005), **law).speeds_mps) == 2
    assert len(table_through(speeds, np.sin(np.arange(40.0)), **law).speeds_mps) == 16


def test_offsets_that_are_the_same_at_all_speeds_need_no_table() -> None:
    speeds = np.repeat(np.exp(np.linspace(np.log(0.02), np.log(0.5), 20)), 12)
    heard = speeds**2
    levels = ClosedLoopLevels(
        np.column_stack([4.0 * heard, heard]), speeds, np.ones(len(speeds)), np.zeros(len(speeds), dtype=np.int64),
        np.full(len(speeds), -1),
    )  # fmt: skip

    def never(tables: Mapping[int, LevelTable]) -> ClosedLoopLevels:
        raise AssertionError("nothing is to be measured again")

    assert level_tables(levels, {0: LabelExponents(1.0, 0.0, 0.0)}, never) == {}


LABELS = ("wood", "stone", "metal mesh", "plastic", "leather", "corduroy", "sandpaper")
EDGE_MPS = 0.06
FAST_MPS = (0.15, 0.5, 1.5)


@dataclass(frozen=True)
class Taught:
    """A level model and exponents fitted to nothing faster than 60 mm/s."""

    level: LevelModel
    embedding: torch.Tensor
    exponents: list[LabelExponents]
    edge_waves: list[np.ndarray]

    def edge_rms_mps2(self, label: int) -> float:
        with torch.no_grad():
            return self.level(self.embedding[label : label + 1], torch.tensor([[EDGE_MPS, 0.0, 1.0]])).exp().item()


def _slow_store() -> FakeStore:
    waves, motions, recordings, start = [], [], [], 0
    for index, label in enumerate(LABELS):
        (material,) = select_materials(load_materials(), [label])
        for identity in machine_conditions(material, directions=(0,), speeds_mmps=(20, 40, 60), repeats=1):
            prepared = preprocess_recording(record_condition_of(material, identity, seed=5))
            waves.append(prepared.waveform_mps2 / 10.0)
            motions.append(prepared.motion)
            recordings.append(FakeRecording(index, "machine", "train", start, len(prepared.waveform_mps2)))
            start += len(prepared.waveform_mps2)
    motion = np.concatenate(motions)
    return FakeStore(np.concatenate(waves), motion, travelled_mm(motion), 10.0, list(LABELS), recordings)


@pytest.fixture(scope="module")
def taught() -> Taught:
    store = _slow_store()
    periodic = {material.label: bool(material.rulings) for material in load_materials()}
    exponents = [
        fit_exponents(store, row, periodic=periodic[label], seed=1, held_out=HeldOut())
        for row, label in enumerate(LABELS)
    ]
    torch.manual_seed(1)
    level, embedding = LevelModel(), torch.randn(len(LABELS), 64)
    optimiser = torch.optim.AdamW(level.parameters(), lr=3e-3, weight_decay=0.01)
    generator = np.random.default_rng(1)
    for _ in range(500):
        picked = [store.recordings[place] for place in generator.integers(len(store.recordings), size=128)]
        starts = [entry.start + int(generator.integers(entry.length - 100)) for entry in picked]
        power = np.array([np.square(10.0 * store.waveform[start : start + 100]).mean() for start in starts])
        motion = np.array([store.motion[start : start + 100].mean(axis=0) for start in starts])
        labels = torch.tensor([entry.label_index for entry in picked])
        log_level = level(embedding[labels], torch.from_numpy(motion).float())
        loss = level_loss(log_level, torch.from_numpy(power).float().unsqueeze(1)).mean()
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
    return Taught(level, embedding, exponents, [_recorded(label, EDGE_MPS, 77) for label in LABELS])


def _recorded(label: str, speed_mps: float, seed: int) -> np.ndarray:
    material = next(entry for entry in load_materials() if entry.label == label)
    recording = record_condition(
        material, velocity_mps=(speed_mps, 0.0), force_newtons=1.0, duration_seconds=2.6, seed=seed
    )
    return preprocess_recording(recording).waveform_mps2


def _level_errors_db(taught: Taught, speed_mps: float) -> tuple[np.ndarray, np.ndarray]:
    """(with the law, clamped at the edge): magnitude of the error of each label's level, dB."""
    law, clamped = [], []
    for row, label in enumerate(LABELS):
        wave = _recorded(label, speed_mps, 78)
        truth = 20.0 * np.log10(np.sqrt(np.square(wave, dtype=np.float64).mean()))
        edge = 20.0 * np.log10(taught.edge_rms_mps2(row))
        exponent = taught.exponents[row].level_speed
        law.append(abs(edge + 20.0 * exponent * np.log10(speed_mps / EDGE_MPS) - truth))
        clamped.append(abs(edge - truth))
    return np.array(law), np.array(clamped)


@pytest.mark.long(
    because="a network is trained to be compared with fast recordings; the arithmetic of the law is tested without a "
    "network"
)
@pytest.mark.parametrize("speed_mps", FAST_MPS)
def test_extrapolating_the_level_law_is_closer_to_fast_recordings_than_clamping(
    taught: Taught, speed_mps: float
) -> None:
    law, clamped = _level_errors_db(taught, speed_mps)
    assert np.median(law) < 0.6 * np.median(clamped), (law.round(1), clamped.round(1))
