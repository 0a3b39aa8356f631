"""Reads a folder of sessions and finds problems within and between files."""

from __future__ import annotations

import hashlib
import json
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from haptoflow_training.errors import InputError
from haptoflow_training.studies.log_table import SIMILARITY, STUDIES, Problem, ranges
from haptoflow_training.studies.session_file import NAME, Session, read_session
from haptoflow_training.studies.analysis import EQUIVALENCE_KEY, session_bound

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
