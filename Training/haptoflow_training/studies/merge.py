"""Merges all sessions of a study into one table with a row for each answered trial."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence

from haptoflow_training.studies.log_columns import COLUMNS
from haptoflow_training.studies.session_file import Session
from haptoflow_training.studies.session_writer import field_text

OWN_COLUMNS = ("participant", "session", "simulated")


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
