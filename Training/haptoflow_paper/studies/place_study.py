"""The study of places: likeness of passes, bumps found again, and accuracy beside an engine without places."""

from __future__ import annotations

import json
import math
import tempfile
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.signal import find_peaks, resample_poly

from haptoflow_benchmark.engine_render import FULL_SCALE_MPS2, rendered_samples, write_rows
from haptoflow_training.waveform import SAMPLE_RATE_HZ

Doubles = NDArray[np.float64]

_STROKE_STEP_SECONDS = 0.004
_DEPTH_METRES = 0.0005


@dataclass(frozen=True)
class Table:
    """A plane of one label. Its place and turn about the vertical must not matter to what a pass over it feels."""

    label: str
    name: str = "table"
    position_metres: tuple[float, float, float] = (0.0, 0.0, 0.0)
    turn_degrees: float = 0.0

    def scene(self, update_rate_hz: float) -> dict[str, object]:
        half = math.radians(0.5 * self.turn_degrees)
        surface = {
            "name": self.name, "shape": {"plane": {}}, "position": list(self.position_metres),
            "rotation": [0.0, math.sin(half), 0.0, math.cos(half)], "material": self.label,
        }  # fmt: skip
        return {"surfaces": [surface], "stylus": {"tip_radius": 0.001}, "update_rate": update_rate_hz}

    def to_world(self, along: Doubles, beside: Doubles) -> Doubles:
        """Points [n, 3] of the tip over the table's own coordinates."""
        angle = math.radians(self.turn_degrees)
        x, z = along * math.cos(angle) + beside * math.sin(angle), beside * math.cos(angle) - along * math.sin(angle)
        return np.stack([x, np.full_like(x, _DEPTH_METRES), z], axis=1) + np.asarray(self.position_metres)


@dataclass(frozen=True)
class Pass:
    """A straight stroke at 1 N from one place to another, `beside_metres` beside the line."""

    start_metres: float = -0.01
    end_metres: float = 0.065
    speed_mps: float = 0.1
    beside_metres: float = 0.0

    @property
    def direction(self) -> float:
        return math.copysign(1.0, self.end_metres - self.start_metres)

    def points(self) -> tuple[Doubles, Doubles, Doubles]:
        """Times, and places along and beside the line, [n] each."""
        seconds = abs(self.end_metres - self.start_metres) / self.speed_mps
        times = np.arange(0.0, seconds, _STROKE_STEP_SECONDS)
        along = self.start_metres + self.direction * self.speed_mps * times
        return times, along, np.full_like(along, self.beside_metres)

    def begun_earlier(self, metres: float) -> Pass:
        return replace(self, start_metres=self.start_metres - self.direction * metres)


@dataclass(frozen=True)
class Rounds:
    """Two rounds of a circle at 1 N."""

    radius_metres: float = 0.015
    speed_mps: float = 0.1

    @property
    def round_seconds(self) -> float:
        return 2.0 * math.pi * self.radius_metres / self.speed_mps

    def points(self) -> tuple[Doubles, Doubles, Doubles]:
        times = np.arange(0.0, 2.0 * self.round_seconds + 0.1, _STROKE_STEP_SECONDS)
        angle = times * self.speed_mps / self.radius_metres
        return times, self.radius_metres * np.cos(angle), self.radius_metres * np.sin(angle)


class Stroke(Protocol):
    """A stroke over a table: times [n] from 0 on, and places along and beside the line, [n] each."""

    def points(self) -> tuple[Doubles, Doubles, Doubles]: ...


@dataclass(frozen=True)
class Renderer:
    """Renders strokes with one engine. Threads may share it."""

    engine: Path
    model: Path
    update_rate_hz: float = 90.0

    def wave(self, table: Table, stroke: Stroke, seed: int = 1) -> Doubles:
        """The vibration [n] in m/s^2 at 2 kHz, from the stroke's first moment on."""
        times, along, beside = stroke.points()
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            scene, csv, wav = folder / "scene.json", folder / "stroke.csv", folder / "out.wav"
            scene.write_text(json.dumps(table.scene(self.update_rate_hz)), encoding="utf-8")
            columns = np.column_stack([times, table.to_world(along, beside), np.ones_like(times)])
            write_rows(csv, columns)
            return rendered_samples(self.engine, scene, csv, wav, model=self.model, seed=seed) * FULL_SCALE_MPS2


# One sample at 100 mm/s.
STEP_METRES = 5e-5
SHIFT_METRES = 1e-3
# From one value of a profile to the next: a straight line between values as far apart as samples would swallow high
# frequencies.
VALUE_METRES = STEP_METRES / 8.0
_BUMP_DISTANCE_METRES = 0.003
# Of the RMS. A Gaussian wave exceeds the first once in fifteen metres, the second twice a metre.
_BUMP_SIZE, _FOUND_SIZE = 4.5, 3.5


@dataclass(frozen=True)
class Profile:
    """A wave over place: values at `start_metres` + n VALUE_METRES."""

    start_metres: float
    values: Doubles

    def between(self, low_metres: float, high_metres: float, shift_metres: float = 0.0) -> Doubles:
        places = np.arange(low_metres, high_metres, STEP_METRES) + shift_metres
        known = self.start_metres + VALUE_METRES * np.arange(len(self.values))
        return np.interp(places, known, self.values)


def over_place(wave: Doubles, stroke: Pass) -> Profile:
    """The wave of a pass, resampled from its own samples per millimetre, in the direction of growing places."""
    ratio = Fraction(stroke.speed_mps / SAMPLE_RATE_HZ / VALUE_METRES).limit_denominator(1000)
    values = resample_poly(wave, ratio.numerator, ratio.denominator)
    if stroke.direction > 0.0:
        return Profile(stroke.start_metres, values)
    return Profile(stroke.start_metres - VALUE_METRES * (len(values) - 1), values[::-1])


@dataclass(frozen=True)
class Likeness:
    """Correlation after the best shift within a millimetre, that shift, and the correlation without one."""

    correlation: float
    shift_metres: float
    unshifted: float


def likeness(first: Profile, second: Profile, low_metres: float, high_metres: float) -> Likeness:
    reference = first.between(low_metres, high_metres)

    def at(shift: float) -> float:
        return float(np.corrcoef(reference, second.between(low_metres, high_metres, shift))[0, 1])

    shifts = np.arange(-SHIFT_METRES, SHIFT_METRES + 1e-9, 0.5 * STEP_METRES)
    found = [at(shift) for shift in shifts]
    best = int(np.argmax(found))
    return Likeness(found[best], float(shifts[best]), at(0.0))


def bumps(profile: Profile, low_metres: float, high_metres: float) -> Doubles:
    """Places of the outsized asperities: peaks, 3 mm apart or more, above 4.5 times the RMS."""
    size = _relative_size(profile.between(low_metres, high_metres))
    distance = round(_BUMP_DISTANCE_METRES / STEP_METRES)
    peaks, _ = find_peaks(size, distance=distance, height=_BUMP_SIZE)
    places: Doubles = low_metres + STEP_METRES * peaks
    return places


def found_again(places: Doubles, second: Profile, low_metres: float, high_metres: float) -> int:
    """Number of the places within a millimetre of which the second pass exceeds 3.5 times its RMS."""
    size = _relative_size(second.between(low_metres, high_metres))
    at = low_metres + STEP_METRES * np.arange(len(size))
    return sum(bool(np.any(size[np.abs(at - place) <= SHIFT_METRES] >= _FOUND_SIZE)) for place in places)


def _relative_size(wave: Doubles) -> Doubles:
    return np.abs(wave) / np.sqrt(np.mean(np.square(wave)))


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
