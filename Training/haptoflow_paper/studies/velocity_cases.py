"""Strokes whose true velocity is known, as a tracker reports them: real ones resampled, and made ones."""

from __future__ import annotations

import zlib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from math import sqrt

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from haptoflow_benchmark.engine_render import on_table_spline

Array = NDArray[np.float64]
Estimator = Callable[[Array, Array, Array], Array]

# Places of the longest window.
_CAPACITY = 64
_NOISE_METRES = (5e-6, 50e-6, 500e-6)
_NOISE_QUANTILE = 0.35
# That quantile of the length of three standard normal numbers.
_QUANTILE_LENGTH = 1.2812
_NOISE_STEP = 0.1


def tracker_noise(times: Array, places: Array) -> Array:
    """[n] metres on each axis, as known at each time: a low quantile of third differences, followed by small steps."""
    least, level, most = _NOISE_METRES
    found = np.full(len(times), level)
    for newest in range(3, len(times)):
        t = times[newest - 3 : newest + 1]
        seconds = t[3] - t[0]
        weights = np.prod(seconds / (t[:, None] - t[None, :] + np.eye(4)), axis=1) / seconds
        difference = weights @ (places[newest - 3 : newest + 1] - places[newest])
        is_above = sqrt(difference @ difference) > _QUANTILE_LENGTH * level * sqrt(weights @ weights)
        level *= 1.0 + _NOISE_STEP * (_NOISE_QUANTILE if is_above else _NOISE_QUANTILE - 1.0)
        level = min(max(level, least), most)
        found[newest] = level
    return found


def line(seconds: float) -> Estimator:
    """The slope of a line over a fixed time, at least over three places (Wald 1940)."""

    def estimate(times: Array, places: Array, _noise: Array) -> Array:
        velocities = np.zeros_like(places)
        for newest in range(1, len(times)):
            ages = times[newest] - times[newest::-1]
            count = max(int(np.searchsorted(ages, seconds, side="right")), 2)
            if count == 2 and newest >= 2 and ages[2] <= 3.0 * seconds:
                count = 3
            half = count // 2
            new, old = slice(newest - half + 1, newest + 1), slice(newest - count + 1, newest - count + 1 + half)
            distance = places[new].sum(0) - places[old].sum(0)
            velocities[newest] = distance / (times[new].sum() - times[old].sum())
        return velocities

    return estimate


def end_of_parabola(seconds: float) -> Estimator:
    """The derivative at the end of a parabola over a fixed time, at least over four places."""
    return _windowed(lambda fit, noise: np.ones(len(noise), dtype=bool), order=2, least=4, seconds=seconds)


def adaptive_window(order: int, band: float, least: int) -> Estimator:
    """The end of a line (order 1) or parabola (2) over the longest window of which every place is within `band`
    deviations of noise (Janabi-Sharifi, Hayward, Chen 2000)."""
    return _windowed(lambda fit, noise: fit.farthest() <= band * noise, order=order, least=least)


def growing_parabola(cubic: float, cost_mps: float, shrink: float = 4.0) -> Estimator:
    """The end of a parabola over the longest window without a cubic beyond `cubic` deviations of noise, one more for
    each `cost_mps` of the velocity's own noise; `shrink` variances of the curvature are left out."""

    def agrees(fit: _Fit, noise: Array) -> NDArray[np.bool_]:
        share, norm = fit.cubic()
        deviations = cubic + noise * np.sqrt(fit.end_variance()) / cost_mps
        return share <= (deviations * noise) ** 2 * norm

    return _windowed(agrees, order=2, least=3, shrink=shrink)


def kalman(jerk: float) -> Estimator:
    """Kalman filter of place, velocity and acceleration; `jerk`, white, in m/s^3 per root of Hz."""

    def estimate(times: Array, places: Array, noise: Array) -> Array:
        velocities = np.zeros_like(places)
        state = np.zeros((3, 3))
        state[0] = places[0]
        covariance = np.diag([noise[0] ** 2, 1.0, 100.0])
        for newest in range(1, len(times)):
            t = times[newest] - times[newest - 1]
            step = np.array([[1.0, t, t * t / 2.0], [0.0, 1.0, t], [0.0, 0.0, 1.0]])
            fifth, fourth, third = t**5 / 20.0, t**4 / 8.0, t**3 / 3.0
            added = np.array([[fifth, fourth, third / 2.0], [fourth, third, t**2 / 2.0], [third / 2.0, t**2 / 2.0, t]])
            state = step @ state
            covariance = step @ covariance @ step.T + jerk**2 * added
            gain = covariance[:, 0] / (covariance[0, 0] + noise[newest] ** 2)
            state = state + np.outer(gain, places[newest] - state[0])
            covariance = covariance - np.outer(gain, covariance[0])
            velocities[newest] = state[1]
        return velocities

    return estimate


