"""Measures how late the vibration's level follows the stylus's speed, by rendering strokes of known speed."""

from __future__ import annotations

import tempfile
import zlib
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from haptoflow_benchmark.engine_render import on_table_spline, rendered_samples, write_rows, write_scene
from haptoflow_training.waveform import SAMPLE_RATE_HZ

RATES_HZ = (72.0, 90.0, 120.0)
LABELS = ("wood", "sandpaper", "leather")
SEEDS = (1, 2, 3)
# Of a tracker, on each axis.
NOISE_METRES = 0.00002
SCRIBBLE, REAL = "scribbles", "real strokes"

_SCRIBBLES = ((2.0, 0.020), (3.0, 0.010))
_SCRIBBLE_SECONDS = 4.0
_FORCE_NEWTONS = 1.0
# The path is written so finely that the frames' straight lines between its samples follow it.
_PATH_HZ = 1000.0
# Deep enough for every lift of a stroke.
_TIP_RADIUS_METRES, _DEPTH_METRES = 0.5, 0.25
_LEVEL_SECONDS = 0.012
_LAGS_MS = np.arange(-30.0, 90.5, 0.5)
# Slower than this the texture ends; compared are times at which the pen is faster.
_SLOWEST_MPS = 0.02
_START_SECONDS = 0.3

Array = NDArray[np.float64]


@dataclass(frozen=True)
class LagStroke:
    """path: [n] s to [n, 3] m, y up from the table. speed: [n] s to m/s along it."""

    kind: str
    name: str
    seconds: float
    path: Callable[[Array], Array]
    speed: Callable[[Array], Array]


def lag_strokes(recorded: Mapping[str, Array]) -> Iterator[LagStroke]:
    """Scribbles of 2 and 3 Hz, and the recorded strokes."""
    for hertz, metres in _SCRIBBLES:
        yield _scribble(hertz, metres)
    for name, stroke in recorded.items():
        yield _recorded(name, stroke)


def _scribble(hertz: float, metres: float) -> LagStroke:
    turn = 2.0 * np.pi * hertz
    return LagStroke(
        SCRIBBLE, f"{hertz:g} Hz", _SCRIBBLE_SECONDS,
        lambda t: metres * np.sin(turn * t)[:, None] * np.array([0.8, 0.0, 0.6]),
        lambda t: metres * turn * np.abs(np.cos(turn * t)),
    )  # fmt: skip


def _recorded(name: str, stroke: Array) -> LagStroke:
    seconds, spline = on_table_spline(stroke)
    slope = spline.derivative()
    return LagStroke(REAL, name, seconds, spline, lambda t: np.linalg.norm(slope(t)[:, [0, 2]], axis=1))


def measure_lags(
    engine: Path, model: Path, recorded: Mapping[str, Array], *,
    workers: int = 1, advance: Callable[[], object] = lambda: None,
) -> dict[str, Any]:  # fmt: skip
    """By kind of stroke and frame rate: the lag in ms at which log level over labels, strokes and seeds correlates best
    with log speed, and that correlation."""
    strokes = list(lag_strokes(recorded))
    cases = [(stroke, rate, label) for stroke in strokes for rate in RATES_HZ for label in LABELS]

    def correlated(case: tuple[LagStroke, float, str]) -> Array:
        stroke, rate, label = case
        found = correlations(stroke, mean_power(engine, model, stroke, rate, label))
        advance()
        return found

    with ThreadPoolExecutor(max_workers=workers) as pool:
        curves = list(pool.map(correlated, cases))
    report: dict[str, Any] = {}
    for kind in (SCRIBBLE, REAL):
        report[kind] = {}
        for rate in RATES_HZ:
            own = [
                curve * stroke.seconds
                for (stroke, at, _), curve in zip(cases, curves, strict=True)
                if stroke.kind == kind and at == rate
            ]
            seconds = sum(stroke.seconds for stroke, at, _ in cases if stroke.kind == kind and at == rate)
            curve = np.sum(own, axis=0) / seconds
            report[kind][f"{rate:g}"] = {
                "lag_ms": round(peak_ms(curve), 1), "correlation": round(float(curve.max()), 3),
            }  # fmt: skip
    return report


def mean_power(engine: Path, model: Path, stroke: LagStroke, rate_hz: float, label: str) -> Array:
    """Squared vibration at 2 kHz from the stroke's beginning, [n], mean over the seeds of noise and network."""
    return np.mean([_rendered(engine, model, stroke, rate_hz, label, seed) ** 2 for seed in SEEDS], axis=0)


def _rendered(engine: Path, model: Path, stroke: LagStroke, rate_hz: float, label: str, seed: int) -> Array:
    times = np.arange(0.0, stroke.seconds, 1.0 / _PATH_HZ)
    generator = np.random.default_rng(zlib.crc32(f"{stroke.name} {rate_hz} {seed}".encode()))
    places = stroke.path(times) + [0.0, _DEPTH_METRES, 0.0] + NOISE_METRES * generator.standard_normal((len(times), 3))
    with tempfile.TemporaryDirectory() as folder:
        scene, table, wav = (Path(folder) / name for name in ("scene.json", "stroke.csv", "out.wav"))
        write_scene(scene, label, rate_hz, _TIP_RADIUS_METRES)
        write_rows(table, np.c_[times, places, np.full(len(times), _FORCE_NEWTONS)])
        waveform = rendered_samples(engine, scene, table, wav, model=model, seed=seed, options=("--quiet",))
    return np.asarray(waveform[: int(stroke.seconds * SAMPLE_RATE_HZ)])


def correlations(stroke: LagStroke, power: Array) -> Array:
    """Of log level with log speed a lag earlier, for each lag tried; the same times for all lags."""
    window = np.hanning(int(_LEVEL_SECONDS * SAMPLE_RATE_HZ) + 1)
    level = 0.5 * np.log(np.maximum(np.convolve(power, window / window.sum(), mode="same"), 1e-12))
    margin = int(_LAGS_MS[-1] * 1e-3 * SAMPLE_RATE_HZ)
    times = np.arange(int(_START_SECONDS * SAMPLE_RATE_HZ), len(power) - margin) / SAMPLE_RATE_HZ
    speed = stroke.speed(times)
    times, logarithm = times[speed > _SLOWEST_MPS], np.log(speed[speed > _SLOWEST_MPS])
    index = (times * SAMPLE_RATE_HZ).round().astype(int)
    shifts = (_LAGS_MS * 1e-3 * SAMPLE_RATE_HZ).round().astype(int)
    return np.array([np.corrcoef(logarithm, level[index + shift])[0, 1] for shift in shifts])


def peak_ms(curve: Array) -> float:
    """The lag of the highest correlation, between the lags tried by a parabola."""
    best = int(np.clip(curve.argmax(), 1, len(curve) - 2))
    before, here, after = curve[best - 1 : best + 2]
    bend = before - 2.0 * here + after
    return float(_LAGS_MS[best] + (0.5 * (before - after) / bend if bend < 0.0 else 0.0) * (_LAGS_MS[1] - _LAGS_MS[0]))
