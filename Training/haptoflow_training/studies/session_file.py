"""One session's two files, the rows of its trials and its sidecar, read strictly: every fault is named with its place."""

from __future__ import annotations

import csv
import io
import json
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from haptoflow_training.studies.log_columns import COLUMNS, FORMAT, PLANNED, STUDIES, VERSION, Column, Value

NAME = re.compile(r"(latency|similarity)-P(\d{1,9})-([0-9a-f]{8})")
# Sums of values that were rounded to six decimals, or to three by another program.
_DELAY_TOLERANCE_MS = 0.002
_LONGEST_SHOWN = 60


@dataclass(frozen=True)
class Problem:
    """row: as a spreadsheet counts, the header being row 1; 0 and an empty column where the fault has none."""

    file: Path
    what: str
    row: int = 0
    column: str = ""

    def __str__(self) -> str:
        place = ", ".join(words for words in (f"row {self.row}" if self.row else "", f"column {self.column}" if self.column else "") if words)
        return f"{self.file}: {place}: {self.what}" if place else f"{self.file}: {self.what}"


@dataclass(frozen=True)
class Session:
    """One participant's session as read; rows in the order of the file."""

    path: Path
    study: str
    participant: int
    session: str
    sidecar: Mapping[str, Any]
    rows: Sequence[Mapping[str, Value]]

    @property
    def is_simulated(self) -> bool:
        return bool(self.sidecar["simulated"])

    @property
    def is_finished(self) -> bool:
        return bool(self.sidecar["finished"])


def read_session(csv_path: Path) -> tuple[Session | None, list[Problem]]:
    """The session behind STUDY-PARTICIPANT-SESSION.csv and its sidecar; None where either cannot be read at all."""
    name = NAME.fullmatch(csv_path.stem)
    if name is None:
        raise ValueError(f"{csv_path.name}: no name of a session")
    problems: list[Problem] = []
    sidecar_path = csv_path.with_suffix(".json")
    sidecar = _read_sidecar(sidecar_path, problems)
    rows = _read_rows(csv_path, COLUMNS[name[1]], problems)
    if sidecar is None or rows is None:
        return None, problems
    _check_name(sidecar_path, sidecar, name, problems)
    numbered = [(number, row) for number, row in rows if row is not None]
    if not problems:
        _check_against_plan(csv_path, name[1], sidecar, numbered, problems)
    session = Session(csv_path, name[1], int(name[2]), name[3], sidecar, [row for _, row in numbered])
    return session, problems