class _Fit:
    """Least squares over windows of m places, by polynomials that are orthogonal over their times. ages: [k, m], 0 or
    less, newest first; places: [k, m, 3]."""

    def __init__(self, ages: Array, places: Array, order: int) -> None:
        self._places = places
        self._linear = ages - ages.mean(1, keepdims=True)
        self._second = (self._linear**2).sum(1)
        self.slope = _projected(self._linear, places, self._second)
        self.curvature = np.zeros_like(self.slope)
        self._quadratic = np.zeros_like(self._linear)
        self._norm, self._lever = np.ones(len(ages)), np.zeros(len(ages))
        if order == 2 and ages.shape[1] >= 3:
            skew = (self._linear**3).sum(1) / self._second
            self._quadratic = self._linear * (self._linear - skew[:, None]) - self._second[:, None] / ages.shape[1]
            self._norm = (self._quadratic**2).sum(1)
            self.curvature = _projected(self._quadratic, places, self._norm)
            self._lever = 2.0 * self._linear[:, 0] - skew

    def end_velocity(self, noise: Array, shrink: float) -> Array:
        explained = (self.curvature**2).sum(1) * self._norm
        share = np.clip(1.0 - shrink * noise**2 / np.maximum(explained, 1e-300), 0.0, 1.0)
        return self.slope + (share * self._lever)[:, None] * self.curvature

    def end_variance(self) -> Array:
        """Of the velocity at the end, for noise of 1."""
        return 1.0 / self._second + self._lever**2 / self._norm

    def farthest(self) -> Array:
        fitted = self._linear[..., None] * self.slope[:, None] + self._quadratic[..., None] * self.curvature[:, None]
        misses = self._places - self._places.mean(1, keepdims=True) - fitted
        return np.sqrt((misses**2).sum(2)).max(1)

    def cubic(self) -> tuple[Array, Array]:
        """Squared length of what a cubic would explain, and the polynomial's squared norm."""
        cube = self._linear**3
        polynomial = (
            cube
            - ((cube * self._quadratic).sum(1) / self._norm)[:, None] * self._quadratic
            - ((self._linear**4).sum(1) / self._second)[:, None] * self._linear
            - cube.mean(1, keepdims=True)
        )
        explained = np.einsum("km,kmd->kd", polynomial, self._places)
        return (explained**2).sum(1), (polynomial**2).sum(1)


def _projected(polynomial: Array, places: Array, norm: Array) -> Array:
    result: Array = np.einsum("km,kmd->kd", polynomial, places) / norm[:, None]
    return result


def _windowed(
    agrees: Callable[[_Fit, Array], NDArray[np.bool_]],
    *, order: int, least: int, seconds: float = 0.105, shrink: float = 0.0,
) -> Estimator:  # fmt: skip
    """Windows grow from two places on by an eighth, all times at once, until one disagrees or is longer than the
    seconds; those of up to `least` places always agree."""

    def estimate(times: Array, places: Array, noise: Array) -> Array:
        back = np.maximum(np.arange(len(times))[:, None] - np.arange(_CAPACITY), 0)
        ages, recent = times[back] - times[:, None], places[back] - places[:, None]
        velocities = np.zeros_like(places)
        rows = np.arange(1, len(times))
        count = 2
        while count <= _CAPACITY:
            is_young = (ages[rows, count - 1] >= -seconds) | (count <= least)
            rows = rows[(rows >= count - 1) & is_young]
            if len(rows) == 0:
                break
            fit = _Fit(ages[rows, :count], recent[rows, :count], order)
            if count > least:
                good = agrees(fit, noise[rows])
            else:
                good = np.ones(len(rows), dtype=bool)
            velocities[rows[good]] = fit.end_velocity(noise[rows], shrink)[good]
            rows = rows[good]
            count += max(1, count // 8)
        return velocities

    return estimate


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
