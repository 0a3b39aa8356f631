"""The history of all timing runs. Which run is published follows from their order alone, so that none can be picked.

The published run is the first one with the shipped model that holds every row of the table; without such a run, the
first one that left out no row by request. Later runs are added to the history and change nothing until the model
changes. Models are identified by their graphs, because the header holds figures that are written after the measurement.
"""

from __future__ import annotations

import json
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import Any

from haptoflow_paper.rows.timing import Milliseconds
from haptoflow_training.training.run_log import write_text

_DIGITS = 4


def timing_run(
    hot: Mapping[str, Milliseconds],
    paced: Mapping[str, Milliseconds],
    *,
    date: str,
    commit: str,
    graphs_sha256: str,
    is_complete: bool,
    machine: str,
    load_before: Sequence[float],
    load_after: Sequence[float],
) -> dict[str, Any]:
    """A run as stored in the history. graphs_sha256: of the shipped model. is_complete: every row whose model exists
    was timed. load_*: the machine's load averages over 1, 5 and 15 minutes."""
    rows = {name: {"ms_per_segment": _shown(hot[name]), "ms_paced": _shown(paced[name])} for name in hot}
    loads = [[round(value, 2) for value in load] for load in (load_before, load_after)]
    return {
        "date": date, "commit": commit, "graphs_sha256": graphs_sha256, "is_complete": is_complete, "machine": machine,
        "load_before": loads[0], "load_after": loads[1], "rows": rows,
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
