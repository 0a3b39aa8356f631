"""Trains the models that rows need."""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from tqdm import tqdm

from haptoflow_paper.rows.row_plan import PlannedRow
from haptoflow_paper.rows.workplace import Workplace, is_of_repository, stated
from haptoflow_training.training.config import load_config
from haptoflow_training.training.job_lanes import Job, run_jobs
from haptoflow_training.training.recordings_source import open_source

# Rows need rivals and codecs, which haptoflow_training alone does not have.
_PROGRAM = (sys.executable, "-m", "haptoflow_paper")


def train_models(place: Workplace, rows: Sequence[tuple[PlannedRow, int]], lanes: int) -> None:
    """Train the models of rows and seeds that do not exist yet, `lanes` at a time; an interrupted training is resumed.

    InputError names the log of a training that failed, for example because its folder belongs to another configuration.
    """
    trained = [(row, seed) for row, seed in rows if not (row.is_reference or is_of_repository(row, seed))]
    wanted = {place.model_file(row, seed): (row.model_of(seed), seed) for row, seed in trained}
    jobs = [
        _training(place, model, seed, out)
        for out, (model, seed) in wanted.items()
        if not (out.exists() and _is_as_configured(place, model, seed))
    ]
    codecs = {job.product: job for model, _ in wanted.values() for job in _codec_training(place, model)}
    if jobs:
        _prepare_store(place, next(iter(wanted.values()))[0], lanes)
    with tqdm(total=len(jobs) + len(codecs), desc="trainings", unit="model") as bar:

        def show_progress(finished: int) -> None:
            bar.n = finished
            bar.refresh()

        run_jobs(list(codecs.values()), lanes, show_progress)
        run_jobs(jobs, lanes, lambda finished: show_progress(len(codecs) + finished))


def _prepare_store(place: Workplace, model: str, workers: int) -> None:
    """Prepare the recordings once, before several trainings, and the codec's, need them."""
    open_source(load_config(place.config_file(model)).data, place.store, workers)


def _is_as_configured(place: Workplace, model: str, seed: int) -> bool:
    """Whether an existing model was trained with its present configuration; True if it has no summary."""
    summary = place.run_folder(model, seed) / "run.json"
    if not summary.exists():
        return True
    trained: dict[str, Any] = json.loads(summary.read_text(encoding="utf-8"))["configuration"]
    return stated(trained) == stated(place.configuration(model, seed))


def _training(place: Workplace, model: str, seed: int, out: Path) -> Job:
    folder = place.run_folder(model, seed)
    words = ["train", "--config", str(place.config_file(model)), "--seed", str(seed)]
    words += ["--out", str(folder), "--store", str(place.store), "--export", str(out)]
    return Job(f"{model}, seed {seed}", words, folder / "train.log", out, place.root, _PROGRAM)


def _codec_training(place: Workplace, model: str) -> list[Job]:
    """The training of the small codec whose latents the model uses, unless it is trained already."""
    representation = load_config(place.config_file(model)).model.representation
    if representation["kind"] != "small-codec":
        return []
    checkpoint = place.root / representation["checkpoint"]
    if checkpoint.exists():
        return []
    codec = Path(__file__).parents[1] / "configs" / "codec-small.toml"
    words = ["train-codec", "--config", str(codec), "--store", str(place.store), "--out", str(checkpoint.parent)]
    return [Job("the small codec", words, checkpoint.parent / "train.log", checkpoint, place.root, _PROGRAM)]
