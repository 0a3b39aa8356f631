"""Measured rows as files: what is measured once need not be again, on another machine neither.

A row's file holds its summary and, by recording, the figures that tell where it is good and where it is not.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from haptoflow_training.evaluation.row_plan import PlannedRow
from haptoflow_training.evaluation.workplace import Workplace
from haptoflow_training.training.run_log import write_text

_IDENTITY = ("label", "kind", "speed_mps", "force_newtons")
_FIGURES = ("level_error_db", "gfc_recording", "lsd_db", "f0_error_percent", "harmonic_share")
_DIGITS = 4


def write_row(path: Path, result: dict[str, Any]) -> None:
    """Write a row, its recordings as a table: columns, then a line for each."""
    columns = (*_IDENTITY, *_FIGURES)
    recordings = [[_rounded(entry.get(column)) for column in columns] for entry in result.get("conditions", [])]
    head = {key: value for key, value in result.items() if key != "conditions"}
    text = json.dumps({**head, "columns": columns, "conditions": []}, indent=2, ensure_ascii=False)
    lines = ",\n".join(f"    {json.dumps(line, ensure_ascii=False)}" for line in recordings)
    path.parent.mkdir(parents=True, exist_ok=True)
    write_text(path, text.replace('"conditions": []', f'"conditions": [\n{lines}\n  ]') + "\n")


def read_row(path: Path) -> dict[str, Any]:
    """A row as it was measured; of its recordings, what `write_row` keeps."""
    stored: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    columns = stored.pop("columns")
    stored["conditions"] = [dict(zip(columns, line, strict=True)) for line in stored["conditions"]]
    return stored


def stored_row(place: Workplace, row: PlannedRow, seed: int, made_from: dict[str, Any]) -> dict[str, Any] | None:
    """The row's file, where it was measured from just this; a value None in `made_from` (a model that is not there)
    agrees with any."""
    path = place.row_file(row, seed)
    if not path.exists():
        return None
    stored = read_row(path)
    agrees = all(value is None or stored["made_from"].get(key) == value for key, value in made_from.items())
    return stored if agrees else None


def _rounded(value: Any) -> Any:
    return round(value, _DIGITS) if isinstance(value, float) else value
