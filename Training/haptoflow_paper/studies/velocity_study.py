"""The study of velocity estimators: parameters chosen on some persons, figures on the others."""

from __future__ import annotations

import csv
import io
import tempfile
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from haptoflow_benchmark.engine_render import run_engine, write_scene
from haptoflow_paper.studies.velocity_cases import (
    NOISES_METRES, RATES_HZ, Array, Estimator, VelocityCase, adaptive_window, end_of_parabola, growing_parabola,
    kalman, line, made_motions, person_of, real_motions, sampled
)
from haptoflow_training.model_stamp import table

# A ratio of speeds says nothing at rest.
_MOVING_MPS = 0.02
_SLOWEST_MPS = 0.001


@dataclass
class VelocityErrors:
    """Errors of one estimator over cases of one kind, rate and noise."""

    _decibels: list[Array] = field(default_factory=list)
    _vectors_mps: list[Array] = field(default_factory=list)
    _speeds_mps: list[Array] = field(default_factory=list)
    _biases_mps: list[Array] = field(default_factory=list)
    _intervals: list[float] = field(default_factory=list)

    def add(self, case: VelocityCase, velocity_mps: Array, known: NDArray[np.bool_]) -> None:
        """velocity_mps: [n, 2] along the table. known: [n], false where the estimator gave none."""
        counted = case.counted & known
        true, speed = np.linalg.norm(case.velocity_mps, axis=1), np.linalg.norm(velocity_mps, axis=1)
        moving = counted & (true >= _MOVING_MPS)
        self._decibels.append(20.0 * np.log10(np.maximum(speed[moving], _SLOWEST_MPS) / true[moving]))
        self._vectors_mps.append(np.linalg.norm(velocity_mps - case.velocity_mps, axis=1)[counted])
        self._speeds_mps.append(speed[counted])
        self._biases_mps.append((speed - true)[counted])
        for moment, before, after in case.steps:
            half = (before + after) / 2.0
            follows = (case.times_s >= moment) & known & ((speed >= half) if after > before else (speed <= half))
            if follows.any():
                self._intervals.append(float(case.times_s[follows.argmax()] - moment) * case.rate_hz)

    def figures(self) -> dict[str, float]:
        """Speed error in dB over moving samples (RMS), vector error, speed and bias of speed in mm/s, and time to the
        half of a step in pose intervals (mean, 95th percentile); those that there are."""
        found = {
            "speed_error_db": _rms(self._decibels),
            "vector_error_mmps": 1000.0 * _rms(self._vectors_mps),
            "speed_mmps": 1000.0 * _rms(self._speeds_mps),
            "bias_mmps": 1000.0 * _mean(self._biases_mps),
        }
        if self._intervals:
            found["half_intervals"] = float(np.mean(self._intervals))
            found["half_intervals_p95"] = float(np.quantile(self._intervals, 0.95))
        return {name: round(value, 3) for name, value in found.items() if np.isfinite(value)}


def pooled_rms(values: Iterable[float]) -> float:
    """The root of the mean of squares."""
    return float(np.sqrt(np.mean(np.square(list(values)))))


def _rms(parts: Sequence[Array]) -> float:
    everything = np.concatenate(parts)
    return float(np.sqrt(np.mean(everything**2))) if len(everything) else float("nan")


def _mean(parts: Sequence[Array]) -> float:
    everything = np.concatenate(parts)
    return float(everything.mean()) if len(everything) else float("nan")


TODAY, PRODUCT = "line over 35 ms", "product"
# Settings of the growing parabola in the product, set on the choosing persons in a trial before this study: the
# smallest errors of scribbles that leave rest with 0.1 mm of noise as quiet as with the line.
PRODUCT_SETTINGS = {"cubic": 3.0, "cost_mps": 0.01}
# Rates at which parameters are chosen: those of headsets.
HEADSET_RATES_HZ = (72.0, 90.0, 120.0)
_CHOOSING_SEED = 1
_REPORTING_SEEDS = (2, 3)
_MAKERS: Mapping[str, Callable[..., Estimator]] = {
    "line": line, "adaptive": adaptive_window, "end": end_of_parabola, "growing": growing_parabola, "kalman": kalman,
}  # fmt: skip
_Settings = Mapping[str, float]
# The rows of the table: for each, the function that makes its estimator, and the settings among which the study chooses.
CANDIDATES: Mapping[str, tuple[str, Sequence[_Settings]]] = {
    TODAY: ("line", [{"seconds": 0.035}]),
    "line over another time": ("line", [{"seconds": value} for value in (0.02, 0.028, 0.05)]),
    "adaptive window, first order": ("adaptive", [
        {"order": 1, "least": 2, "band": band} for band in (2.0, 2.5, 3.0, 3.5, 4.0)
    ]),
    "adaptive window, second order": ("adaptive", [
        {"order": 2, "least": least, "band": band} for least in (3, 4) for band in (2.0, 2.5, 3.0, 3.5, 4.0)
    ]),
    "end of a parabola": ("end", [{"seconds": value} for value in (0.03, 0.04, 0.05, 0.06)]),
    "Kalman filter, white jerk": ("kalman", [{"jerk": value} for value in (3.0, 10.0, 30.0, 100.0)]),
    "growing parabola": ("growing", [
        {"cubic": cubic, "cost_mps": cost} for cubic in (2.5, 3.0, 3.5) for cost in (0.005, 0.01, 0.02)
    ]),
}  # fmt: skip
_Key = tuple[str, float, float]


