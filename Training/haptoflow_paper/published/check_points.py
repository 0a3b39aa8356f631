"""What each choice of solver steps and guidance costs, and how far it is from the file's best tier."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from haptoflow_benchmark.engine_library import EngineLibrary
from haptoflow_benchmark.waveform_metrics import log_spectral_distance_db, rms
from haptoflow_paper.published.check_lines import Line, inapplicable, judged
from haptoflow_paper.rows.engine_generator import SOLVED_KINDS, EngineGenerator
from haptoflow_paper.rows.timing import Milliseconds, TimedSource, time_sources
from haptoflow_training.waveform import SEGMENT_SAMPLES

# As quality_control.hpp.
UPDATE_RATE_HZ = 72.0
BUDGET_SHARE = 0.25
BUDGET_MS = 1000.0 * BUDGET_SHARE / UPDATE_RATE_HZ
# As import-published names them.
_UNGUIDED = "unguided"
# A segment plays so long, and is asked for at an update: a slower tier leaves gaps.
_KEEPS_UP_MS = 100.0 - 1000.0 / UPDATE_RATE_HZ
_SEGMENTS = 4
_IDLE_SHARE = 0.5
_COMPARED_LABELS = 6
_BLOCKS = 4
_PART = "time"
_REMEDY = "choose a tier that fits by its name, or distil the file into one whose tiers do (haptoflow-paper distil)"

_Floats = NDArray[np.float32]


@dataclass(frozen=True)
class Point:
    """A tier of the file (`is_tier`), or its graph with another number of steps. family: what a line of the chart
    joins."""

    name: str
    tier: str
    solver: str
    steps: int
    family: str
    is_tier: bool


@dataclass(frozen=True)
class Measured:
    """Milliseconds of one segment. difference: RMS of the difference from the best point by the level, for the same
    noise and past. lsd_db: of the same waves."""

    point: Point
    hot: Milliseconds
    paced: Milliseconds
    difference: float
    lsd_db: float


def points_of(header: dict[str, Any]) -> list[Point]:
    """Of each graph that is solved, its most steps and halves of them down to 1; every other tier as it is. The file's
    default tier, the best, comes last."""
    points: list[Point] = []
    for group in _groups(header["tiers"]):
        best = max(group, key=lambda tier: int(tier.get("steps") or 1))
        if best["kind"] not in SOLVED_KINDS:
            points += [Point(tier["name"], tier["name"], "tier", 0, tier["name"], True) for tier in group]
            continue
        family = _family(best, header["tiers"])
        most = max(int(tier["steps"]) for tier in header["tiers"] if tier["kind"] == best["kind"])
        steps = {int(tier["steps"]): tier for tier in group}
        halves = {max(1, most >> power) for power in range(most.bit_length())}
        for count in sorted(halves | set(steps)):
            tier = steps.get(count)
            name = tier["name"] if tier else f"{family}, {count} step{'' if count == 1 else 's'}"
            points.append(Point(name, best["name"], best["solver"], count, family, tier is not None))
    last = next(point for point in points if point.name == header["default_tier"])
    return [point for point in points if point is not last] + [last]


def _family(tier: dict[str, Any], tiers: list[dict[str, Any]]) -> str:
    if not any(each["name"].endswith(_UNGUIDED) for each in tiers):
        return str(tier["kind"])
    return "without guidance" if tier["name"].endswith(_UNGUIDED) else "with guidance"


def _groups(tiers: list[dict[str, Any]]) -> list[list[dict[str, Any]]]:
    groups: dict[Any, list[dict[str, Any]]] = {}
    for tier in tiers:
        groups.setdefault((tier["kind"], tier.get("field") or tier["name"]), []).append(tier)
    return list(groups.values())


class _Source:
    """One generator with the solver of a point; points of one graph share it, because a codec has many weights."""

    pasts, noise_before = 1, 0

    def __init__(self, generator: EngineGenerator, point: Point) -> None:
        self._generator, self._point = generator, point

    def generate(
        self, embeddings: _Floats, motions: _Floats, previous: _Floats, noise: _Floats, phases: _Floats | None = None
    ) -> _Floats:
        self._generator.set_solver(self._point.solver, self._point.steps)
        return self._generator.generate(embeddings, motions, previous, noise, phases)


@contextmanager
def _sources(engine: EngineLibrary, path: Path, points: list[Point], batch: int) -> Iterator[dict[Point, _Source]]:
    generators: dict[str, EngineGenerator] = {}
    try:
        for point in points:
            if point.tier not in generators:
                generators[point.tier] = EngineGenerator(engine, path, point.tier, maximum_batch=batch)
        yield {point: _Source(generators[point.tier], point) for point in points}
    finally:
        for generator in generators.values():
            generator.close()


def measure_points(
    engine: EngineLibrary,
    path: Path,
    reference: Path,
    header: dict[str, Any],
    runs: int,
    advance: Callable[[int], None],
) -> tuple[list[Measured], Measured]:
    """The points of a file, and the default tier of the named reference, timed in the same run. runs: of each pace in
    each of four blocks. advance: told of each block and comparison."""
    points = points_of(header)
    distances = _distances(engine, path, points, header, advance)
    with _sources(engine, path, points, 1) as sources, EngineGenerator(engine, reference, maximum_batch=1) as other:
        named = Point("reference", str(other.header["default_tier"]), "tier", 0, "reference", False)
        timed = [TimedSource(point.name, source) for point, source in sources.items()]
        timed.append(TimedSource(named.name, _Source(other, named)))
        hot, paced = (
            time_sources(timed, blocks=_BLOCKS, runs_per_block=runs, period_seconds=period, seed=5, advance=advance)
            for period in (0.0, 1.0 / UPDATE_RATE_HZ)
        )
    found = [Measured(point, hot[point.name], paced[point.name], *distances[point]) for point in points]
    return found, Measured(named, hot[named.name], paced[named.name], float("nan"), float("nan"))


def blocks_to_measure(header: dict[str, Any]) -> int:
    """How often measure_points calls `advance`."""
    points = len(points_of(header))
    return points + 2 * _BLOCKS * (points + 1)


def _distances(
    engine: EngineLibrary, path: Path, points: list[Point], header: dict[str, Any], advance: Callable[[int], None]
) -> dict[Point, tuple[float, float]]:
    labels = np.linspace(0, len(header["labels"]) - 1, min(_COMPARED_LABELS, len(header["labels"]))).astype(int)
    speed, force = (np.mean(header["range"][key]) for key in ("speed_mps", "force_newtons"))
    motions = np.tile(np.array([[speed, 0.0, force]], dtype=np.float32), (len(labels), 1))
    numbers = np.random.default_rng(11)
    noise = numbers.standard_normal((_SEGMENTS, len(labels), SEGMENT_SAMPLES), dtype=np.float32)
    with _sources(engine, path, points, len(labels)) as sources:
        generator = next(iter(sources.values()))._generator
        embeddings = generator.embeddings[labels]
        # The best one's past for all, so that an early difference is not counted again in every later segment.
        past = [np.zeros((len(labels), SEGMENT_SAMPLES), dtype=np.float32)]
        for given in noise:
            past.append(sources[points[-1]].generate(embeddings, motions, past[-1], given))
        best = np.concatenate(past[1:], axis=1)
        found = {}
        for point, source in sources.items():
            segments = [source.generate(embeddings, motions, *given) for given in zip(past[:-1], noise, strict=True)]
            pairs = list(zip(np.concatenate(segments, axis=1), best, strict=True))
            found[point] = (
                float(np.median([rms(wave - truth) / max(rms(truth), 1e-9) for wave, truth in pairs])),
                float(np.median([log_spectral_distance_db(wave, truth) for wave, truth in pairs])),
            )
            advance(1)
    return found


def automatic_choice(
    header: dict[str, Any], p99: dict[str, float], median: dict[str, float], budget_ms: float = BUDGET_MS
) -> tuple[str, bool]:
    """The tier that quality `auto` takes for one voice, and whether it fits the budget: the last in order of accuracy
    whose 99th percentile fits, or the one of the least median (quality_control.cpp). p99, median: by tier, in ms."""
    tiers = header["tiers"]
    order = [str(tier["name"]) for tier in tiers]
    accuracies = [tier.get("accuracy") or {} for tier in tiers]
    keys = ("lsd_db", "level_error_p90_db")
    if all(accuracy.get(key) is not None for accuracy in accuracies for key in keys):
        sums = [sum(float(accuracy[key]) for key in keys) for accuracy in accuracies]
        errors = dict(zip(order, sums, strict=True))
        order.sort(key=lambda name: -errors[name])
    fitting = [name for name in order if p99[name] <= budget_ms]
    return (fitting[-1], True) if fitting else (min(order, key=lambda name: median[name]), False)


def time_lines(header: dict[str, Any], found: list[Measured], reference: Measured, reference_name: str) -> list[Line]:
    """A line a tier, one for `auto`, and whether more steps come nearer to the best tier."""
    lines = []
    for each in found:
        if each.point.is_tier:
            ratio = each.hot.p50 / max(reference.hot.p50, 1e-9)
            lines.append(
                judged(
                    _PART, f"tier {each.point.name} keeps up", each.paced.p99 <= _KEEPS_UP_MS,
                    f"hot {each.hot.p50:.3g} ms (p99 {each.hot.p99:.3g}), paced {each.paced.p50:.3g} ms (p99 "
                    f"{each.paced.p99:.3g}); hot {ratio:.3g} times {reference_name}",
                    f"p99 paced at most {_KEEPS_UP_MS:.0f} ms, so that each segment joins the one before", _REMEDY,
                    hot_p50_ms=each.hot.p50, hot_p99_ms=each.hot.p99, paced_p50_ms=each.paced.p50,
                    paced_p99_ms=each.paced.p99, ratio_to_reference=ratio,
                )  # fmt: skip
            )
    return [*lines, _automatic(header, found), _steps_help(found)]


def idle_line(load: float, cores: int) -> Line:
    """load: processes that wanted to run in the last minute, before anything was measured."""
    return judged(
        _PART, "the machine was idle", load <= _IDLE_SHARE * cores, f"load {load:.1f} of {cores} cores when it began",
        f"at most {_IDLE_SHARE * cores:g}", "close other programs and run it again: every time below is too long",
        load=load, cores=cores,
    )  # fmt: skip


def _automatic(header: dict[str, Any], found: list[Measured]) -> Line:
    tiers = [each for each in found if each.point.is_tier]
    times = {each.point.name: each.paced.p99 for each in tiers}
    name, fits = automatic_choice(header, times, {each.point.name: each.hot.p50 for each in tiers})
    if fits:
        words = f"auto takes {name}"
    else:
        late = times[name] > _KEEPS_UP_MS
        consequence = (
            "longer than a segment lasts: playback breaks off between segments"
            if late
            else f"segments still join, and a change is felt {times[name]:.0f} ms later"
        )
        words = f"no tier is in real time: auto takes the fastest, {name}, {times[name]:.3g} ms; {consequence}"
    expected = f"a tier whose p99 is within {BUDGET_MS:.3g} ms, a quarter of an update at 72 Hz"
    return judged(_PART, "quality auto", fits, words, expected, _REMEDY, tier=name)


def _steps_help(found: list[Measured]) -> Line:
    name, best = "more steps are nearer the best tier", found[-1].point
    family = [each for each in found if each.point.family == best.family and each.point is not best]
    if not family:
        return inapplicable(_PART, name, "the best tier is not solved in steps", "nothing to do")
    ordered = sorted(family, key=lambda each: each.point.steps)
    distances = [each.difference for each in ordered]
    # A tenth of the first distance: with few labels neighbours may change places.
    passes = all(later <= before + 0.1 * distances[0] for before, later in zip(distances, distances[1:], strict=False))
    words = ", ".join(f"{each.point.steps}: {each.difference:.2g}" for each in ordered)
    return judged(
        _PART, name, passes, f"RMS of the difference by the level, by steps: {words}", "falling",
        "see the parity lines: a solver that is not the checkpoint's", distances=distances,
    )  # fmt: skip
