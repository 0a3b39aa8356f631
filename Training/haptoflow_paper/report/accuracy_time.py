"""accuracy-time.json: every row's accuracy and cost, from which the chart and the page are generated."""

from __future__ import annotations

import datetime
import platform
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from haptoflow_paper.metrics.cell_figures import IDENTITY
from haptoflow_paper.metrics.judged_figures import JUDGED, spread
from haptoflow_paper.report.verdicts import verdict
from haptoflow_paper.rows.row_plan import OURS, PlannedRow
from haptoflow_paper.rows.row_summary import label_table, level_error_p90_db, over_labels, summary

_SEED_HEADLINES = ("level_error_db", "gfc_recording", "lsd_db")
_KEPT = ("fast", "kink_db", "drift_seconds")
_TIMES = ("ms_per_segment", "ms_paced")


def machine_words() -> str:
    """Processor and system of this machine, which published times must state."""
    model = platform.processor() or platform.machine()
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
        model = next((line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")), model)
    except OSError:
        pass
    return f"{model}, one thread, {platform.system()}"


def table(plan: Sequence[PlannedRow], measured: Mapping[str, Sequence[dict[str, Any]]]) -> dict[str, Any]:
    """measured: by row name one result for each seed (row_runner.measure_row), the first seed first. Rows that were
    not measured are left out and named in `not_measured`. Times are added by `with_times`."""

    def judged_against(row: PlannedRow) -> Sequence[dict[str, Any]]:
        own = row.against == row.name or row.against not in measured
        return [] if own else measured[row.against][0]["conditions"]

    rows = [_row(row, measured[row.name], judged_against(row)) for row in plan if row.name in measured]
    today = datetime.date.today().isoformat()
    return {"machine": machine_words(), "date": today, "not_measured": _absent(plan, rows), "rows": rows}


def timed_rows(table: Mapping[str, Any]) -> set[str]:
    """Names of the rows that a complete timing run holds: all except the references."""
    return {row["name"] for row in table["rows"] if row["block"] != "reference"}


def with_times(table: dict[str, Any], run: Mapping[str, Any] | None) -> dict[str, Any]:
    """The table with the times of one run; rows that it does not hold have no times."""
    nothing = dict.fromkeys(_TIMES)
    times = {} if run is None else run["rows"]
    rows = [{**row, **nothing, **times.get(row["name"], {})} for row in table["rows"]]
    timed = None if run is None else {key: value for key, value in run.items() if key != "rows"}
    return {**table, "timed": timed, "rows": rows}


def _absent(plan: Sequence[PlannedRow], rows: Sequence[dict[str, Any]]) -> list[str]:
    present = {row["name"] for row in rows}
    return [row.name for row in plan if row.name not in present]


def _row(
    row: PlannedRow, results: Sequence[dict[str, Any]], reference: Sequence[dict[str, Any]]
) -> dict[str, Any]:
    first = results[0]
    cells = first["conditions"]
    entry: dict[str, Any] = {
        "name": row.name,
        "block": row.block,
        "rival": row.rival_name,
        "family": row.family,
        "solver": row.solver,
        "steps": row.steps,
        "evaluations": row.evaluations,
        "parameters": first["parameters"],
        "bytes": first["bytes"],
        **dict.fromkeys(_TIMES),
        **_rounded(summary(cells)),
        "drift_db_per_min": _rounded(first["drift_db_per_min"]),
        "label_discrimination": _rounded(first["discrimination"]),
        **{key: _rounded(first[key]) for key in _KEPT if key in first},
        "recordings": len(cells),
        "every_fourth": row.every_fourth,
        "seeds": len(results),
    }
    if row.block == OURS and cells:
        entry["by_label"] = _rounded(label_table(cells))
    if cells and reference:
        entry["against"] = row.against
        entry["verdict"] = verdict(reference, cells)
    if len(results) > 1:
        entry["by_seed"] = _by_seed(results)
    return entry


def _by_seed(results: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """Figures of each seed on the recordings that all seeds were measured on."""
    keyed = [{tuple(cell[key] for key in IDENTITY): cell for cell in result["conditions"]} for result in results]
    shared = [key for key in keyed[0] if all(key in other for other in keyed)]
    common = [[cells[key] for key in shared] for cells in keyed]
    spreads = {figure.key: [spread(cells, figure) for cells in common] for figure in JUDGED}
    return {
        "seeds": [result["seed"] for result in results],
        "recordings": len(shared),
        "level_error_p90_db": [_rounded(level_error_p90_db(cells)) for cells in common],
        **{key: [_rounded(over_labels(cells, key)) for cells in common] for key in _SEED_HEADLINES},
        "medians": {
            key: [_rounded(None if found is None else found["median"]) for found in values]
            for key, values in spreads.items()
        },
    }


def _rounded(value: Any) -> Any:
    """Rounded to four digits, at any depth."""
    if isinstance(value, dict):
        return {key: _rounded(entry) for key, entry in value.items()}
    if isinstance(value, list):
        return [_rounded(entry) for entry in value]
    return round(float(value), 4) if isinstance(value, float) else value
