"""Measures the planned rows, several at a time; finished rows are stored, so that an interrupted evaluation can be
resumed."""

from __future__ import annotations

import functools
import zlib
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
import torch

from haptoflow_benchmark.engine_library import EngineLibrary, default_engine
from haptoflow_benchmark.waveform_metrics import rms
from haptoflow_paper.codec.trainer import codec_reconstruction
from haptoflow_paper.report.row_metrics import kink_db
from haptoflow_paper.rows.reference_set import CODEC_ROW, ReferencePair, reference_waves
from haptoflow_paper.rows import accuracy
from haptoflow_paper.rows.accuracy import Yardstick
from haptoflow_paper.rows.closed_loop import closed_loop
from haptoflow_paper.rows.engine_generator import EngineGenerator
from haptoflow_paper.rows.row_plan import PlannedRow
from haptoflow_paper.rows.workplace import Workplace, read_row, stored_row, write_row
from haptoflow_paper.rows.row_summary import over_labels
from haptoflow_training.training.closed_loop import UPDATE_RATE_HZ, hop_positions
from haptoflow_training.export.model_file import read_model_file
from haptoflow_training.waveform import SAMPLE_RATE_HZ

UPDATE_RATES_HZ = (30.0, 72.0, 120.0)
FAST_SPEEDS_MPS = (0.5, 1.0, 1.5)
_SEED = 31
# Increased when a metric changes its meaning; rows of an earlier edition are measured again.
_METRICS_EDITION = 2
_SHORT_DRIFT_SECONDS, _LONG_DRIFT_SECONDS = 60.0, 600.0
_FAST_FIGURES = ("level_error_db", "gfc_recording", "lsd_db", "f0_error_percent", "continuity")
_SWEEP_SPEEDS = 25
_SWEEP_SECONDS = 4.0


# Set in each worker process: the workplace and the yardstick of all rows.
_worker: list[tuple[Workplace, Yardstick]] = []


def measure_rows(
    place: Workplace,
    yardstick: Yardstick,
    wanted: Sequence[tuple[PlannedRow, int]],
    workers: int,
    advance: Callable[[int], object] = lambda count: None,
) -> dict[tuple[str, int], dict[str, Any]]:
    """Measure rows and seeds in `workers` processes; returns their figures by name and seed. `advance` is called with 1
    after each."""
    # Forked processes share recordings and classifier without copying them. Each opens its own engine.
    with ProcessPoolExecutor(workers, get_context("fork"), _prepare_worker, (place, yardstick)) as pool:
        jobs = {pool.submit(_measure_in_worker, row, seed): (row.name, seed) for row, seed in wanted}
        figures = {}
        for job in as_completed(jobs):
            figures[jobs[job]] = job.result()
            advance(1)
    return figures


def _prepare_worker(place: Workplace, yardstick: Yardstick) -> None:
    torch.set_num_threads(1)
    _worker.append((place, yardstick))


def _measure_in_worker(row: PlannedRow, seed: int) -> dict[str, Any]:
    return measure_row(*_worker[0], row, seed)


def measure_row(place: Workplace, yardstick: Yardstick, row: PlannedRow, seed: int) -> dict[str, Any]:
    """Figures of one row and seed, read from its file if it was measured before with the same model and recordings."""
    origin = made_from(place, yardstick, row, seed)
    if stored := stored_row(place, row, seed, origin):
        return stored
    if row.is_reference:
        figures = _reference_figures(place, yardstick, row, seed)
    elif row.time_only:
        with generator_of(place, row, place.model_file(row, seed)) as generator:
            figures = {"discrimination": None, "drift_db_per_min": None, **_sizes(generator, row)}
    else:
        figures = _engine_figures(place, yardstick, row, seed)
    write_row(place.row_file(row, seed), {"made_from": origin, "name": row.name, "seed": seed, **figures})
    return read_row(place.row_file(row, seed))


def made_from(place: Workplace, yardstick: Yardstick, row: PlannedRow, seed: int) -> dict[str, Any]:
    """Everything that a row's figures depend on; graphs_crc32 is None if its model does not exist."""
    return {
        "configuration_crc32": place.configuration_crc32(row, seed),
        "graphs_crc32": _graphs_crc32(place, row, seed),
        "recordings_crc32": f"{yardstick.checksum:08x}",
        "metrics_edition": _METRICS_EDITION,
        "extended": row.extended,
        "reduced": _is_reduced(place, row, seed),
    }


def _graphs_crc32(place: Workplace, row: PlannedRow, seed: int) -> str | None:
    if row.name == CODEC_ROW:
        codec = place.codec_checkpoint
        return f"{zlib.crc32(codec.read_bytes()):08x}" if codec.exists() else None
    if row.is_reference:
        return ""
    model = place.model_file(row, seed)
    if not model.exists():
        return None
    return weights_crc32(model)


def weights_crc32(model: Path) -> str:
    """Of a file's graphs and tensors, without the header, which contains figures that this evaluation writes."""
    file = read_model_file(model)
    return f"{zlib.crc32(b''.join([*file.graphs.values(), *(tensor.tobytes() for tensor in file.tensors.values())])):08x}"


