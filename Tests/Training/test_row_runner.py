"""Rows measured by several processes: the same figures as with one process, stored as they are finished."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
import torch

from haptoflow_paper.rows.reference_conditions import Condition
from haptoflow_paper.rows.reference_set import ReferencePair
from haptoflow_paper.rows import untrained, workplace
from haptoflow_paper.rows.accuracy import Yardstick, make_yardstick
from haptoflow_paper.rows.row_plan import PlannedRow, load_plan
from haptoflow_paper.rows.row_runner import made_from, measure_rows
from haptoflow_paper.rows.workplace import Workplace, stored_row, train_models
from haptoflow_paper.runs.trainer import EvaluatedTrainer
from haptoflow_training.errors import InputError
from haptoflow_training.training.config import DataConfig, TrainingConfig, config_from_dict, load_config
from haptoflow_training.training.processes import Job
from haptoflow_training.training.trainer import Trainer, build_model
from paper_samples import evaluated
from test_trainer import _config
from places import ROOT

_ROWS = [PlannedRow(name, "reference") for name in ("silence", "white-noise", "mean-spectrum")]


def _pair(label: str, index: int, place: int) -> ReferencePair:
    generator = np.random.default_rng([index, place])
    motion = np.tile(np.float32([0.2, 0.0, 1.0]), (6000, 1))
    waves = [
        np.convolve(generator.standard_normal(6000 + index), np.ones(1 + index), "valid").astype(np.float32)
        for _ in range(2)
    ]
    return ReferencePair(Condition(label, index, "constant", 0.2, 1.0, 0.0, 3.0, place), *waves, motion)


@pytest.fixture(scope="module")
def yardstick() -> Yardstick:
    return make_yardstick([_pair(label, index, place) for index, label in enumerate("ab") for place in range(6)])


def _place(folder: Path) -> Workplace:
    return Workplace(folder, folder / "rows.toml", folder / "work", folder / "store", folder / "results")


def test_two_processes_give_the_same_figures_as_one_and_store_every_row(tmp_path: Path, yardstick: Yardstick) -> None:
    wanted = [(row, 1) for row in _ROWS]
    done: list[int] = []
    together = measure_rows(_place(tmp_path / "two"), yardstick, wanted, 2, done.append)
    assert together == measure_rows(_place(tmp_path / "one"), yardstick, wanted, 1)
    assert len(together["white-noise", 1]["conditions"]) == 12 and sum(done) == 3
    for row in _ROWS:
        place = _place(tmp_path / "two")
        assert stored_row(place, row, 1, made_from(place, yardstick, row, 1)) == together[row.name, 1]


def test_a_row_that_cannot_be_measured_is_reported_and_the_others_are_stored(
    tmp_path: Path, yardstick: Yardstick
) -> None:
    place = _place(tmp_path)
    (tmp_path / "broken.haptoflow").write_bytes(b"not a model")
    broken = PlannedRow("broken", "ours", model="broken.haptoflow")
    with pytest.raises(InputError, match="broken.haptoflow"):
        measure_rows(place, yardstick, [(broken, 1), (_ROWS[0], 1)], 2)
    assert stored_row(place, _ROWS[0], 1, made_from(place, yardstick, _ROWS[0], 1)) is not None


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


def test_a_row_without_its_model_here_is_timed_by_an_untrained_network_of_the_same_sizes(
    place: Workplace, monkeypatch: pytest.MonkeyPatch
) -> None:
    jobs: list[Job] = []
    monkeypatch.setattr(untrained, "run_jobs", lambda given, lanes, progress: jobs.extend(given))
    (place.root / "small.toml").write_text('name = "small"\n[model]\nnetwork = "field"\nwidth = 24\n', encoding="utf-8")
    latent = '\n[model]\npatch = 5\n[model.representation]\nkind = "small-codec"\ncheckpoint = "codec/small-codec.pt"\n'
    (place.root / "latent.toml").write_text(f'name = "latent"\n{latent}', encoding="utf-8")
    rows = [_ROW, PlannedRow("two-steps", "as-published", model="small"), PlannedRow("latent", "as-published", model="latent")]
    untrained.make_untrained(place, rows, 2)
    assert [job.product for job in jobs] == [place.timed_file(_ROW), place.timed_file(rows[2])]
    small, codec = (load_config(Path(job.words[job.words.index("--config") + 1])) for job in jobs)
    assert (small.model.width, small.optimiser.steps) == (24, 1)
    assert Path(codec.model.representation["checkpoint"]).is_relative_to(place.work), "the trained codec stays"
    _leave_as_trained(place)
    assert place.timed_file(_ROW) == place.model_file(_ROW, 1)


PAPER = ROOT / "Training" / "haptoflow_paper"


def test_every_published_row_was_measured_with_the_present_configuration_of_its_model() -> None:
    place = Workplace(PAPER.parents[1], PAPER / "configs" / "rows.toml", Path("work"), Path("store"), PAPER / "results")
    published = json.loads((place.results / "accuracy-time.json").read_text(encoding="utf-8"))
    checked = 0
    outdated = set()
    for row in load_plan(place.plan):
        for seed in place.seeds_of(row):
            if not place.row_file(row, seed).exists():
                assert row.name in published["not_measured"] or seed != row.seeds[0], f"{row.name}, seed {seed}"
                continue
            stored = json.loads(place.row_file(row, seed).read_text(encoding="utf-8"))["made_from"]
            if stored["configuration_crc32"] != place.configuration_crc32(row, seed):
                outdated.add(row.name)
            checked += bool(stored["configuration_crc32"])
    assert not outdated
    assert checked >= 4


def test_an_evaluated_run_with_no_key_of_its_own_has_the_weights_and_phases_of_the_product() -> None:
    product = config_from_dict(_config().to_dict(), Path("test"), TrainingConfig)
    models = []
    for config in (product, evaluated(product)):
        torch.manual_seed(8)
        models.append(build_model(config, [(), ()]).state_dict())
    assert models[0].keys() == models[1].keys()
    assert all(torch.equal(models[0][name], models[1][name]) for name in models[0])
    phases = [trainer.phases(config) for trainer, config in ((Trainer, product), (EvaluatedTrainer, evaluated(product)))]
    assert phases[0] == phases[1]
