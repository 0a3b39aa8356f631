"""Analysis of the delay tolerance study: a curve and a threshold for each condition, over the delivered delays."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from haptoflow_training.studies.intervals import Interval, share
from haptoflow_training.studies.plans import CONDITIONS, MAIN
from haptoflow_training.studies.psychometric import Answers, Fit, fit, threshold_difference
from haptoflow_training.studies.session_file import Session


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
