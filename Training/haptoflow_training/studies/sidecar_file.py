"""Reads and checks a session's sidecar, version 1 (Documentation~/study-files.md)."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from haptoflow_training.studies.log_columns import COLUMNS, FORMAT, PLANNED, STUDIES, VERSION, Column
from haptoflow_training.studies.problems import Problem, shown, text_of

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
            problems.append(
                Problem(path, f"key 'device.device_delay_source' is {shown(source)}; expected {expected}")
            )
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