@dataclass(frozen=True)
class VelocityPlan:
    """strokes: by name, as recorded. choosing: persons on whom parameters are chosen. engine: the built command
    line."""

    strokes: Mapping[str, Array]
    choosing: tuple[str, ...]
    engine: Path
    rates_hz: tuple[float, ...] = RATES_HZ
    workers: int = 2

    @property
    def reporting(self) -> tuple[str, ...]:
        """The other persons."""
        return tuple(sorted({person_of(name) for name in self.strokes} - set(self.choosing)))


def run_study(plan: VelocityPlan, advance: Callable[[], object]) -> dict[str, Any]:
    """By row the chosen settings and the figures of every kind of stroke, rate and noise. Advances once for each
    set of settings tried, once for each row."""
    choosing = list(_cases(plan, plan.choosing, HEADSET_RATES_HZ, (_CHOOSING_SEED,)))
    reporting = list(_cases(plan, plan.reporting, plan.rates_hz, _REPORTING_SEEDS))
    rows: dict[str, Any] = {}
    with ProcessPoolExecutor(plan.workers) as pool:
        tried = {
            row: [pool.submit(_measured, maker, settings, choosing) for settings in options]
            for row, (maker, options) in CANDIDATES.items()
        }
        today = tried[TODAY][0].result()
        reported = {}
        for row, (maker, options) in CANDIDATES.items():
            scores = []
            for each in tried[row]:
                scores.append(score(each.result(), today))
                advance()
            best = int(np.argmin(scores))
            rows[row] = {"settings": dict(options[best]), "score": round(scores[best], 3)}
            reported[row] = pool.submit(_measured, maker, options[best], reporting)
        rows[PRODUCT] = {"settings": PRODUCT_SETTINGS}
        reported[PRODUCT] = pool.submit(_measured_product, plan.engine, reporting)
        for row, figures in reported.items():
            rows[row]["cells"] = [
                {"kind": kind, "rate_hz": rate, "noise_mm": 1000.0 * noise, **found}
                for (kind, rate, noise), found in figures.result().items()
            ]
            advance()
    return rows


def steps_of(plan: VelocityPlan) -> int:
    """How often `run_study` advances."""
    return sum(len(options) + 1 for _, options in CANDIDATES.values()) + 1


def score(figures: Mapping[_Key, Mapping[str, float]], today: Mapping[_Key, Mapping[str, float]]) -> float:
    """Geometric mean of ratios to today's figures over headset rates, noise above 0: speed error of scribbles, speed
    and vector error of real strokes, vector error of slow strokes, speed at rest."""
    logarithms = []
    for group, figure in (("scribble", "speed_error_db"), ("real", "speed_error_db"), ("real", "vector_error_mmps"),
                          ("slow", "vector_error_mmps"), ("rest", "speed_mmps")):  # fmt: skip
        keys = [key for key in today if key[0].startswith(group) and key[2] > 0.0]
        ratio = pooled_rms(figures[key][figure] for key in keys) / pooled_rms(today[key][figure] for key in keys)
        logarithms.append(np.log(ratio))
    return float(np.exp(np.mean(logarithms)))


def _cases(
    plan: VelocityPlan, persons: tuple[str, ...], rates_hz: Iterable[float], seeds: Iterable[int]
) -> Iterator[VelocityCase]:
    for seed in seeds:
        for motion in (*made_motions(), *real_motions(plan.strokes, persons)):
            for rate in rates_hz:
                for noise in NOISES_METRES:
                    yield sampled(motion, rate, noise, seed)