_KEYS: Mapping[str, type | tuple[type, ...]] = {
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


def _read_sidecar(path: Path, problems: list[Problem]) -> Mapping[str, Any] | None:
    text = _text_of(path, problems)
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
        found = _shown(sidecar.get("version"))
        problems.append(Problem(path, f"version {found} of the format; this program reads version {VERSION}"))
        return None
    before = len(problems)
    for key, kind in _KEYS.items():
        if key not in sidecar:
            problems.append(Problem(path, f"key '{key}' is missing"))
        elif type(sidecar[key]) is not kind:
            problems.append(Problem(path, f"key '{key}' is {_shown(sidecar[key])}; expected {_WORDS[kind]}"))  # type: ignore[index]
    if len(problems) == before:
        _check_plan_entries(path, sidecar, problems)
        _check_device(path, sidecar, problems)
    return sidecar if len(problems) == before else None


def _refused_constant(word: str) -> float:
    raise ValueError(f"{word} is not a number of JSON")


def _object(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) < len(pairs):
        twice = next(key for key, _ in pairs if sum(other == key for other, _ in pairs) > 1)
        raise ValueError(f"key '{twice}' stands twice")
    return found


def _check_plan_entries(path: Path, sidecar: Mapping[str, Any], problems: list[Problem]) -> None:
    study = sidecar["study"]
    if study not in STUDIES:
        problems.append(Problem(path, f"key 'study' is {_shown(study)}; expected {' or '.join(STUDIES)}"))
        return
    columns = {column.name: column for column in COLUMNS[study]}
    for place, entry in enumerate(sidecar["plan"], start=1):
        for key in ("trial", "block", *PLANNED[study]):
            if not isinstance(entry, dict) or key not in entry:
                problems.append(Problem(path, f"key 'plan', entry {place}: '{key}' is missing"))
                return
            fault = _fault(columns[key], entry[key])
            if fault:
                problems.append(Problem(path, f"key 'plan', entry {place}, '{key}': {fault}"))
                return
        if entry["trial"] != place:
            problems.append(Problem(path, f"key 'plan', entry {place}: 'trial' is {entry['trial']}; expected {place}"))
            return
    if not sidecar["plan"]:
        problems.append(Problem(path, "key 'plan' has no trial"))


def _fault(column: Column, value: object) -> str:
    is_text = bool(column.words) or column.is_text
    if isinstance(value, bool) or not isinstance(value, str if is_text else (int, float)):
        return f"{_shown(value)} is not {'a text' if is_text else 'a number'}"
    try:
        column.read(str(value))
    except ValueError as error:
        return str(error)
    return ""


def _check_device(path: Path, sidecar: Mapping[str, Any], problems: list[Problem]) -> None:
    source = sidecar["device"].get("device_delay_source")
    if source not in ("measured", "estimated"):
        problems.append(Problem(path, f"key 'device.device_delay_source' is {_shown(source)}; expected measured or estimated"))


def _check_name(path: Path, sidecar: Mapping[str, Any], name: re.Match[str], problems: list[Problem]) -> None:
    for key, expected in (("study", name[1]), ("participant", int(name[2])), ("session", name[3])):
        if sidecar[key] != expected:
            problems.append(Problem(path, f"key '{key}' is {_shown(sidecar[key])}; the file's name says {expected}"))


def _text_of(path: Path, problems: list[Problem]) -> str | None:
    try:
        return path.read_bytes().decode("utf-8-sig")
    except FileNotFoundError:
        other = "sidecar" if path.suffix == ".json" else "log"
        problems.append(Problem(path, f"the {other} is missing; a session is a .csv and a .json of one name"))
    except OSError as error:
        problems.append(Problem(path, f"cannot be read ({error.strerror})"))
    except UnicodeDecodeError:
        problems.append(Problem(path, "not UTF-8 text"))
    return None


_Rows = list[tuple[int, dict[str, Value] | None]]


def _read_rows(path: Path, columns: Sequence[Column], problems: list[Problem]) -> _Rows | None:
    """Numbered rows, None for those with a fault; None in all where there is no table."""
    text = _text_of(path, problems)
    if text is None:
        return None
    if text == "":
        problems.append(Problem(path, "empty; expected a header row"))
        return None
    if not text.endswith("\n"):
        last = text.count("\n") + 1
        problems.append(
            Problem(path, "half-written, as by a crash; resume the session, which asks its trial again", last)
        )
        text = text[: text.rfind("\n") + 1]
    lines = _lines(path, text, problems)
    header = next(lines, None)
    if header is None or not _check_header(path, header[1], columns, problems):
        return None
    by_name = {column.name: column for column in columns}
    rows: _Rows = []
    for number, fields in lines:
        if len(fields) != len(header[1]):
            problems.append(Problem(path, f"{len(fields)} fields; expected {len(header[1])}", number))
            rows.append((number, None))
            continue
        rows.append((number, _read_row(path, number, dict(zip(header[1], fields, strict=True)), by_name, problems)))
    return rows


def _lines(path: Path, text: str, problems: list[Problem]) -> Iterator[tuple[int, list[str]]]:
    reader = csv.reader(io.StringIO(text, newline=""), strict=True)
    number = 1
    try:
        for fields in reader:
            yield number, fields
            number = reader.line_num + 1
    except csv.Error as error:
        problems.append(Problem(path, f"not CSV: {error}", number))


def _check_header(path: Path, header: Sequence[str], columns: Sequence[Column], problems: list[Problem]) -> bool:
    names = [column.name for column in columns]
    before = len(problems)
    if len(header) == 1 and (";" in header[0] or "\t" in header[0]):
        problems.append(Problem(path, "not separated by commas, as after saving from a spreadsheet; use the study's own file", 1))
        return False
    for name in names:
        if header.count(name) != 1:
            problems.append(Problem(path, "missing" if name not in header else "stands twice", 1, name))
    for name in header:
        if name not in names:
            problems.append(Problem(path, "not a column of this study", 1, _shortened(name)))
    return len(problems) == before


def _read_row(
    path: Path, number: int, fields: Mapping[str, str], columns: Mapping[str, Column], problems: list[Problem]
) -> dict[str, Value] | None:
    row: dict[str, Value] = {}
    for name, column in columns.items():
        try:
            row[name] = column.read(fields[name])
        except ValueError as error:
            problems.append(Problem(path, str(error), number, name))
    if len(row) < len(columns):
        return None
    delivered, system, artificial = (float(row[f"{name}_delay_ms"] or 0.0) for name in ("delivered", "system", "artificial"))
    if abs(delivered - system - artificial) > _DELAY_TOLERANCE_MS:
        what = f"{delivered:g} is not the sum of system and artificial delay, {system + artificial:g}"
        problems.append(Problem(path, what, number, "delivered_delay_ms"))
        return None
    return row


def _check_against_plan(
    path: Path, study: str, sidecar: Mapping[str, Any], rows: Sequence[tuple[int, Mapping[str, Value]]], problems: list[Problem]
) -> None:
    plan = sidecar["plan"]
    seen: dict[int, int] = {}
    last_trial, last_elapsed = 0, 0.0
    for number, row in rows:
        trial = int(row["trial"])  # type: ignore[arg-type]
        if trial in seen:
            problems.append(Problem(path, f"trial {trial} stands in row {seen[trial]} already", number, "trial"))
            continue
        seen[trial] = number
        if trial > len(plan):
            problems.append(Problem(path, f"trial {trial} is not in the plan of {len(plan)} trials", number, "trial"))
            continue
        if trial < last_trial:
            problems.append(Problem(path, f"trial {trial} comes after trial {last_trial}", number, "trial"))
        elapsed = float(row["elapsed_seconds"])  # type: ignore[arg-type]
        if elapsed < last_elapsed:
            problems.append(Problem(path, f"{elapsed:g} is earlier than the row before, {last_elapsed:g}", number, "elapsed_seconds"))
        last_trial, last_elapsed = trial, elapsed
        for key in ("block", *PLANNED[study]):
            planned = plan[trial - 1][key]
            same = math.isclose(planned, float(row[key] or 0.0), abs_tol=1e-6) if key == "delay_ms" else planned == row[key]
            if not same:
                problems.append(Problem(path, f"{_shown(row[key])}; the plan of trial {trial} says {_shown(planned)}", number, key))
    missing = [trial for trial in range(1, len(plan) + 1) if trial not in seen]
    if missing and sidecar["finished"]:
        problems.append(Problem(path, f"finished, but without trial {_ranges(missing)} of the plan"))
    elif missing:
        problems.append(
            Problem(path, f"unfinished: trial {_ranges(missing)} of {len(plan)} missing; resume the session, or take its files out")
        )
    elif not sidecar["finished"]:
        problems.append(Problem(path, "every trial is there, but the sidecar does not say that the session ended; resume it once"))


def _ranges(numbers: Sequence[int]) -> str:
    """1, 4 to 7"""
    runs: list[list[int]] = []
    for number in numbers:
        if runs and number == runs[-1][1] + 1:
            runs[-1][1] = number
        else:
            runs.append([number, number])
    return ", ".join(str(first) if first == last else f"{first} to {last}" for first, last in runs)


def _shown(value: object) -> str:
    return _shortened(json.dumps(value, ensure_ascii=False, default=str))


def _shortened(text: str) -> str:
    return text if len(text) <= _LONGEST_SHOWN else f"{text[:_LONGEST_SHOWN]}..."
