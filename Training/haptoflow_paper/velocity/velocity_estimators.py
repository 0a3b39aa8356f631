"""Estimators of velocity from places at uneven times. Each sees the past only and gives the velocity at the newest
place.

Arguments of all: times [n] in s, places [n, 3] in m, noise [n] in m on each axis as it was known at each time. Result:
[n, 3] in m/s.
"""

from __future__ import annotations

from collections.abc import Callable
from math import sqrt

import numpy as np
from numpy.typing import NDArray

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
