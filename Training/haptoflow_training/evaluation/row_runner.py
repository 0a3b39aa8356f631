"""Measures the planned rows one after the other; what is measured is kept, so that a stopped evaluation goes on."""

from __future__ import annotations

import dataclasses
import json
import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from tqdm import tqdm

from haptoflow_training.evaluation import accuracy
from haptoflow_training.evaluation.accuracy import Yardstick
from haptoflow_training.evaluation.closed_loop import hop_positions, run_closed_loop
from haptoflow_training.evaluation.engine_library import EngineGenerator, EngineLibrary
from haptoflow_training.evaluation.metrics import kink_db, rms
from haptoflow_training.evaluation.reference_rows import reference_waves
from haptoflow_training.evaluation.reference_set import ReferencePair
from haptoflow_training.evaluation.row_plan import PlannedRow
from haptoflow_training.export.model_file import read_model_file
from haptoflow_training.training.config import load_config
from haptoflow_training.training.job_lanes import Job, run_jobs
from haptoflow_training.training.run_log import write_json

UPDATE_RATE_HZ = 72.0
UPDATE_RATES_HZ = (30.0, 72.0, 120.0)
FAST_SPEEDS_MPS = (0.5, 1.0, 1.5)
_SEED = 31
_SHORT_DRIFT_SECONDS, _LONG_DRIFT_SECONDS = 60.0, 600.0
_SWEEP_SPEEDS = 25
_SWEEP_SECONDS = 4.0


@dataclass(frozen=True)
class Workplace:
    """root: the repository. work: where trainings, models and rows are kept (not committed). quick: every fourth
    recording and no long measurements, and results apart from the whole ones."""

    root: Path
    plan: Path
    work: Path
    store: Path
    quick: bool = False

    def model_file(self, row: PlannedRow, seed: int) -> Path:
        if row.model.endswith(".haptoflow"):
            return self.root / row.model
        return self.work / "models" / f"{row.model}-{seed}.haptoflow"

    def config_file(self, model: str) -> Path:
        return self.plan.parent / f"{model}.toml"

    def run_folder(self, model: str, seed: int) -> Path:
        return self.work / "runs" / f"{model}-{seed}"

    def row_file(self, row: PlannedRow, seed: int) -> Path:
        return self.work / ("rows-quick" if self.quick else "rows") / f"{row.name}-{seed}.json"


def train_models(place: Workplace, rows: Sequence[PlannedRow], lanes: int) -> None:
    """Train what the rows need and is not there yet, `lanes` models at a time; goes on after an interruption.

    InputError names the log of a training that failed, as one does whose folder belongs to another configuration.
    """
    wanted = {place.model_file(row, seed): (row.model, seed) for row in rows if not row.is_reference for seed in row.seeds}
    jobs = [
        _training(place, model, seed, out)
        for out, (model, seed) in wanted.items()
        if not (out.exists() and _is_as_configured(place, model, seed))
    ]
    codecs = {job.product: job for model, _ in wanted.values() for job in _codec_training(place, model)}
    with tqdm(total=len(jobs) + len(codecs), desc="trainings", unit="model") as bar:

        def watch(finished: int) -> None:
            bar.n = finished
            bar.refresh()

        run_jobs(list(codecs.values()), lanes, watch)
        run_jobs(jobs, lanes, lambda finished: watch(len(codecs) + finished))


def _is_as_configured(place: Workplace, model: str, seed: int) -> bool:
    """Whether a model that is there was trained as its configuration says today; True where nothing tells."""
    summary = place.run_folder(model, seed) / "run.json"
    if model.endswith(".haptoflow") or not summary.exists():
        return True
    trained: dict[str, Any] = json.loads(summary.read_text(encoding="utf-8"))["configuration"]
    today = dataclasses.replace(load_config(place.config_file(model)), seed=seed).to_dict()
    return trained == json.loads(json.dumps(today))


