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

from haptoflow_paper.report.cell_figures import IDENTITY, JUDGED
from haptoflow_paper.rows.row_plan import PlannedRow
from haptoflow_training.extensions import configuration_class
from haptoflow_training.training.config import load_config
from haptoflow_training.training.processes import Job, run_jobs
from haptoflow_training.training.recordings_source import open_source
from haptoflow_training.whole_file import write_text

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

    def timed_file(self, row: PlannedRow) -> Path:
        """What the row's time is measured with: its model or, where that is not here, an untrained network of its sizes."""
        model = self.model_file(row, row.seeds[0])
        return model if model.exists() else self.work / "untrained" / f"{row.model_of(row.seeds[0])}.haptoflow"

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
    name = f"{model}, seed {seed}"
    return training_job(place, name, place.config_file(model), seed, place.run_folder(model, seed), out)


def training_job(place: Workplace, name: str, config: Path, seed: int, folder: Path, out: Path) -> Job:
    """The training of a configuration in `folder`, which exports the model file `out`."""
    words = ["train", "--config", str(config), "--seed", str(seed)]
    words += ["--out", str(folder), "--store", str(place.store), "--export", str(out)]
    return Job(name, words, folder / "train.log", out, place.root, _PROGRAM)


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


_UNJUDGED = (
    "gfc_segment", "rmse", "band_error_db", "continuity", "recorded_kurtosis", "change_level_error_db",
    "change_crest_error_db",
)  # fmt: skip
_COLUMNS = (*IDENTITY, *(figure.key for figure in JUDGED), *_UNJUDGED)
_DIGITS = 4


def write_row(path: Path, result: dict[str, Any]) -> None:
    """Write a row, with its recordings as a table: columns, then a line for each."""
    recordings = [[_rounded(entry.get(column)) for column in _COLUMNS] for entry in result.get("conditions", [])]
    head = {key: value for key, value in result.items() if key != "conditions"}
    text = json.dumps({**head, "columns": _COLUMNS, "conditions": []}, indent=2, ensure_ascii=False)
    lines = ",\n".join(f"    {json.dumps(line, ensure_ascii=False)}" for line in recordings)
    path.parent.mkdir(parents=True, exist_ok=True)
    write_text(path, text.replace('"conditions": []', f'"conditions": [\n{lines}\n  ]') + "\n")


def read_row(path: Path) -> dict[str, Any]:
    """Read a row, which is stored to four digits."""
    stored: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    columns = stored.pop("columns")
    cells = [dict(zip(columns, line, strict=True)) for line in stored["conditions"]]
    stored["conditions"] = [{key: value for key, value in cell.items() if value is not None} for cell in cells]
    return stored


def stored_row(place: Workplace, row: PlannedRow, seed: int, made_from: dict[str, Any]) -> dict[str, Any] | None:
    """The row's file if it was measured from exactly this; a value None in `made_from` (a missing model) matches
    any."""
    path = place.row_file(row, seed)
    if not path.exists():
        return None
    stored = read_row(path)
    agrees = all(value is None or stored["made_from"].get(key) == value for key, value in made_from.items())
    return stored if agrees else None


def _rounded(value: Any) -> Any:
    return round(value, _DIGITS) if isinstance(value, float) else value
