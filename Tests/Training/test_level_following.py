"""A label whose level departs from a power law gets a table; others get none."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pytest
from training_fixtures import RATE_HZ, FakeRecording, FakeStore, still_surfaces, travelled_mm

from haptoflow_training.closed_loop.level_calibration import ClosedLoopLevels, TierSource, closed_loop_levels
from haptoflow_training.closed_loop.measured_levels import level_tables
from haptoflow_training.export.exponents import LabelExponents, fit_exponents
from haptoflow_training.export.level_table import LevelTable, table_through
from haptoflow_training.export.trained_tier import TrainedTier
from haptoflow_training.training.config import ModelConfig, TrainingConfig
from haptoflow_training.training.batches import HeldOut
from haptoflow_training.training.trainer import build_model

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


def test_a_label_that_follows_the_level_model_gets_no_table(
    followed: tuple[dict[int, LevelTable], FakeStore],
) -> None:
    assert set(followed[0]) == {0}


def test_a_level_table_scales_only_its_own_label_in_the_closed_loop() -> None:
    config = TrainingConfig(model=ModelConfig(hidden=8))
    tier = TrainedTier(config, ["brick", "wood"], build_model(config, [(), ()]).eval().requires_grad_(False))
    table = LevelTable((0.05, 0.5), (1.0, 2.0), 1.0, 0.5, 1.0)
    embeddings = TierSource(tier).embeddings
    motions = np.array([[0.2, 0.0, 2.0], [0.2, 0.0, 2.0]], dtype=np.float32)
    nothing = np.zeros((2, 200), dtype=np.float32)
    noise = np.random.default_rng(1).standard_normal((2, 200)).astype(np.float32)
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
        np.column_stack([4.0 * heard, heard]), speeds, np.ones(len(speeds)), np.zeros(len(speeds), dtype=np.int64)
    )

    def never(tables: Mapping[int, LevelTable]) -> ClosedLoopLevels:
        raise AssertionError("nothing is to be measured again")

    assert level_tables(levels, {0: LabelExponents(1.0, 0.0, 0.0)}, never) == {}
