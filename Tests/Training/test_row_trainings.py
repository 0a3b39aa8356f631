"""Which trainings the evaluation's rows start, and which count as done."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

import pytest

from haptoflow_paper.rows import workplace
from haptoflow_paper.rows.row_plan import PlannedRow
from haptoflow_paper.rows.workplace import Workplace, train_models
from haptoflow_training.training.config import DataConfig, load_config
from haptoflow_training.training.processes import Job

_ROW = PlannedRow("row", "as-published", model="small")


@pytest.fixture
def started(monkeypatch: pytest.MonkeyPatch) -> list[Job]:
    """The jobs that would be run."""
    jobs: list[Job] = []

    def remember(given: Sequence[Job], lanes: int, progress: object) -> None:
        jobs.extend(given)

    monkeypatch.setattr(workplace, "run_jobs", remember)
    monkeypatch.setattr(workplace, "open_source", lambda data, store, workers: None)
    return jobs


@pytest.fixture
def place(tmp_path: Path) -> Workplace:
    (tmp_path / "small.toml").write_text('name = "small"\n[data]\nsource = "synthetic"\n', encoding="utf-8")
    return Workplace(tmp_path, tmp_path / "rows.toml", tmp_path / "work", tmp_path / "store", tmp_path / "results")


def _leave_as_trained(place: Workplace, seed: int = 1) -> Path:
    """A model and its summary, as a finished training leaves them; returns the summary's path."""
    place.model_file(_ROW, seed).parent.mkdir(parents=True, exist_ok=True)
    place.model_file(_ROW, seed).touch()
    summary = place.run_folder("small", seed) / "run.json"
    summary.parent.mkdir(parents=True, exist_ok=True)
    configuration = {**load_config(place.config_file("small")).to_dict(), "seed": seed}
    summary.write_text(json.dumps({"configuration": configuration}), encoding="utf-8")
    return summary


def test_rows_of_the_same_model_share_one_training_for_each_seed(place: Workplace, started: list[Job]) -> None:
    other = PlannedRow("other", "as-published", model="small", solver="euler", steps=8)
    train_models(place, [(_ROW, 1), (other, 1), (other, 2), (PlannedRow("silence", "reference"), 1)], 2)
    assert [job.name for job in started] == ["small, seed 1", "small, seed 2"]
    assert started[1].product == place.model_file(_ROW, 2) and "--seed 2" in " ".join(started[1].words)


def test_a_model_trained_with_its_present_configuration_is_not_trained_again(
    place: Workplace, started: list[Job]
) -> None:
    _leave_as_trained(place, seed=1)
    _leave_as_trained(place, seed=3)
    train_models(place, [(_ROW, 1), (_ROW, 3)], 1)
    assert started == []


def test_the_store_is_prepared_once_before_trainings_and_codecs_start_and_not_where_nothing_is_trained(
    place: Workplace, started: list[Job], monkeypatch: pytest.MonkeyPatch
) -> None:
    latent = '\n[model]\npatch = 5\n[model.representation]\nkind = "small-codec"\ncheckpoint = "codec/small-codec.pt"\n'
    (place.root / "latent.toml").write_text(f'name = "latent"\n[data]\nlabels = ["wood"]\n{latent}', encoding="utf-8")
    prepared = []

    def prepare(data: DataConfig, store: Path, workers: int) -> None:
        prepared.append((data.labels, store, workers, len(started)))

    monkeypatch.setattr(workplace, "open_source", prepare)
    train_models(place, [(PlannedRow("latent", "as-published", model="latent"), 1), (_ROW, 1)], 2)
    assert prepared == [(("wood",), place.store, 2, 0)] and len(started) == 3
    _leave_as_trained(place)
    train_models(place, [(_ROW, 1)], 2)
    assert len(prepared) == 1
