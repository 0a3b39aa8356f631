"""Measures the planned rows one after the other; what is measured is kept, so that a stopped evaluation goes on."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import zlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from tqdm import tqdm

from haptoflow_training.errors import InputError
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
    """root: the repository. work: where trainings, models and rows are kept (not committed). quick: leave out the long
    measurements, and keep the results apart from the whole ones."""

    root: Path
    plan: Path
    work: Path
    store: Path
    quick: bool = False

    def model_file(self, row: PlannedRow, seed: int) -> Path:
        if row.model.endswith(".haptoflow"):
            return self.root / row.model
        return self.work / "models" / f"{row.model}-{seed}.haptoflow"

    def row_file(self, row: PlannedRow, seed: int) -> Path:
        return self.work / ("rows-quick" if self.quick else "rows") / f"{row.name}-{seed}.json"


def train_model(place: Workplace, row: PlannedRow, seed: int) -> None:
    """Train what the row needs, where it is not there yet: goes on after an interruption."""
    out = place.model_file(row, seed)
    if out.exists():
        return
    config = place.plan.parent / f"{row.model}.toml"
    folder = place.work / "runs" / f"{row.model}-{seed}"
    folder.mkdir(parents=True, exist_ok=True)
    command = [sys.executable, "-m", "haptoflow_training", "train", "--config", str(config), "--seed", str(seed)]
    command += ["--out", str(folder), "--store", str(place.store), "--export", str(out)]
    _train_codec(place, config)
    _run(command, place.root)
    if not out.exists():
        raise InputError(f"{config}: training did not finish; run `npm run evaluate` again to go on")


def _train_codec(place: Workplace, config: Path) -> None:
    """The small codec that the configuration's latents come from, where it is not trained yet."""
    representation = load_config(config).model.representation
    if representation["kind"] != "small-codec" or (place.root / representation["checkpoint"]).exists():
        return
    folder = (place.root / representation["checkpoint"]).parent
    codec = place.root / "Training" / "configs" / "codec-small.toml"
    command = [sys.executable, "-m", "haptoflow_training", "train-codec", "--config", str(codec)]
    _run([*command, "--store", str(place.store), "--out", str(folder)], place.root)


def _run(command: list[str], folder: Path) -> None:
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
    if subprocess.run(command, env=environment, cwd=folder, check=False).returncode != 0:
        raise InputError(f"`{' '.join(command[3:7])}` did not finish; run `npm run evaluate` again to go on")


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
        figures = _reference_figures(yardstick, row)
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
    return {**made_from, "extended": row.extended, "reduced": seed != row.seeds[0]}


def _reference_figures(yardstick: Yardstick, row: PlannedRow) -> dict[str, Any]:
    pairs = yardstick.pairs
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
    reduced = seed != row.seeds[0]
    pairs = accuracy.every_fourth(yardstick.pairs) if reduced else yardstick.pairs
    extended = row.extended and not place.quick
    drift_seconds = _LONG_DRIFT_SECONDS if extended else _SHORT_DRIFT_SECONDS
    hops = accuracy.hops_of(pairs, UPDATE_RATE_HZ) + int(drift_seconds * UPDATE_RATE_HZ)
    with EngineGenerator(engine, model, row.tier or None, row.solver, row.steps) as generator:
        with tqdm(total=hops, desc=f"{row.name}, seed {seed}", unit="hop", leave=False) as bar:
            made = accuracy.generate_set(
                generator, generator.embeddings, pairs, update_rate_hz=UPDATE_RATE_HZ, seed=_SEED, advance=bar.update
            )
            drift = accuracy.drift_db_per_minute(
                generator, generator.embeddings[::4] if reduced else generator.embeddings, seconds=drift_seconds, update_rate_hz=UPDATE_RATE_HZ, seed=_SEED,
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
