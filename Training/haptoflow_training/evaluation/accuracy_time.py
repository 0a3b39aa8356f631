"""accuracy-time.json: every row's accuracy beside its cost, as the chart and the documentation read it."""

from __future__ import annotations

import datetime
import platform
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from haptoflow_training.evaluation.accuracy import level_error_p90_db, over_labels
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
_SEED_FIGURES = ("level_error_db", "gfc_recording", "lsd_db")


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
    kept = {"model_sha256": old["model_sha256"]} if "model_sha256" in old else {}
    return {**new, **kept, "not_measured": _absent(plan, rows), "rows": rows}


def with_earlier_times(new: dict[str, Any], old: dict[str, Any]) -> dict[str, Any]:
    """Rows that were not timed now, since their models are not there, keep the times of an earlier run."""
    earlier = {row["name"]: row for row in old["rows"]}
    rows = []
    for row in new["rows"]:
        before = earlier.get(row["name"], {})
        if row["ms_per_segment"] is None and before.get("ms_per_segment") is not None:
            row = {**row, **{key: before.get(key) for key in ("ms_per_segment", "ms_paced", "timed_on")}}
        rows.append(row)
    return {**new, "rows": rows}


def _absent(plan: Sequence[PlannedRow], rows: list[dict[str, Any]]) -> list[str]:
    present = {row["name"] for row in rows}
    return [row.name for row in plan if row.name not in present]


def _row(
    row: PlannedRow, results: list[dict[str, Any]], hot: Milliseconds | None, paced: Milliseconds | None
) -> dict[str, Any]:
    first = results[0]
    figures = first["summary"]
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
        "timed_on": None if hot is None else datetime.date.today().isoformat(),
    }
    for key in _FIGURES:
        entry[key] = _rounded(figures.get(key))
        if (interval := figures.get(f"{key}_interval")) is not None:
            entry[f"{key}_interval"] = [round(float(value), 4) for value in interval]
    entry["drift_db_per_min"] = _rounded(first["drift_db_per_min"])
    entry["label_discrimination"] = _rounded(first["discrimination"])
    for key in ("fast", "kink_db", "drift_seconds"):
        if key in first:
            entry[key] = first[key]
    entry["recordings"] = len(first.get("conditions", ()))
    entry["seeds"] = len(results)
    if len(results) > 1:
        entry["by_seed"] = _by_seed(results)
    return entry


def _by_seed(results: list[dict[str, Any]]) -> dict[str, Any]:
    """Figures of each seed on the recordings that all of them were measured on."""
    keyed = [{_identity(condition): condition for condition in result["conditions"]} for result in results]
    shared = [key for key in keyed[0] if all(key in other for other in keyed)]
    common = [[conditions[key] for key in shared] for conditions in keyed]
    return {
        "seeds": [result["seed"] for result in results],
        "recordings": len(shared),
        "level_error_p90_db": [_rounded(level_error_p90_db(conditions)) for conditions in common],
        **{key: [_rounded(over_labels(conditions, key)) for conditions in common] for key in _SEED_FIGURES},
    }


def _identity(condition: dict[str, Any]) -> tuple[Any, ...]:
    return tuple(condition[key] for key in ("label", "kind", "speed_mps", "force_newtons"))


def _rounded(value: float | None) -> float | None:
    return None if value is None else round(float(value), 4)
