"""The time of a segment: one at a time through the engine, every row in the same run, in random order.

Two paces: hot (one after the other) and live (one every 1/72 s, with the caches of a machine that does other work in
between). Times about double at the live pace, which is the one that matters in use.
"""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from haptoflow_training.training.closed_loop import SegmentSource
from haptoflow_training.models.label_embedding import PHASES
from haptoflow_training.whole_file import write_text

_WARM_UP_RUNS = 20


@dataclass(frozen=True)
class TimedSource:
    name: str
    source: SegmentSource


@dataclass(frozen=True)
class Milliseconds:
    p50: float
    p99: float


def _once(source: SegmentSource, generator: np.random.Generator) -> float:
    embedding = generator.standard_normal((1, 64)).astype(np.float32)
    previous = generator.standard_normal((1, 200)).astype(np.float32)
    noise = generator.standard_normal((1, 200)).astype(np.float32)
    motion = np.array([[0.1 + 0.4 * generator.random(), 0.0, 1.0]], dtype=np.float32)
    phases = generator.random((1, PHASES)).astype(np.float32)
    begin = time.perf_counter()
    source.generate(embedding, motion, previous, noise, phases)
    return 1e3 * (time.perf_counter() - begin)


def time_sources(
    sources: Sequence[TimedSource],
    *,
    blocks: int,
    runs_per_block: int,
    period_seconds: float,
    seed: int,
    advance: Callable[[int], None] = lambda count: None,
) -> dict[str, Milliseconds]:
    """p50 and p99 of each source; period_seconds 0 for hot, else the time from one segment's start to the next.

    Blocks of all sources are shuffled together, so that a disturbance of the machine affects all of them.
    """
    generator = np.random.default_rng(seed)
    times: dict[str, list[float]] = {entry.name: [] for entry in sources}
    order = np.repeat(np.arange(len(sources)), blocks)
    generator.shuffle(order)
    for index in order:
        entry = sources[index]
        for _ in range(3 if period_seconds else _WARM_UP_RUNS):
            _once(entry.source, generator)
        due = time.perf_counter()
        for _ in range(runs_per_block):
            if period_seconds:
                due += period_seconds
                time.sleep(max(0.0, due - time.perf_counter()))
            times[entry.name].append(_once(entry.source, generator))
        advance(1)
    return {
        name: Milliseconds(float(np.quantile(values, 0.5)), float(np.quantile(values, 0.99)))
        for name, values in times.items()
    }


_DIGITS = 4


def timing_run(
    hot: Mapping[str, Milliseconds],
    paced: Mapping[str, Milliseconds],
    *,
    date: str,
    commit: str,
    graphs_sha256: str,
    is_complete: bool,
    untrained: Sequence[str],
    machine: str,
    load_before: Sequence[float],
    load_after: Sequence[float],
) -> dict[str, Any]:
    """A run as stored in the history. graphs_sha256: of the shipped model. is_complete: every measured row
    was timed. untrained: rows that were timed with untrained networks of the same sizes. load_*: the machine's load
    averages over 1, 5 and 15 minutes."""
    rows = {name: {"ms_per_segment": _shown(hot[name]), "ms_paced": _shown(paced[name])} for name in hot}
    loads = [[round(value, 2) for value in load] for load in (load_before, load_after)]
    return {
        "date": date, "commit": commit, "graphs_sha256": graphs_sha256, "is_complete": is_complete,
        "untrained": list(untrained), "machine": machine, "load_before": loads[0], "load_after": loads[1], "rows": rows,
    }  # fmt: skip


def _shown(times: Milliseconds) -> dict[str, float]:
    return {"p50": round(times.p50, _DIGITS), "p99": round(times.p99, _DIGITS)}


def read_history(path: Path) -> list[dict[str, Any]]:
    """All runs, oldest first; none if the file does not exist yet."""
    if not path.exists():
        return []
    runs: list[dict[str, Any]] = json.loads(path.read_text(encoding="utf-8"))["runs"]
    return runs


def append_run(path: Path, run: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Append `run` to the history and write it; existing entries never change."""
    runs = [*read_history(path), dict(run)]
    lines = ",\n".join(f"    {json.dumps(entry, ensure_ascii=False)}" for entry in runs)
    write_text(path, f'{{\n  "runs": [\n{lines}\n  ]\n}}\n')
    return runs


def published_run(
    runs: Sequence[Mapping[str, Any]], graphs_sha256: str, wanted: Collection[str]
) -> Mapping[str, Any] | None:
    """The model's first run that holds every wanted row, else its first complete one; None if there is neither."""
    of_model = [run for run in runs if run["graphs_sha256"] == graphs_sha256]
    whole = (run for run in of_model if set(wanted) <= set(run["rows"]))
    return next(whole, next((run for run in of_model if run["is_complete"]), None))
