"""Analysis of the delay tolerance study: a curve and a threshold for each condition, over the delivered delays."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from haptoflow_training.errors import InputError
from haptoflow_training.studies.log_table import participants_words
from haptoflow_training.studies.plans import CONDITIONS, MAIN
from haptoflow_training.studies.psychometric import Answers, Fit, Interval, fit, share, threshold_difference
from haptoflow_training.studies.rating_tests import EQUIVALENCE_POINTS, RatingResult, analysed
from haptoflow_training.studies.session_file import Session, session_bound

@dataclass(frozen=True)
class Point:
    """One planned level: the mean delivered delay, percentage of yes with Wilson's interval of 95 %, number of
    answers."""

    level_ms: float
    delivered_ms: float
    percent: float
    low_percent: float
    high_percent: float
    count: int


@dataclass(frozen=True)
class LatencyResult:
    """single: each answer of the main trials. difference: turn-on threshold less turn-off threshold, with its interval;
    None if either has none."""

    participants: int
    points: Mapping[str, Sequence[Point]]
    fits: Mapping[str, Fit]
    answers: Mapping[str, int]
    single: Mapping[str, Answers]
    difference_ms: float | None
    difference_interval: Interval | None


def analyse_latency(sessions: Sequence[Session], *, seed: int = 0) -> LatencyResult:
    """Analyse the sessions; practice trials are left out."""
    points, fits, counts, single = {}, {}, {}, {}
    for condition in CONDITIONS:
        answers, levels = answers_of(sessions, condition)
        points[condition] = [point_at(answers, float(level), levels == level) for level in np.unique(levels)]
        fits[condition] = fit(answers, seed=seed)
        counts[condition], single[condition] = len(levels), answers
    first, second = (fits[condition] for condition in CONDITIONS)
    difference = first.curve.x0 - second.curve.x0 if first.curve and second.curve else None
    interval = threshold_difference(first, second, len(sessions))
    return LatencyResult(len(sessions), points, fits, counts, single, difference, interval)


def point_at(answers: Answers, level_ms: float, chosen: np.ndarray) -> Point:
    """Each participant answers once at a level, so that the answers at one level are independent of each other."""
    found = share(int(answers.yes[chosen].sum()), int(chosen.sum()))
    delivered = float(answers.delay_ms[chosen].mean())
    return Point(level_ms, delivered, 100.0 * found.rate, 100.0 * found.low, 100.0 * found.high, found.of)


def answers_of(sessions: Sequence[Session], condition: str) -> tuple[Answers, np.ndarray]:
    """The answers of the main trials, and the planned level of each."""
    rows = [
        (place, row)
        for place, session in enumerate(sessions)
        for row in session.rows
        if row["block"] == MAIN and row["condition"] == condition
    ]
    answers = Answers(
        np.array([row["delivered_delay_ms"] for _, row in rows], dtype=float),
        np.array([row["answer"] == "yes" for _, row in rows], dtype=int),
        np.array([place for place, _ in rows], dtype=int),
    )
    return answers, np.array([row["delay_ms"] for _, row in rows], dtype=float)


MINIMUM_PARTICIPANTS = 3
_MAXIMUM_METHODS = 12


@dataclass(frozen=True)
class SimilarityResult:
    """ratings: materials by participants by methods. bound: of equivalence, in points of rating."""

    materials: Sequence[str]
    methods: Sequence[str]
    ratings: np.ndarray
    by_material: Mapping[str, RatingResult]
    bound: float

    @property
    def participants(self) -> int:
        return int(self.ratings.shape[1])


def analyse_similarity(sessions: Sequence[Session]) -> SimilarityResult:
    """Analyse the sessions; practice trials are left out. InputError names a rating that is missing or duplicate."""
    if len(sessions) < MINIMUM_PARTICIPANTS:
        raise InputError(too_few_words(len(sessions)))
    materials, methods = _names(sessions, "material"), _names(sessions, "method")
    if not 2 <= len(methods) <= _MAXIMUM_METHODS:
        raise InputError(f"{len(methods)} methods in the similarity study; it can compare 2 to {_MAXIMUM_METHODS}")
    ratings = np.full((len(materials), len(sessions), len(methods)), np.nan)
    for place, session in enumerate(sessions):
        for row in session.rows:
            if row["block"] != MAIN:
                continue
            cell = materials.index(str(row["material"])), place, methods.index(str(row["method"]))
            if not np.isnan(ratings[cell]):
                raise InputError(f"{session.path}: {row['method']} on {row['material']} is rated twice; expected once")
            ratings[cell] = row["rating"]
    _refuse_gaps(ratings, materials, methods, sessions)
    # Each session fixed its bound before its first answer. Where bounds differ, the smallest is the strictest.
    bound = min(session_bound(session) or EQUIVALENCE_POINTS for session in sessions)
    by_material = {name: analysed(of_material, bound) for name, of_material in zip(materials, ratings, strict=True)}
    return SimilarityResult(materials, methods, ratings, by_material, bound)


def too_few_words(participants: int) -> str:
    return f"{participants_words(participants)} of the similarity study; its tests need {MINIMUM_PARTICIPANTS}"


def _names(sessions: Sequence[Session], key: str) -> list[str]:
    """The names in the order of the settings if the sidecars have them, else sorted."""
    found = {str(row[key]) for session in sessions for row in session.rows if row["block"] == MAIN}
    listed = listed_names(sessions[0].sidecar["settings"], f"{key}s")
    return listed if sorted(listed) == sorted(found) else sorted(found)


def listed_names(settings: Mapping[str, Any], key: str) -> list[str]:
    """The names of settings that list names, or objects with a `name`; empty for anything else."""
    listed = settings.get(key)
    entries = listed if isinstance(listed, list) else []
    names = [entry.get("name") if isinstance(entry, dict) else entry for entry in entries]
    return names if all(isinstance(name, str) for name in names) else []


def _refuse_gaps(
    ratings: np.ndarray, materials: Sequence[str], methods: Sequence[str], sessions: Sequence[Session]
) -> None:
    gaps = np.argwhere(np.isnan(ratings))
    if len(gaps):
        material, place, method = gaps[0]
        raise InputError(
            f"{sessions[place].path}: no rating of {methods[method]} on {materials[material]}, which others rated; "
            "every participant must rate every method on every material"
        )