def _measured(maker: str, settings: _Settings, cases: Sequence[VelocityCase]) -> dict[_Key, dict[str, float]]:
    estimate = _MAKERS[maker](**settings)

    def velocity_of(case: VelocityCase) -> tuple[Array, NDArray[np.bool_]]:
        found = estimate(case.times_s, case.measured_m, case.noise_known_m)
        return found[:, [0, 2]], np.ones(len(found), dtype=bool)

    return _figures(cases, velocity_of)


def _measured_product(engine: Path, cases: Sequence[VelocityCase]) -> dict[_Key, dict[str, float]]:
    return _figures(cases, lambda case: product_velocity(engine, case))


def _figures(
    cases: Sequence[VelocityCase], velocity_of: Callable[[VelocityCase], tuple[Array, NDArray[np.bool_]]]
) -> dict[_Key, dict[str, float]]:
    errors: dict[_Key, VelocityErrors] = defaultdict(VelocityErrors)
    for case in cases:
        kind = "real" if case.kind.startswith("real") else "steps" if case.kind.startswith("steps") else case.kind
        errors[kind, case.rate_hz, case.noise_m].add(case, *velocity_of(case))
    return {key: each.figures() for key, each in errors.items()}


def product_velocity(engine: Path, case: VelocityCase) -> tuple[Array, NDArray[np.bool_]]:
    """What `haptoflow contact` says of a case: [n, 2] in m/s along the table, x and z, and [n] where it touches."""
    # Deep enough for every lift of a stroke.
    tip_radius, depth = 0.5, 0.25
    with tempfile.TemporaryDirectory() as folder:
        scene, stroke = Path(folder) / "scene.json", Path(folder) / "stroke.csv"
        write_scene(scene, "wood", case.rate_hz, tip_radius)
        columns = np.c_[case.times_s, case.measured_m + [0.0, depth, 0.0]]
        np.savetxt(stroke, columns, fmt="%.12g", delimiter=",", header="t,x,y,z", comments="")
        command = [str(engine), "contact", str(scene), "--stroke", str(stroke), "--as-recorded"]
        printed = run_engine([*command, "--default-stiffness", "500"])
    lines = list(csv.DictReader(io.StringIO(printed)))
    # The second tangent axis is -z.
    velocity = np.array([[float(each["vx_mps"]), -float(each["vy_mps"])] for each in lines])
    return velocity, np.array([each["touching"] == "1" for each in lines])


_SCRIBBLES = ("scribble 2 Hz", "scribble 3 Hz", "scribble 5 Hz")
_SLOW = ("slow 2 mm/s", "slow 5 mm/s", "slow 10 mm/s", "slow 20 mm/s")
_NOISE_MM = 0.1
_ALLOWED_INTERVALS = 1.5
_Cells = Sequence[Mapping[str, Any]]


def page_words(results: Mapping[str, Any]) -> str:
    """Markdown of the page's measured part."""
    rows, persons = results["rows"], results["reporting"]
    return "\n\n".join(
        [
            f"Persons {', '.join(persons)}, on whom nothing was chosen; commit `{results['commit'][:12]}`. Noise of "
            f"{_NOISE_MM} mm on each axis, 72, 90 and 120 Hz together:",
            estimators_table(rows),
            "The product beside the line over 35 ms (product / line), by rate and noise:",
            rates_table(rows),
            verdict_words(rows),
        ]
    )


def estimators_table(rows: Mapping[str, Any]) -> str:
    """A row for each estimator."""
    headings = [
        "estimator", "2, 3, 5 Hz scribble, dB", "reversals, dB", "real strokes, dB; vector, mm/s",
        "slow strokes, vector, mm/s", "rest, mm/s", "half of a step, intervals; 95th percentile",
    ]  # fmt: skip
    lines = []
    for name, row in rows.items():
        cells = [each for each in row["cells"] if each["rate_hz"] in HEADSET_RATES_HZ and _is_near(each, _NOISE_MM)]
        settings = ", ".join(f"{key} {value:g}" for key, value in row["settings"].items())
        lines.append([
            f"**{name}**" if name == PRODUCT else f"{name}{f' ({settings})' if settings else ''}",
            ", ".join(f"{_of(cells, kind, 'speed_error_db'):.1f}" for kind in _SCRIBBLES),
            f"{_of(cells, 'reversals', 'speed_error_db'):.1f}",
            f"{_of(cells, 'real', 'speed_error_db'):.1f}; {_of(cells, 'real', 'vector_error_mmps'):.0f}",
            f"{pooled_rms(_of(cells, kind, 'vector_error_mmps') for kind in _SLOW):.1f}",
            f"{_of(cells, 'rest', 'speed_mmps'):.1f}",
            f"{_mean_of(cells, 'half_intervals'):.1f}; {_mean_of(cells, 'half_intervals_p95'):.1f}",
        ])  # fmt: skip
    return table(headings, lines)


