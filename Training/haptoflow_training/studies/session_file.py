"""Reads one session: its log and its sidecar, compared with each other."""

from __future__ import annotations

import csv
import io
import json
import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from haptoflow_training.studies.log_table import (
    COLUMNS, FORMAT, PLANNED, STUDIES, VERSION, Column, Problem, Row, Value, ranges, read_rows, shown, text_of
)
from haptoflow_training.whole_file import write_whole

DELAY_SOURCES = ("measured", "estimated")
KEYS: Mapping[str, type] = {
    "study": str,
    "participant": int,
    "session": str,
    "seed": int,
    "simulated": bool,
    "created": str,
    "finished": bool,
    "resumptions": int,
    "build": dict,
    "device": dict,
    "delay": dict,
    "models": list,
    "settings": dict,
    "plan": list,
}
_WORDS = {str: "a text", int: "a whole number", bool: "true or false", dict: "an object", list: "a list"}


def read_sidecar(path: Path, problems: list[Problem]) -> Mapping[str, Any] | None:
    """None, with problems appended, if a key is missing or of another type. Further keys are allowed."""
    text = text_of(path, problems)
    if text is None:
        return None
    try:
        sidecar = json.loads(text, parse_constant=_refused_constant, object_pairs_hook=_object)
    except (ValueError, RecursionError) as error:
        problems.append(Problem(path, f"not valid JSON: {error}"))
        return None
    if not isinstance(sidecar, dict) or sidecar.get("format") != FORMAT:
        problems.append(Problem(path, f"no sidecar of a study: 'format' is not {FORMAT}"))
        return None
    if type(sidecar.get("version")) is not int or sidecar["version"] != VERSION:
        found = shown(sidecar.get("version"))
        problems.append(Problem(path, f"version {found} of the format; this program reads version {VERSION}"))
        return None
    before = len(problems)
    for key, kind in KEYS.items():
        if key not in sidecar:
            problems.append(Problem(path, f"key '{key}' is missing"))
        elif type(sidecar[key]) is not kind:
            problems.append(Problem(path, f"key '{key}' is {shown(sidecar[key])}; expected {_WORDS[kind]}"))
    if len(problems) == before:
        _check_plan(path, sidecar, problems)
        source = sidecar["device"].get("device_delay_source")
        if source not in DELAY_SOURCES:
            expected = " or ".join(DELAY_SOURCES)
            problems.append(Problem(path, f"key 'device.device_delay_source' is {shown(source)}; expected {expected}"))
    return sidecar if len(problems) == before else None


def _refused_constant(word: str) -> float:
    raise ValueError(f"{word} is not a number of JSON")


def _object(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) < len(pairs):
        twice = next(key for key, _ in pairs if sum(other == key for other, _ in pairs) > 1)
        raise ValueError(f"key '{twice}' stands twice")
    return found


def _check_plan(path: Path, sidecar: Mapping[str, Any], problems: list[Problem]) -> None:
    study = sidecar["study"]
    if study not in STUDIES:
        problems.append(Problem(path, f"key 'study' is {shown(study)}; expected {' or '.join(STUDIES)}"))
        return
    if not sidecar["plan"]:
        problems.append(Problem(path, "key 'plan' has no trial"))
    for place, entry in enumerate(sidecar["plan"], start=1):
        fault = _fault_of_entry(study, place, entry)
        if fault:
            problems.append(Problem(path, f"key 'plan', entry {place}{fault}"))
            return


def _fault_of_entry(study: str, place: int, entry: object) -> str:
    columns = {column.name: column for column in COLUMNS[study]}
    for key in ("trial", "block", *PLANNED[study]):
        if not isinstance(entry, dict) or key not in entry:
            return f": '{key}' is missing"
        fault = _fault_of_value(columns[key], entry[key])
        if fault:
            return f", '{key}': {fault}"
    return f": 'trial' is {entry['trial']}; expected {place}" if entry["trial"] != place else ""  # type: ignore[index]


def _fault_of_value(column: Column, value: object) -> str:
    is_text = bool(column.words) or column.is_text
    if isinstance(value, bool) or not isinstance(value, str if is_text else (int, float)):
        return f"{shown(value)} is not {'a text' if is_text else 'a number'}"
    try:
        column.read(str(value))
    except ValueError as error:
        return str(error)
    return ""


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
