"""`train --minutes`: time is divided according to measured steps, and the model is complete at the end."""

from __future__ import annotations

import io
import re
import time
from pathlib import Path

import pytest
from test_trainer import ALONE, _config
from training_fixtures import make_store

from haptoflow_training.commands.minutes import TiersMinutes
from haptoflow_training.training import trainer as trainer_module
from haptoflow_training.training.trainer import TimeLimit, Trainer, load_trained

SECONDS_PER_STEP = {"level": 1.0, "field": 4.0, "polish": 1.0}


@pytest.fixture
def wall(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """A wall clock that advances only with training steps."""
    now = [0.0]
    monkeypatch.setattr(trainer_module.time, "monotonic", lambda: now[0])
    train_step = Trainer._train_step

    def step(trainer: Trainer, losses: object, phase: object) -> object:
        now[0] += SECONDS_PER_STEP[phase.name]  # type: ignore[attr-defined]
        return train_step(trainer, losses, phase)  # type: ignore[arg-type]

    monkeypatch.setattr(Trainer, "_train_step", step)
    return now


def limited(folder: Path, limit: TimeLimit) -> Trainer:
    trainer = Trainer(_config(), make_store(), folder, ALONE)
    trainer.limit_time(limit)
    return trainer


@pytest.mark.parametrize("seconds", [200.0, 400.0])
def test_timed_steps_and_training_together_take_the_given_time_and_finish(
    tmp_path: Path, wall: list[float], seconds: float
) -> None:
    limited(tmp_path, TimeLimit(seconds)).run()
    assert wall[0] == pytest.approx(seconds, abs=10.0)
    _, labels, _ = load_trained(tmp_path)
    assert labels == ["tone", "noise"]


def test_the_bar_shows_the_time_left_including_what_follows_training(
    tmp_path: Path, wall: list[float], monkeypatch: pytest.MonkeyPatch
) -> None:
    shown = io.StringIO()
    original = trainer_module.tqdm
    monkeypatch.setattr(trainer_module, "tqdm", lambda **words: original(**{**words, "file": shown}))
    limited(tmp_path, TimeLimit(300.0, seconds_after=40.0)).run()
    left = [60 * int(minutes) + int(seconds) for minutes, seconds in re.findall(r"(\d+):(\d\d) left", shown.getvalue())]
    assert 200 < left[0] <= 340 and left[-1] == pytest.approx(40, abs=6)
    assert left == sorted(left, reverse=True)


def test_a_resumed_run_uses_the_rest_of_its_time(tmp_path: Path, wall: list[float]) -> None:
    first = limited(tmp_path, TimeLimit(300.0))
    first._stop = True
    with pytest.raises(trainer_module.TrainingStopped):
        first.run()
    used = wall[0]
    wall[0] += 5000.0
    limited(tmp_path, TimeLimit(123.0)).run()
    assert wall[0] - 5000.0 == pytest.approx(300.0, abs=10.0) and used < 100.0


@pytest.mark.parametrize(("networks", "lanes", "rounds"), [(2, 2, 1), (2, 1, 2), (3, 2, 2), (1, 8, 1)])
def test_a_whole_models_minutes_are_shared_by_base_networks_and_levels(networks: int, lanes: int, rounds: int) -> None:
    shares = TiersMinutes.of(10.0, time.monotonic() - 60.0, networks, lanes)
    assert shares.base + rounds * shares.network + shares.levels == pytest.approx(540.0, abs=1.0)
    assert shares.network > shares.base > shares.levels > 0.0


def test_preparing_that_took_most_of_a_whole_models_minutes_leaves_three_tenths() -> None:
    shares = TiersMinutes.of(10.0, time.monotonic() - 590.0, 2, 2)
    assert shares.base + shares.network + shares.levels == pytest.approx(180.0)