def _is_reduced(place: Workplace, row: PlannedRow, seed: int) -> bool:
    return place.quick or row.every_fourth or seed != row.seeds[0]


def _pairs(place: Workplace, yardstick: Yardstick, row: PlannedRow, seed: int) -> list[ReferencePair]:
    return accuracy.every_fourth(yardstick.pairs) if _is_reduced(place, row, seed) else yardstick.pairs


def _reference_figures(place: Workplace, yardstick: Yardstick, row: PlannedRow, seed: int) -> dict[str, Any]:
    pairs = _pairs(place, yardstick, row, seed)
    if row.name == CODEC_ROW:
        waves = codec_reconstruction(place.codec_checkpoint, [pair.recorded for pair in pairs])
    else:
        waves = reference_waves(row.name, pairs, _SEED)
    nothing = [np.zeros(0, dtype=np.float32)] * len(pairs)
    starts = [hop_positions(len(wave), UPDATE_RATE_HZ) for wave in waves]
    rows = accuracy.measure(pairs, accuracy.GeneratedSet(waves, nothing, starts))
    return {
        "discrimination": accuracy.label_discrimination(yardstick.classifier, pairs, waves),
        "conditions": rows,
        "parameters": 0,
        "bytes": 0,
        "drift_db_per_min": None,
    }


@functools.cache
def _engine(root: Path) -> EngineLibrary:
    return default_engine(root)


def generator_of(place: Workplace, row: PlannedRow, model: Path) -> EngineGenerator:
    """The row's tier of the file in this process's engine; close it after use."""
    return EngineGenerator(_engine(place.root), model, row.tier or None, row.solver, row.steps)


def _engine_figures(place: Workplace, yardstick: Yardstick, row: PlannedRow, seed: int) -> dict[str, Any]:
    pairs = _pairs(place, yardstick, row, seed)
    extended = row.extended and not place.quick
    drift_seconds = _LONG_DRIFT_SECONDS if extended else _SHORT_DRIFT_SECONDS
    with generator_of(place, row, place.model_file(row, seed)) as generator:
        made = accuracy.generate_set(generator, pairs, update_rate_hz=UPDATE_RATE_HZ, seed=_SEED)
        labels = np.arange(0, len(generator.embeddings), 4 if _is_reduced(place, row, seed) else 1)
        drift = accuracy.drift_db_per_minute(
            generator, labels, seconds=drift_seconds, update_rate_hz=UPDATE_RATE_HZ, seed=_SEED
        )
        rows = accuracy.measure(pairs, made)
        result: dict[str, Any] = {
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
    """Parameters of the network, and bytes of all graphs and tensors that generate a segment."""
    header = generator.header
    tier = next(entry for entry in header["tiers"] if entry["name"] == (row.tier or header["default_tier"]))
    names = [tier[key] for key in ("field", "level", "encoder", "decoder") if key in tier]
    has_skeleton = tier["kind"] in ("skeleton", "refine")
    natively = ("skeleton.", "level.", f"{tier['name']}.condition.") if has_skeleton else ()
    size = sum(
        blob["bytes"] for blob in header["blobs"] if blob["name"] in names or blob["name"].startswith(natively)
    )
    return {"parameters": tier["parameters"], "bytes": size}


def _fast_speeds(generator: EngineGenerator, pairs: list[ReferencePair]) -> list[dict[str, Any]]:
    """The figures of every fast speed at every update rate."""
    table = []
    fast = [pair for pair in pairs if _is_fast(pair)]
    for rate in UPDATE_RATES_HZ:
        made = accuracy.generate_set(generator, fast, update_rate_hz=rate, seed=_SEED, open_loop=False)
        rows = accuracy.measure(fast, made)
        for speed in FAST_SPEEDS_MPS:
            chosen = [entry for entry in rows if entry["speed_mps"] == speed]
            figures = {key: over_labels(chosen, key) for key in _FAST_FIGURES}
            table.append({"speed_mps": speed, "update_rate_hz": rate, **figures})
    return table


def _is_fast(pair: ReferencePair) -> bool:
    return pair.condition.kind == "constant" and pair.condition.speed_mps in FAST_SPEEDS_MPS


def _level_kinks(generator: EngineGenerator) -> dict[str, float]:
    """The largest kinks of the level across speed, in dB for a step of log speed: median and worst label."""
    speeds = np.geomspace(0.02, 1.5, _SWEEP_SPEEDS)
    samples = int(SAMPLE_RATE_HZ * _SWEEP_SECONDS)
    kinks = []
    for label in range(len(generator.embeddings)):
        motions = np.zeros((_SWEEP_SPEEDS, samples, 3), dtype=np.float32)
        motions[:, :, 0], motions[:, :, 2] = speeds[:, None], 1.0
        run = closed_loop(
            generator, motions, np.full(_SWEEP_SPEEDS, label), update_rate_hz=UPDATE_RATE_HZ, seed=_SEED
        )
        kinks.append(kink_db(20.0 * np.log10([rms(wave[400:]) + 1e-9 for wave in run.waves])))
    return {"median": float(np.median(kinks)), "worst": float(np.max(kinks))}
