"""The files and folders of the evaluation: configurations, models, trainings and figures."""

from __future__ import annotations

import dataclasses
import json
import sys
import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tqdm import tqdm

from haptoflow_paper.rows.row_plan import PlannedRow
from haptoflow_training.extensions import configuration_class
from haptoflow_training.training.config import load_config
from haptoflow_training.training.processes import Job, run_jobs
from haptoflow_training.training.recordings_source import open_source

_CODEC_CONFIGURATION = "paper-codec"


@dataclass(frozen=True)
class Workplace:
    """root: the repository. work: for trainings and models (not committed). results: for measured rows. quick: every
    fourth recording and no long measurements, with results kept apart from the complete ones."""

    root: Path
    plan: Path
    work: Path
    store: Path
    results: Path
    quick: bool = False

    @property
    def codec_checkpoint(self) -> Path:
        """The small codec's checkpoint, trained for the rows in its latents."""
        representation = load_config(self.config_file(_CODEC_CONFIGURATION)).model.representation
        return self.root / str(representation["checkpoint"])

    def model_file(self, row: PlannedRow, seed: int) -> Path:
        """The row's model: a file of the repository, or the file that its training exports."""
        if is_of_repository(row, seed):
            return self.root / row.model
        return self.work / "models" / f"{row.model_of(seed)}-{seed}.haptoflow"

    def seeds_of(self, row: PlannedRow) -> list[int]:
        """The row's seeds, without those of a training whose configuration is missing."""
        return [
            seed for seed in row.seeds
            if row.is_reference or is_of_repository(row, seed) or self.config_file(row.model_of(seed)).exists()
        ]  # fmt: skip

    def config_file(self, model: str) -> Path:
        """The configuration that a trained model is made from."""
        return self.plan.parent / f"{model}.toml"

    def configuration(self, model: str, seed: int) -> dict[str, Any]:
        """The present configuration of a model and seed, as JSON."""
        config = dataclasses.replace(load_config(self.config_file(model)), seed=seed)
        described: dict[str, Any] = json.loads(json.dumps(config.to_dict()))
        return described

    def run_folder(self, model: str, seed: int) -> Path:
        """Checkpoints, metrics and log of a training."""
        return self.work / "runs" / f"{model}-{seed}"

    def row_file(self, row: PlannedRow, seed: int) -> Path:
        """The file with the figures of a row and seed."""
        return (self.work / "rows-quick" if self.quick else self.results / "rows") / f"{row.name}-{seed}.json"

    def configuration_crc32(self, row: PlannedRow, seed: int) -> str:
        """CRC-32 of what the training configuration states beyond the defaults; empty if nothing is trained for the
        row."""
        if row.is_reference or is_of_repository(row, seed):
            return ""
        described = json.dumps(stated(self.configuration(row.model_of(seed), seed)), sort_keys=True)
        return f"{zlib.crc32(described.encode()):08x}"


def stated(configuration: dict[str, Any]) -> dict[str, Any]:
    """What a configuration, as JSON, states beyond the defaults: a new key with a default leaves models and rows valid."""
    defaults = json.loads(json.dumps(configuration_class()().to_dict()))
    # As of the first rows: other values would make all of them invalid.
    defaults["tier"], defaults["model"]["network"] = "standard", "field"
    return _beyond(configuration, defaults)


def _beyond(values: dict[str, Any], defaults: dict[str, Any]) -> dict[str, Any]:
    """The entries that differ from the defaults; of a table within, its own."""
    kept = {}
    for key, value in values.items():
        default = defaults.get(key)
        if isinstance(value, dict) and isinstance(default, dict):
            value = _beyond(value, default)
            default = {}
        if value != default:
            kept[key] = value
    return kept


def is_of_repository(row: PlannedRow, seed: int) -> bool:
    """Whether the model of a row's seed is a file of the repository rather than one that the evaluation trains."""
    return row.model_of(seed).endswith(".haptoflow")


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