def _training(place: Workplace, model: str, seed: int, out: Path) -> Job:
    folder = place.run_folder(model, seed)
    words = ["train", "--config", str(place.config_file(model)), "--seed", str(seed)]
    words += ["--out", str(folder), "--store", str(place.store), "--export", str(out)]
    return Job(f"{model}, seed {seed}", words, folder / "train.log", out)


def _codec_training(place: Workplace, model: str) -> list[Job]:
    """Of the small codec that the model's latents come from, where it is not trained yet."""
    if model.endswith(".haptoflow"):
        return []
    representation = load_config(place.config_file(model)).model.representation
    if representation["kind"] != "small-codec":
        return []
    checkpoint = place.root / representation["checkpoint"]
    if checkpoint.exists():
        return []
    codec = place.root / "Training" / "configs" / "codec-small.toml"
    words = ["train-codec", "--config", str(codec), "--store", str(place.store), "--out", str(checkpoint.parent)]
    return [Job("the small codec", words, checkpoint.parent / "train.log", checkpoint)]


def measure_row(
    place: Workplace, engine: EngineLibrary, yardstick: Yardstick, row: PlannedRow, seed: int
) -> dict[str, Any]:
    """Figures of one row and seed, from its file where it was measured before on the same model and recordings."""
    path = place.row_file(row, seed)
    made_from = _made_from(place, yardstick, row, seed)
    if path.exists():
        stored: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
        if stored.get("made_from") == made_from:
            return stored
    if row.is_reference:
        figures = _reference_figures(place, yardstick, row, seed)
    elif row.time_only:
        with EngineGenerator(engine, place.model_file(row, seed), row.tier or None, row.solver, row.steps) as generator:
            figures = {"summary": {}, "discrimination": None, "drift_db_per_min": None, **_sizes(generator, row)}
    else:
        figures = _engine_figures(place, engine, yardstick, row, seed)
    result = {"made_from": made_from, "name": row.name, "seed": seed, **figures}
    path.parent.mkdir(parents=True, exist_ok=True)
    write_json(path, result)
    return result


def _made_from(place: Workplace, yardstick: Yardstick, row: PlannedRow, seed: int) -> dict[str, Any]:
    model = place.model_file(row, seed)
    # Of what computes alone: the header carries figures that this evaluation writes.
    crc = 0 if row.is_reference else zlib.crc32(b"".join(read_model_file(model).graphs.values()))
    made_from = {"graphs_crc32": f"{crc:08x}", "recordings_crc32": f"{yardstick.checksum:08x}"}
    return {**made_from, "extended": row.extended, "reduced": _is_reduced(place, row, seed)}


def _is_reduced(place: Workplace, row: PlannedRow, seed: int) -> bool:
    return place.quick or seed != row.seeds[0]


def _pairs(place: Workplace, yardstick: Yardstick, row: PlannedRow, seed: int) -> list[ReferencePair]:
    return accuracy.every_fourth(yardstick.pairs) if _is_reduced(place, row, seed) else yardstick.pairs


def _reference_figures(place: Workplace, yardstick: Yardstick, row: PlannedRow, seed: int) -> dict[str, Any]:
    pairs = _pairs(place, yardstick, row, seed)
    waves = reference_waves(row.name, pairs, _SEED)
    nothing = [np.zeros(0, dtype=np.float32)] * len(pairs)
    starts = [hop_positions(len(wave), UPDATE_RATE_HZ) for wave in waves]
    rows = accuracy.measure(pairs, accuracy.GeneratedSet(waves, nothing, starts))
    return {
        "summary": accuracy.summary(rows),
        "discrimination": accuracy.label_discrimination(yardstick.classifier, pairs, waves),
        "conditions": rows,
        "parameters": 0,
        "bytes": 0,
        "drift_db_per_min": None,
    }


