"""Time budgets: phases scaled by one factor, ended by the clock, continued after an interruption."""

from __future__ import annotations

import io
import json
import re
import time
from pathlib import Path

import pytest

from haptoflow_paper.runs.configuration import EvaluatedConfig
from haptoflow_paper.runs.trainer import EvaluatedTrainer
from haptoflow_training.commands.train import TiersMinutes
from haptoflow_training.training import trainer as trainer_module
from haptoflow_training.training.budget import Budget
from haptoflow_training.training.trainer import TimeLimit, Trainer, TrainingStopped, load_trained
from paper_samples import evaluated
from test_trainer import ALONE, _config, ask_to_stop_after
from training_fixtures import make_store

SECONDS_PER_STEP = {"level": 1.0, "field": 4.0, "polish": 1.0}


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """Computing time, and a wall clock, that pass only with training steps."""
    now = [0.0]
    for name in ("process_time", "monotonic"):
        monkeypatch.setattr(trainer_module.time, name, lambda: now[0])
    train_step = Trainer._train_step

    def step(trainer: Trainer, losses: object, phase: object) -> object:
        now[0] += SECONDS_PER_STEP[phase.name]  # type: ignore[attr-defined]
        return train_step(trainer, losses, phase)  # type: ignore[arg-type]

    monkeypatch.setattr(Trainer, "_train_step", step)
    return now


def _budgeted(seconds: float) -> EvaluatedConfig:
    """20 + 30 + 10 steps of 1, 4 and 1 seconds: 150 seconds without a budget, 30 of them for the level."""
    return evaluated(_config(), optimiser={"budget_seconds": seconds})


def _phases(folder: Path) -> dict[str, dict[str, float]]:
    run = json.loads((folder / "run.json").read_text(encoding="utf-8"))
    return {phase["name"]: phase for phase in run["phases"]}


def test_a_budget_keeps_the_level_phases_and_scales_all_others_by_one_factor() -> None:
    kept = [True, False, False, True]
    budget = Budget.shared_out(210.0, [20, 30, 15, 10], [1.0, 4.0, 4.0, 1.0], kept=kept)
    assert budget.allotted_seconds == pytest.approx([20.0, 120.0, 60.0, 10.0])
    short = Budget.shared_out(40.0, [20, 30, 15, 10], [1.0, 4.0, 4.0, 1.0], kept=kept)
    assert short.allotted_seconds == pytest.approx([20 / 1.5, 20 / 1.5, 10 / 1.5, 10 / 1.5])
    alone = Budget.shared_out(60.0, [20, 10], [1.0, 1.0], kept=[True, True])
    assert alone.allotted_seconds == pytest.approx([40.0, 20.0])


@pytest.mark.parametrize("seconds", [75.0, 300.0])
def test_a_run_makes_as_many_steps_as_fit_its_budget(seconds: float, tmp_path: Path, clock: list[float]) -> None:
    EvaluatedTrainer(_budgeted(seconds), make_store(), tmp_path, ALONE).run()
    phases = _phases(tmp_path)
    for name, steps in (("level", 20), ("field", (seconds - 30.0) / 4.0), ("polish", 10)):
        assert phases[name]["steps"] == pytest.approx(steps, abs=1.0), name
    assert sum(phase["core_seconds"] for phase in phases.values()) == pytest.approx(seconds, abs=6.0)


def test_a_resumed_run_uses_the_rest_of_its_budget(tmp_path: Path, clock: list[float]) -> None:
    stopped = EvaluatedTrainer(_budgeted(300.0), make_store(), tmp_path, ALONE)
    ask_to_stop_after(stopped, 60)
    with pytest.raises(TrainingStopped):
        stopped.run()
    clock[0] += 1000.0
    EvaluatedTrainer(_budgeted(300.0), make_store(), tmp_path, ALONE).run()
    phases = _phases(tmp_path)
    steps = [phases[name]["steps"] for name in ("level", "field", "polish")]
    assert steps == pytest.approx([20, 270 / 4.0, 10], abs=1.0)
    EvaluatedTrainer(_budgeted(300.0), make_store(), tmp_path, ALONE).run()
    assert load_trained(tmp_path)[0].optimiser.budget_seconds == 300.0


def limited(folder: Path, limit: TimeLimit) -> Trainer:
    trainer = Trainer(_config(), make_store(), folder, ALONE)
    trainer.limit_time(limit)
    return trainer


@pytest.mark.parametrize("seconds", [200.0, 400.0])
def test_timed_steps_and_training_together_take_the_given_time_and_finish(
    tmp_path: Path, clock: list[float], seconds: float
) -> None:
    limited(tmp_path, TimeLimit(seconds)).run()
    assert clock[0] == pytest.approx(seconds, abs=10.0)
    _, labels, _ = load_trained(tmp_path)
    assert labels == ["tone", "noise"]


def test_the_bar_shows_the_time_left_including_what_follows_training(
    tmp_path: Path, clock: list[float], monkeypatch: pytest.MonkeyPatch
) -> None:
    shown = io.StringIO()
    original = trainer_module.tqdm
    monkeypatch.setattr(trainer_module, "tqdm", lambda **words: original(**{**words, "file": shown}))
    limited(tmp_path, TimeLimit(300.0, seconds_after=40.0)).run()
    left = [60 * int(minutes) + int(seconds) for minutes, seconds in re.findall(r"(\d+):(\d\d) left", shown.getvalue())]
    assert 200 < left[0] <= 340 and left[-1] == pytest.approx(40, abs=6)
    assert left == sorted(left, reverse=True)


def test_a_resumed_run_uses_the_rest_of_its_time(tmp_path: Path, clock: list[float]) -> None:
    first = limited(tmp_path, TimeLimit(300.0))
    first._stop = True
    with pytest.raises(trainer_module.TrainingStopped):
        first.run()
    used = clock[0]
    clock[0] += 5000.0
    limited(tmp_path, TimeLimit(123.0)).run()
    assert clock[0] - 5000.0 == pytest.approx(300.0, abs=10.0) and used < 100.0


@pytest.mark.parametrize(("networks", "lanes", "rounds"), [(2, 2, 1), (2, 1, 2), (3, 2, 2), (1, 8, 1)])
def test_a_whole_models_minutes_are_shared_by_base_networks_and_levels(networks: int, lanes: int, rounds: int) -> None:
    shares = TiersMinutes.of(10.0, time.monotonic() - 60.0, networks, lanes)
    assert shares.base + rounds * shares.network + shares.levels == pytest.approx(540.0, abs=1.0)
    assert shares.network > shares.base > shares.levels > 0.0


def test_preparing_that_took_most_of_a_whole_models_minutes_leaves_three_tenths() -> None:
    shares = TiersMinutes.of(10.0, time.monotonic() - 590.0, 2, 2)
    assert shares.base + shares.network + shares.levels == pytest.approx(180.0)
