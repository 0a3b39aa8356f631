"""Reads one session: its log and its sidecar, compared with each other."""

from __future__ import annotations

import csv
import hashlib
import io
import json
import math
import re
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from haptoflow_training.errors import InputError
from haptoflow_training.studies.log_table import (
    COLUMNS, FORMAT, PLANNED, SIMILARITY, STUDIES, VERSION, Column, Problem, Row, Value, ranges, read_rows, shown,
    text_of
)
from haptoflow_training.whole_file import write_whole

EQUIVALENCE_KEY = "equivalence_points"
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


def session_bound(session: Session) -> float | None:
    """None if the settings name none, as in logs of older versions."""
    value = session.sidecar["settings"].get(EQUIVALENCE_KEY)
    is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
    return float(value) if is_number and 0.0 < value <= 6.0 else None


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


_MAXIMUM_SHOWN = 20
_OWN_SETTINGS = ("pen_hand",)
_NOT_NAMED = "not named as a session, STUDY-PARTICIPANT-SESSION, for example latency-P07-1a2b3c4d; take it out"


@dataclass(frozen=True)
class StudyFolder:
    """The contents of a folder. notes: allowed but notable, for example two models in one study."""

    sessions: Sequence[Session]
    problems: Sequence[Problem]
    notes: Sequence[str] = field(default_factory=tuple)

    def of(self, study: str) -> list[Session]:
        """The sessions of a study, by participant."""
        return sorted((one for one in self.sessions if one.study == study), key=lambda one: one.participant)


def read_folder(folder: Path) -> StudyFolder:
    """Every session below the folder. InputError if the folder is missing or holds none."""
    if not folder.is_dir():
        raise InputError(f"{folder}: no folder; expected one with the logs of a study")
    files = sorted(path for path in folder.rglob("*") if path.suffix.lower() in (".csv", ".json") and path.is_file())
    problems = [
        Problem(path, _NOT_NAMED)
        for path in files
        if not NAME.fullmatch(path.stem) or path.suffix not in (".csv", ".json")
    ]
    named = {path.with_suffix(".csv") for path in files} - {problem.file.with_suffix(".csv") for problem in problems}
    if not named and not problems:
        raise InputError(f"{folder}: no log of a study in it; expected files such as latency-P07-1a2b3c4d.csv")
    sessions = []
    for path in sorted(named):
        session, found = read_session(path)
        problems += found
        if session is not None:
            sessions.append(session)
    problems += _duplicates(named)
    problems += _between(sessions)
    return StudyFolder(sessions, problems, _notes(sessions))


def read_faultless(folder: Path) -> StudyFolder:
    """As read_folder; InputError names the problems."""
    read = read_folder(folder)
    if read.problems:
        shown = [str(problem) for problem in read.problems[:_MAXIMUM_SHOWN]]
        rest = len(read.problems) - len(shown)
        if rest:
            shown.append(f"and {rest} further problems: `haptoflow-training study check {folder}` names them")
        raise InputError("\n  ".join(["the logs cannot be used as they are:", *shown]))
    return read


def _duplicates(csv_paths: Iterable[Path]) -> list[Problem]:
    """Find logs with identical rows, whatever their names; logs without rows are not compared."""
    problems = []
    first: dict[str, Path] = {}
    for path in sorted(csv_paths):
        if not path.is_file() or len((content := path.read_bytes()).splitlines()) < 2:
            continue
        digest = hashlib.sha256(content).hexdigest()
        if digest in first:
            problems.append(Problem(path, f"the same rows as {first[digest]}; take one of them out"))
        else:
            first[digest] = path
    return problems


def _between(sessions: Sequence[Session]) -> list[Problem]:
    problems = []
    by_participant: Mapping[tuple[str, int], list[Session]] = defaultdict(list)
    by_session: Mapping[tuple[str, str], list[Session]] = defaultdict(list)
    for session in sessions:
        by_participant[session.study, session.participant].append(session)
        by_session[session.study, session.session].append(session)
    for (study, participant), same in by_participant.items():
        for other in same[1:]:
            what = f"a second session of participant {participant} in the {study} study, beside {same[0].path.name}"
            problems.append(Problem(other.path, f"{what}; take one of them out"))
    for (_, identifier), same in by_session.items():
        for other in same[1:]:
            problems.append(Problem(other.path, f"session {identifier} is that of {same[0].path.name} already"))
    simulated = [session for session in sessions if session.is_simulated]
    if simulated and len(simulated) < len(sessions):
        real = next(session for session in sessions if not session.is_simulated)
        what = f"simulated, beside the real {real.path.name}; keep simulated and real logs in folders of their own"
        problems += [Problem(session.path, what) for session in simulated]
    return problems


def _compared(value: object) -> object:
    """The settings that must agree between participants."""
    return {key: one for key, one in value.items() if key not in _OWN_SETTINGS} if isinstance(value, dict) else value


def _notes(sessions: Sequence[Session]) -> list[str]:
    notes = []
    for study in STUDIES:
        of_study = [session for session in sessions if session.study == study]
        for key, why in (
            ("seed", "the order of trials is counterbalanced within one seed only"),
            ("settings", "participants took part in different studies"),
            ("models", "participants felt different models"),
            ("build", "participants used different programs"),
        ):
            kinds = {json.dumps(_compared(session.sidecar[key]), sort_keys=True) for session in of_study}
            if len(kinds) > 1:
                notes.append(f"{study}: {len(kinds)} different values of '{key}' in the sidecars: {why}")
        notes += _missing(study, of_study)
        if study == SIMILARITY and any(session_bound(session) is None for session in of_study):
            notes.append(
                f"{study}: not every sidecar's settings name '{EQUIVALENCE_KEY}': the bound of equivalence was not "
                "fixed before the answers"
            )
        estimated = sum(session.sidecar["device"]["device_delay_source"] == "estimated" for session in of_study)
        if estimated:
            notes.append(f"{study}: the device delay of {estimated} of {len(of_study)} sessions is an estimate")
    return notes


def _missing(study: str, sessions: Sequence[Session]) -> list[str]:
    """A note about the numbers below the highest one without a session: each number has an order of its own."""
    present = {session.participant for session in sessions}
    missing = [number for number in range(1, max(present, default=0)) if number not in present]
    if not missing:
        return []
    are = "participant" if len(missing) == 1 else "participants"
    return [
        f"{study}: {are} {ranges(missing)} missing below participant {max(present)}: the order of trials is not "
        f"counterbalanced; run somebody under {'this number' if len(missing) == 1 else 'each of these numbers'} before "
        "higher ones"
    ]
