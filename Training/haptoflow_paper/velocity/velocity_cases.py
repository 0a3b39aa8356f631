"""Strokes whose true velocity is known, as a tracker reports them: real ones resampled, and made ones."""

from __future__ import annotations

import zlib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from haptoflow_benchmark.engine_render import on_table_spline
from haptoflow_paper.velocity.velocity_estimators import Array, tracker_noise

RATES_HZ = (72.0, 90.0, 120.0, 500.0)
NOISES_METRES = (0.0, 0.00002, 0.0001)
# Share of a frame's interval by which frames come early or late.
_FRAME_JITTER = 0.15
# Estimates of the tracker's noise settle before figures count.
_WARM_UP_SECONDS = 0.5
_TURN_SECONDS = 0.06

Place = Callable[[Array], Array]


@dataclass(frozen=True)
class VelocityCase:
    """kind: "scribble 2 Hz", "slow 5 mm/s", "real 4"... times_s: [n]; measured_m: [n, 3], y up from the table;
    noise_known_m: [n], what a tracker's noise was estimated to be by then. velocity_mps: [n, 2] along the table, x and
    z, true at each time. steps: [k, 3], time in s, speed before and after in m/s, of sudden changes."""

    kind: str
    rate_hz: float
    noise_m: float
    times_s: Array
    measured_m: Array
    noise_known_m: Array
    velocity_mps: Array
    steps: Array

    @property
    def counted(self) -> NDArray[np.bool_]:
        """[n], false while estimators warm up."""
        return self.times_s >= self.times_s[0] + _WARM_UP_SECONDS


@dataclass(frozen=True)
class Motion:
    """place, velocity: [n] seconds to [n, 3] m and m/s. steps: as a case's."""

    kind: str
    seconds: float
    place: Place
    velocity: Place
    steps: Array


def made_motions() -> Iterator[Motion]:
    """Scribbles, reversals, stops and starts, slow strokes, rest."""
    for hertz, amplitude in ((2.0, 0.020), (3.0, 0.010), (5.0, 0.005)):
        yield _scribble(hertz, amplitude)
    yield _polyline("reversals", _reversal_speeds(0.2, 3.5))
    for mps in (0.05, 0.15, 0.4):
        yield _stops_and_starts(mps)
    for mps in (0.0, 0.002, 0.005, 0.01, 0.02):
        yield _arc(mps)


def real_motions(strokes: Mapping[str, Array], persons: tuple[str, ...]) -> Iterator[Motion]:
    """Strokes of the persons, splines through the tracker's distinct positions, which it measured evenly in time. The
    warm-up is the stroke's beginning turned about its first point, which leaves the velocity there without a jump."""
    for name, stroke in strokes.items():
        person = person_of(name)
        if person not in persons:
            continue
        yield _led_in(f"real {person}", *on_table_spline(stroke))


def _led_in(kind: str, seconds: float, spline: CubicSpline) -> Motion:
    slope, begin = spline.derivative(), spline(0.0)
    before = min(_WARM_UP_SECONDS, seconds)

    def place(t: Array) -> Array:
        return np.asarray(begin + np.sign(t - before)[:, None] * (spline(np.abs(t - before)) - begin))

    return Motion(kind, before + seconds, place, lambda t: slope(np.abs(t - before)), np.empty((0, 3)))


def person_of(stroke: str) -> str:
    """The person of a stroke named as in the recordings, "Study1/4/..."."""
    return stroke.split("/")[1]


def sampled(motion: Motion, rate_hz: float, noise_m: float, seed: int) -> VelocityCase:
    """What a tracker with a noise on each axis says in jittered frames; the same for the same arguments."""
    name = f"{motion.kind} {motion.seconds} {rate_hz} {noise_m} {seed}"
    generator = np.random.default_rng(zlib.crc32(name.encode()))
    count = int(motion.seconds * rate_hz) - 1
    frames = np.arange(count) + generator.uniform() + generator.uniform(-_FRAME_JITTER, _FRAME_JITTER, count)
    times = np.clip(frames / rate_hz, 0.0, motion.seconds)
    places = motion.place(times) + noise_m * generator.standard_normal((count, 3))
    return VelocityCase(
        motion.kind, rate_hz, noise_m, times, places, tracker_noise(times, places), motion.velocity(times)[:, [0, 2]],
        motion.steps,
    )  # fmt: skip


def _scribble(hertz: float, amplitude: float) -> Motion:
    turn = 2.0 * np.pi * hertz
    return Motion(
        f"scribble {hertz:g} Hz", 3.5, lambda t: _along(amplitude * np.sin(turn * t)),
        lambda t: _along(amplitude * turn * np.cos(turn * t)), np.empty((0, 3)),
    )  # fmt: skip


def _along(metres: Array) -> Array:
    """[n, 3] along a line that lies across both axes."""
    return metres[:, None] * np.array([0.8, 0.0, 0.6])


def _reversal_speeds(mps: float, seconds: float) -> list[tuple[float, float]]:
    """Corners (time, speed): there and back every half second, each turn within the turn's time."""
    corners = [(0.0, mps)]
    sign = 1.0
    for middle in np.arange(0.25, seconds, 0.25):
        corners += [(middle - _TURN_SECONDS / 2, sign * mps), (middle + _TURN_SECONDS / 2, -sign * mps)]
        sign = -sign
    return [*corners, (seconds, sign * mps)]


def _polyline(kind: str, corners: list[tuple[float, float]]) -> Motion:
    """Speed linear between corners; place is its exact integral."""
    times, speeds = np.array(corners).T
    base = np.r_[0.0, np.cumsum(np.diff(times) * (speeds[1:] + speeds[:-1]) / 2)]

    def place(t: Array) -> Array:
        index = np.clip(np.searchsorted(times, t, side="right") - 1, 0, len(times) - 2)
        since = t - times[index]
        slope = (speeds[index + 1] - speeds[index]) / (times[index + 1] - times[index])
        return _along(base[index] + since * (speeds[index] + slope * since / 2))

    return Motion(kind, float(times[-1]), place, lambda t: _along(np.interp(t, times, speeds)), np.empty((0, 3)))


def _stops_and_starts(mps: float) -> Motion:
    moments = np.arange(0.43, 6.0, 0.43)
    moving = np.arange(len(moments) + 1) % 2
    starts = np.r_[0.0, moments]
    base = np.r_[0.0, np.cumsum(np.diff(starts) * moving[:-1] * mps)]

    def index(t: Array) -> NDArray[np.intp]:
        return np.searchsorted(moments, t, side="right")

    steps = np.c_[moments, mps * moving[:-1], mps * moving[1:]]
    return Motion(
        f"steps of {1000 * mps:g} mm/s", 6.0,
        lambda t: _along(base[index(t)] + (t - starts[index(t)]) * moving[index(t)] * mps),
        lambda t: _along(mps * moving[index(t)].astype(np.float64)), steps[steps[:, 0] > _WARM_UP_SECONDS],
    )  # fmt: skip


def _arc(mps: float) -> Motion:
    """Slow motion on a circle of 20 mm; rest at speed 0."""
    radius = 0.02
    turn = mps / radius

    def place(t: Array) -> Array:
        return radius * np.c_[np.cos(turn * t), np.zeros(len(t)), np.sin(turn * t)]

    def velocity(t: Array) -> Array:
        return mps * np.c_[-np.sin(turn * t), np.zeros(len(t)), np.cos(turn * t)]

    return Motion("rest" if mps == 0.0 else f"slow {1000 * mps:g} mm/s", 3.5, place, velocity, np.empty((0, 3)))
