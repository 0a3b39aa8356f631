"""accuracy-time.json: every row's accuracy beside its cost, as the chart and the documentation read it."""

from __future__ import annotations

import datetime
import platform
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from haptoflow_training.evaluation.row_plan import PlannedRow
from haptoflow_training.evaluation.timing import Milliseconds

_FIGURES = (
    "level_error_db",
    "level_error_p90_db",
    "level_error_worst_db",
    "gfc_recording",
    "gfc_label_worst",
    "gfc_segment",
    "rmse",
    "lsd_db",
    "band_error_db",
    "f0_error_percent",
    "harmonic_share",
    "continuity",
)


def machine_words() -> str:
    """Processor and system, in words: times mean nothing without them."""
    model = platform.processor() or platform.machine()
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
        model = next((line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")), model)
    except OSError:
        pass
    return f"{model}, one thread, {platform.system()}"


def table(
    plan: Sequence[PlannedRow],
    measured: dict[str, list[dict[str, Any]]],
    hot: dict[str, Milliseconds],
    paced: dict[str, Milliseconds],
) -> dict[str, Any]:
    """measured: for each row's name one result per seed (row_runner.measure_row). Rows that were not measured are
    left out and named in `not_measured`."""
    rows = [
        _row(row, measured[row.name], hot.get(row.name), paced.get(row.name)) for row in plan if row.name in measured
    ]
    today = datetime.date.today().isoformat()
    return {"machine": machine_words(), "date": today, "not_measured": _absent(plan, rows), "rows": rows}


def merged(old: dict[str, Any], new: dict[str, Any], plan: Sequence[PlannedRow]) -> dict[str, Any]:
    """Rows measured now replace their old ones; the others stay as they are, with the times of their own run."""
    by_name = {row["name"]: row for row in [*old["rows"], *new["rows"]]}
    rows = [by_name[row.name] for row in plan if row.name in by_name]
    return {**new, "not_measured": _absent(plan, rows), "rows": rows}


def _absent(plan: Sequence[PlannedRow], rows: list[dict[str, Any]]) -> list[str]:
    present = {row["name"] for row in rows}
    return [row.name for row in plan if row.name not in present]


def _row(
    row: PlannedRow, results: list[dict[str, Any]], hot: Milliseconds | None, paced: Milliseconds | None
) -> dict[str, Any]:
    summaries = [result["summary"] for result in results]
    entry: dict[str, Any] = {
        "name": row.name,
        "family": row.family,
        "solver": row.solver,
        "steps": row.steps,
        "evaluations": row.evaluations,
        "parameters": results[0]["parameters"],
        "bytes": results[0]["bytes"],
        "ms_per_segment": None if hot is None else {"p50": round(hot.p50, 4), "p99": round(hot.p99, 4)},
        "ms_paced": None if paced is None else {"p50": round(paced.p50, 4), "p99": round(paced.p99, 4)},
    }
    for key in _FIGURES:
        entry[key] = _mean([summary.get(key) for summary in summaries])
        interval = [summary.get(f"{key}_interval") for summary in summaries]
        if interval[0] is not None:
            entry[f"{key}_interval"] = [round(float(value), 4) for value in np.mean(interval, axis=0)]
        if len(summaries) > 1 and summaries[0].get(key) is not None:
            entry[f"{key}_seeds"] = [round(float(summary[key]), 4) for summary in summaries]
    entry["drift_db_per_min"] = _mean([result["drift_db_per_min"] for result in results])
    entry["label_discrimination"] = _mean([result["discrimination"] for result in results])
    for key in ("fast", "kink_db", "drift_seconds"):
        if key in results[0]:
            entry[key] = results[0][key]
    entry["seeds"] = len(results)
    return entry


def _mean(values: list[float | None]) -> float | None:
    present = [value for value in values if value is not None]
    return round(float(np.mean(present)), 4) if present else None