def _engine_figures(
    place: Workplace, engine: EngineLibrary, yardstick: Yardstick, row: PlannedRow, seed: int
) -> dict[str, Any]:
    model = place.model_file(row, seed)
    pairs = _pairs(place, yardstick, row, seed)
    extended = row.extended and not place.quick
    drift_seconds = _LONG_DRIFT_SECONDS if extended else _SHORT_DRIFT_SECONDS
    hops = accuracy.hops_of(pairs, UPDATE_RATE_HZ) + int(drift_seconds * UPDATE_RATE_HZ)
    with EngineGenerator(engine, model, row.tier or None, row.solver, row.steps) as generator:
        with tqdm(total=hops, desc=f"{row.name}, seed {seed}", unit="hop", leave=False) as bar:
            made = accuracy.generate_set(
                generator, generator.embeddings, pairs, update_rate_hz=UPDATE_RATE_HZ, seed=_SEED, advance=bar.update
            )
            embeddings = generator.embeddings[::4] if _is_reduced(place, row, seed) else generator.embeddings
            drift = accuracy.drift_db_per_minute(
                generator, embeddings, seconds=drift_seconds, update_rate_hz=UPDATE_RATE_HZ, seed=_SEED,
                advance=bar.update,
            )  # fmt: skip
        rows = accuracy.measure(pairs, made)
        result: dict[str, Any] = {
            "summary": accuracy.summary(rows),
            "discrimination": accuracy.label_discrimination(yardstick.classifier, pairs, made.closed),
            "conditions": rows,
            **_sizes(generator, row),
            "drift_db_per_min": drift[0],
            "drift_worst_db_per_min": drift[1],
            "drift_seconds": drift_seconds,
        }
        if extended:
            result["fast"] = _fast_speeds(generator, pairs)
            result["kink_db"] = _level_kinks(generator)
        return result


def _sizes(generator: EngineGenerator, row: PlannedRow) -> dict[str, int]:
    """Parameters of the network, and bytes of all graphs that a segment goes through."""
    header = generator.header
    tier = next(entry for entry in header["tiers"] if entry["name"] == (row.tier or header["default_tier"]))
    names = [tier[key] for key in ("field", "level", "encoder", "decoder") if key in tier]
    size = sum(blob["bytes"] for blob in header["blobs"] if blob["name"] in names)
    return {"parameters": tier["parameters"], "bytes": size}


def _fast_speeds(generator: EngineGenerator, pairs: list[ReferencePair]) -> list[dict[str, Any]]:
    """Every fast speed at every update rate."""
    table = []
    fast = [pair for pair in pairs if pair.condition.kind == "constant" and pair.condition.speed_mps in FAST_SPEEDS_MPS]
    for rate in UPDATE_RATES_HZ:
        made = accuracy.generate_set(
            generator, generator.embeddings, fast, update_rate_hz=rate, seed=_SEED, open_loop=False
        )
        rows = accuracy.measure(fast, made)
        for speed in FAST_SPEEDS_MPS:
            chosen = [entry for entry in rows if entry["speed_mps"] == speed]
            figures = accuracy.summary(chosen)
            keys = ("level_error_db", "gfc_recording", "lsd_db", "f0_error_percent", "continuity")
            table.append({"speed_mps": speed, "update_rate_hz": rate, **{key: figures[key] for key in keys}})
    return table


def _level_kinks(generator: EngineGenerator) -> dict[str, float]:
    """How smooth the level is across speed, in dB for a step of log speed: median and worst label."""
    speeds = np.geomspace(0.02, 1.5, _SWEEP_SPEEDS)
    samples = int(2000 * _SWEEP_SECONDS)
    kinks = []
    for embedding in generator.embeddings:
        motions = np.zeros((_SWEEP_SPEEDS, samples, 3), dtype=np.float32)
        motions[:, :, 0], motions[:, :, 2] = speeds[:, None], 1.0
        rows = np.tile(embedding, (_SWEEP_SPEEDS, 1))
        run = run_closed_loop(generator, rows, motions, update_rate_hz=UPDATE_RATE_HZ, seed=_SEED)
        kinks.append(kink_db(20.0 * np.log10([rms(wave[400:]) + 1e-9 for wave in run.waves])))
    return {"median": float(np.median(kinks)), "worst": float(np.max(kinks))}
