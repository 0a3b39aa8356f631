"""The study of places: likeness of passes, bumps found again, and accuracy beside an engine without places."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from haptoflow_paper.place.likeness import Profile, bumps, found_again, likeness, over_place
from haptoflow_paper.place.passes import Pass, Renderer, Rounds, Table
from haptoflow_training.waveform import SAMPLE_RATE_HZ

# Labels whose ribs are ruled; the others are random.
RULED = ("metal mesh", "corduroy", "jute")
BUMPY = ("stone", "concrete", "brick")
_LOW_METRES, _HIGH_METRES = 0.002, 0.052
# Beginnings of second passes, so that hand-overs and the network's grid of 8 samples fall elsewhere.
_EARLIER_METRES = (0.00051, 0.00173, 0.00247, 0.0033)
_LONG, _LONG_RANGE_METRES = Pass(-0.01, 0.55, 0.03), (0.0, 0.53)
_MOVED = {"position_metres": (0.3, 0.2, -0.4), "turn_degrees": 35.0}


def second_passes() -> dict[str, tuple[dict[str, Any], Pass]]:
    """What a second pass changes: of the table, and of the pass."""
    once = Pass()
    return {
        "same direction and speed": ({}, once),
        "20 % faster": ({}, Pass(-0.01, 0.068, 0.12)),
        "twice as fast": ({}, Pass(-0.02, 0.075, 0.2)),
        "half as fast": ({}, Pass(-0.005, 0.06, 0.05)),
        "backwards": ({}, Pass(0.065, -0.01)),
        "object moved and turned": (_MOVED, once),
        "0.1 mm beside": ({}, replace(once, beside_metres=1e-4)),
        "1 mm beside": ({}, replace(once, beside_metres=1e-3)),
        "another object": ({"name": "another table"}, once),
    }


@dataclass(frozen=True)
class _Task:
    label: str
    renderer: Renderer
    # Without a place, passes differ by their seed only, as two passes of one session do.
    seeds: tuple[int, int] = (1, 1)


def _figures_of(task: _Task) -> dict[str, Any]:
    reference_pass = Pass()
    table = Table(task.label)

    def profile(where: Table, stroke: Pass, seed: int) -> Profile:
        return over_place(task.renderer.wave(where, stroke, seed), stroke)

    first = profile(table, reference_pass, task.seeds[0])
    figures: dict[str, Any] = {}
    for name, (changes, stroke) in second_passes().items():
        seconds = [
            profile(replace(table, **changes), stroke.begun_earlier(metres), task.seeds[1]) for metres in _EARLIER_METRES
        ]
        found = [likeness(first, second, _LOW_METRES, _HIGH_METRES) for second in seconds]
        figures[name] = {
            "correlation": float(np.mean([each.correlation for each in found])),
            "unshifted": float(np.mean([each.unshifted for each in found])),
            "shift_mm": float(1e3 * np.median([each.shift_metres for each in found])),
        }
    figures["second round of a circle"] = _second_round(task)
    if task.label in BUMPY:
        figures["bumps"] = _bumps_of(task)
    return figures


def _bumps_of(task: _Task) -> dict[str, int]:
    """Bumps of one pass of half a metre at 30 mm/s, those that the next pass finds, and those that chance finds."""
    once, again = _LONG, _LONG.begun_earlier(_EARLIER_METRES[-1])
    table, other = Table(task.label), Table(task.label, "another table")
    first = over_place(task.renderer.wave(table, once, task.seeds[0]), once)
    places = bumps(first, *_LONG_RANGE_METRES)
    found = {
        name: found_again(places, over_place(task.renderer.wave(where, again, task.seeds[1]), again), *_LONG_RANGE_METRES)
        for name, where in (("again", table), ("by_chance", other))
    }
    return {"bumps": len(places), **found}


def _second_round(task: _Task) -> dict[str, float]:
    rounds = Rounds()
    wave = task.renderer.wave(Table(task.label), rounds, task.seeds[0])
    samples = rounds.round_seconds * SAMPLE_RATE_HZ
    # From the middle of each round on, as passes over a straight place.
    half, whole = round(0.5 * samples), round(samples)
    first = over_place(wave[half:whole], Pass(0.0))
    second = over_place(wave[half + whole : 2 * whole], Pass(rounds.speed_mps / SAMPLE_RATE_HZ * (whole - samples)))
    found = likeness(first, second, 0.001, 0.045)
    return {"correlation": found.correlation, "unshifted": found.unshifted, "shift_mm": 1e3 * found.shift_metres}


def steps_of(labels: Sequence[str], engines: int) -> int:
    return len(labels) * engines


def measure_likeness(
    renderer: Renderer, baseline: Renderer | None, labels: Sequence[str], workers: int, advance: Callable[[], object]
) -> dict[str, dict[str, Any]]:
    """{"now": {label: {second pass: figures}}, "before": the same}; `before` renders both passes with other seeds."""
    rows = {"now": [_Task(label, renderer) for label in labels]}
    if baseline is not None:
        rows["before"] = [_Task(label, baseline, (1, 2)) for label in labels]
    results: dict[str, dict[str, Any]] = {}
    with ThreadPoolExecutor(workers) as pool:
        for name, tasks in rows.items():
            results[name] = {}
            for task, figures in zip(tasks, pool.map(_figures_of, tasks), strict=True):
                results[name][task.label] = figures
                advance()
    return results


def summary(by_label: Mapping[str, Mapping[str, Mapping[str, float]]], second_pass: str) -> dict[str, Any]:
    """Median, least and most over the random labels, and the ruled labels' correlation without a shift."""
    random = [figures[second_pass] for label, figures in by_label.items() if label not in RULED]
    values = [each["correlation"] for each in random]
    return {
        "median": float(np.median(values)), "least": min(values), "most": max(values),
        "shift_mm": float(np.median([each["shift_mm"] for each in random])),
        "ruled": {label: by_label[label][second_pass]["unshifted"] for label in RULED if label in by_label},
    }  # fmt: skip


def bumps_found(by_label: Mapping[str, Mapping[str, Mapping[str, int]]]) -> dict[str, int]:
    """Sums over the labels with outsized asperities: {bumps, again, by_chance}."""
    counts = [figures["bumps"] for figures in by_label.values() if "bumps" in figures]
    return {key: sum(each[key] for each in counts) for key in ("bumps", "again", "by_chance")}
