"""Writes sessions: the two files of one in the format of the Unity samples, or all of a study as one table."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from haptoflow_training.studies.log_columns import COLUMNS, FORMAT, VERSION
from haptoflow_training.studies.session_file import Session
from haptoflow_training.whole_file import write_whole

OWN_COLUMNS = ("participant", "session", "simulated")


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


def merged_csv(study: str, sessions: Sequence[Session]) -> str:
    """Participant, session and whether it was simulated (0 or 1), then the log's own columns."""
    names = [column.name for column in COLUMNS[study]]
    text = io.StringIO(newline="")
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([*OWN_COLUMNS, *names])
    for session in sessions:
        own = (session.participant, session.session, int(session.is_simulated))
        writer.writerows([*own, *(field_text(row[name]) for name in names)] for row in session.rows)
    return text.getvalue()
