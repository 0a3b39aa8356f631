"""Reads one session: its log and its sidecar, compared with each other."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from haptoflow_training.studies.log_columns import COLUMNS, PLANNED, Value
from haptoflow_training.studies.log_table import Row, read_rows
from haptoflow_training.studies.problems import Problem, ranges, shown
from haptoflow_training.studies.sidecar_file import read_sidecar

NAME = re.compile(r"(latency|similarity)-P(\d{1,9})-([0-9a-f]{8})")


@dataclass(frozen=True)
class Session:
    """One participant's session; rows in the order of the file."""

    path: Path
    study: str
    participant: int
    session: str
    sidecar: Mapping[str, Any]
    rows: Sequence[Row]

    @property
    def is_simulated(self) -> bool:
        return bool(self.sidecar["simulated"])


def read_session(csv_path: Path) -> tuple[Session | None, list[Problem]]:
    """The session of STUDY-PARTICIPANT-SESSION.csv and its sidecar; None if either cannot be read at all."""
    name = NAME.fullmatch(csv_path.stem)
    if name is None:
        raise ValueError(f"{csv_path.name}: no name of a session")
    problems: list[Problem] = []
    sidecar_path = csv_path.with_suffix(".json")
    sidecar = read_sidecar(sidecar_path, problems)
    rows = read_rows(csv_path, COLUMNS[name[1]], problems)
    if sidecar is None or rows is None:
        return None, problems
    for key, expected in (("study", name[1]), ("participant", int(name[2])), ("session", name[3])):
        if sidecar[key] != expected:
            what = f"key '{key}' is {shown(sidecar[key])}; the file's name says {expected}"
            problems.append(Problem(sidecar_path, what))
    if not problems:
        problems += _against_plan(csv_path, sidecar, rows)
        problems += _unanswered(csv_path, sidecar, rows)
    return Session(csv_path, name[1], int(name[2]), name[3], sidecar, [row for _, row in rows]), problems


def _against_plan(path: Path, sidecar: Mapping[str, Any], rows: Sequence[tuple[int, Row]]) -> list[Problem]:
    """Report trials that are duplicate, not planned, out of order, or different from the plan."""
    problems = []
    plan, study = sidecar["plan"], sidecar["study"]
    seen: dict[int, int] = {}
    last_trial, last_elapsed = 0, 0.0
    for number, row in rows:
        trial, elapsed = _trial(row), float(row["elapsed_seconds"] or 0.0)
        if trial in seen:
            problems.append(Problem(path, f"trial {trial} stands in row {seen[trial]} already", number, "trial"))
            continue
        seen[trial] = number
        if trial > len(plan):
            what = f"trial {trial} is not in the plan of {len(plan)} trials"
            problems.append(Problem(path, what, number, "trial"))
            continue
        if trial < last_trial:
            problems.append(Problem(path, f"trial {trial} comes after trial {last_trial}", number, "trial"))
        if elapsed < last_elapsed:
            what = f"{elapsed:g} is earlier than the row before, {last_elapsed:g}"
            problems.append(Problem(path, what, number, "elapsed_seconds"))
        last_trial, last_elapsed = trial, elapsed
        for key in ("block", *PLANNED[study]):
            if not _is_planned(plan[trial - 1][key], row[key]):
                what = f"{shown(row[key])}; the plan of trial {trial} says {shown(plan[trial - 1][key])}"
                problems.append(Problem(path, what, number, key))
    return problems


def _unanswered(path: Path, sidecar: Mapping[str, Any], rows: Sequence[tuple[int, Row]]) -> list[Problem]:
    answered, planned = {_trial(row) for _, row in rows}, len(sidecar["plan"])
    missing = [trial for trial in range(1, planned + 1) if trial not in answered]
    if not missing and sidecar["finished"]:
        return []
    if not missing:
        what = "every trial is there, but the sidecar does not say that the session ended; resume it once"
    elif sidecar["finished"]:
        what = f"finished, but without trial {ranges(missing)} of the plan"
    else:
        what = f"unfinished: trial {ranges(missing)} of {planned} missing; resume the session, or take its files out"
    return [Problem(path, what)]


def _trial(row: Row) -> int:
    return int(row["trial"] or 0)


def _is_planned(planned: object, found: Value) -> bool:
    if isinstance(planned, str) or isinstance(found, str) or found is None:
        return planned == found
    return math.isclose(float(planned), float(found), abs_tol=1e-6)  # type: ignore[arg-type]