def rates_table(rows: Mapping[str, Any]) -> str:
    """The product and today's line at every rate and noise."""
    cells = rows[PRODUCT]["cells"]
    lines = []
    for rate in sorted({each["rate_hz"] for each in cells}):
        for noise in sorted({each["noise_mm"] for each in cells}):
            both = [
                [each for each in rows[name]["cells"] if each["rate_hz"] == rate and _is_near(each, noise)]
                for name in (PRODUCT, TODAY)
            ]
            lines.append([
                f"{rate:.0f} Hz, {noise:g} mm",
                *(_pair(both, kind, "speed_error_db", "{:.1f}") for kind in (*_SCRIBBLES, "reversals", "real")),
                _pair(both, "slow 5 mm/s", "bias_mmps", "{:+.1f}"),
                _pair(both, "rest", "speed_mmps", "{:.1f}"),
                _pair(both, "steps", "half_intervals", "{:.1f}"),
            ])  # fmt: skip
    headings = ["", "2 Hz, dB", "3 Hz, dB", "5 Hz, dB", "reversals, dB", "real, dB", "bias at 5 mm/s", "rest, mm/s",
                "half of a step, intervals"]  # fmt: skip
    return table(headings, lines)


def verdicts(rows: Mapping[str, Any]) -> list[tuple[str, list[tuple[float, float]]]]:
    """Goal, and by noise the product's figure and what it may be, at headset rates together."""
    cells = {
        name: [each for each in rows[name]["cells"] if each["rate_hz"] in HEADSET_RATES_HZ] for name in (PRODUCT, TODAY)
    }
    noises = sorted({float(each["noise_mm"]) for each in cells[PRODUCT]})

    def compared(kinds: Sequence[str], figure: str, share: float) -> list[tuple[float, float]]:
        def of(name: str, noise: float) -> float:
            return pooled_rms(_of(_at(cells[name], noise), kind, figure) for kind in kinds)

        return [(of(PRODUCT, noise), share * of(TODAY, noise)) for noise in noises]

    found = [
        (f"{kind}: at most half of the line's error, dB", compared([kind], "speed_error_db", 0.5))
        for kind in _SCRIBBLES
    ]
    found.append(("slow strokes: not worse than the line, vector, mm/s", compared(_SLOW, "vector_error_mmps", 1.0)))
    found.append(("rest: not worse than the line, mm/s", compared(["rest"], "speed_mmps", 1.0)))
    intervals = [(_mean_of(_at(cells[PRODUCT], noise), "half_intervals"), _ALLOWED_INTERVALS) for noise in noises]
    return [*found, ("half of a step, intervals", intervals)]


def verdict_words(rows: Mapping[str, Any]) -> str:
    """Markdown: a table of goals, met or missed."""
    noises = sorted({float(each["noise_mm"]) for each in rows[PRODUCT]["cells"]})
    lines = [[goal, *(_verdict(*pair) for pair in pairs)] for goal, pairs in verdicts(rows)]
    return table(["goal, 72 to 120 Hz", *(f"{noise:g} mm" for noise in noises)], lines)


def _verdict(ours: float, allowed: float) -> str:
    # Figures are kept to thousandths.
    return f"{ours:.2f} of {allowed:.2f}: {'met' if ours <= allowed + 0.001 else '**missed**'}"


def _at(cells: _Cells, noise_mm: float) -> _Cells:
    return [each for each in cells if _is_near(each, noise_mm)]


def _is_near(cell: Mapping[str, Any], noise_mm: float) -> bool:
    return abs(float(cell["noise_mm"]) - noise_mm) < 1e-9


def _of(cells: _Cells, kind: str, figure: str) -> float:
    return pooled_rms(each[figure] for each in cells if each["kind"] == kind)


def _mean_of(cells: _Cells, figure: str) -> float:
    found = [each[figure] for each in cells if figure in each]
    return float(sum(found) / len(found))


def _pair(both: Sequence[_Cells], kind: str, figure: str, form: str) -> str:
    return " / ".join(
        form.format(each[figure]) for cells in both for each in cells if each["kind"] == kind and figure in each
    )
