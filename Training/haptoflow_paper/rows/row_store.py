"""Stores measured rows as files, so that a row is measured only once.

A row's file holds all figures of each recording. Summaries are not stored, so that they can be defined anew without
measuring again.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from haptoflow_paper.metrics.cell_figures import IDENTITY
from haptoflow_paper.metrics.judged_figures import JUDGED
from haptoflow_paper.rows.row_plan import PlannedRow
from haptoflow_paper.rows.workplace import Workplace
from haptoflow_training.training.run_log import write_text

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
