"""Writes a session's two files in the format of the Unity samples."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from haptoflow_training.export.whole_file import write_whole
from haptoflow_training.studies.log_columns import COLUMNS, FORMAT, VERSION


def write_session(folder: Path, sidecar: Mapping[str, Any], rows: Sequence[Mapping[str, Any]]) -> Path:
    """Write the table of rows. A column that a row does not have stays empty."""
    stem = f"{sidecar['study']}-P{sidecar['participant']:02d}-{sidecar['session']}"
    names = [column.name for column in COLUMNS[sidecar["study"]]]
    lines = [",".join(names), *(",".join(field_text(row.get(name)) for name in names) for row in rows)]
    path = folder / f"{stem}.csv"
    write_whole(path, ("\n".join(lines) + "\n").encode())
    document = {"format": FORMAT, "version": VERSION, **sidecar}
    write_whole(folder / f"{stem}.json", (json.dumps(document, indent=1) + "\n").encode())
    return path


def field_text(value: object) -> str:
    """Numbers with six decimals; None is an empty field."""
    if value is None:
        return ""
    return f"{value:.6f}".rstrip("0").rstrip(".") if isinstance(value, float) else str(value)
