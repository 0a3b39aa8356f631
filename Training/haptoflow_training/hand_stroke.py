"""Plamondon's sigma-lognormal model of rapid human movement.

A stroke is a vector sum of submovements. The speed of one submovement is D * lognormal(t; t0, mu, sigma), its
heading turns from a start to an end angle as the lognormal's cumulative function rises (an erf in log time).
Sources: R. Plamondon, "A kinematic theory of rapid human movements, Part I", Biological Cybernetics 72, 1995;
C. O'Reilly and R. Plamondon, "Development of a Sigma-Lognormal representation for on-line signatures",
Pattern Recognition 42, 2009.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d
from scipy.signal import butter, sosfiltfilt
from scipy.special import erf

# Log-time standard deviations after which a submovement counts as finished: 0.02 % of its distance is left.
END_DEVIATIONS = 3.5


@dataclass(frozen=True)
class Submovement:
    """One lognormal command: distance in metres, angles in radians, `start_seconds` is the model's t0.

    `mu` and `sigma` are the mean and the standard deviation of ln(t - t0), t in seconds.
    """

    start_seconds: float
    distance_metres: float
    mu: float
    sigma: float
    start_angle: float = 0.0
    end_angle: float = 0.0

    @classmethod
    def lasting(
        cls,
        start_seconds: float,
        duration_seconds: float,
        distance_metres: float,
        *,
        sigma: float = 0.3,
        start_angle: float = 0.0,
        end_angle: float = 0.0,
    ) -> Submovement:
        """The submovement that begins at `start_seconds` and has covered 99.98 % after `duration_seconds`."""
        if duration_seconds <= 0.0 or sigma <= 0.0:
            raise ValueError("a submovement needs a duration and a sigma above zero")
        mu = math.log(duration_seconds) - END_DEVIATIONS * sigma
        return cls(start_seconds, distance_metres, mu, sigma, start_angle, end_angle)

    def speed(self, time_seconds: NDArray[np.float64]) -> NDArray[np.float64]:
        """Tip speed in m/s at each time; zero up to t0."""
        elapsed = np.maximum(np.asarray(time_seconds, dtype=np.float64) - self.start_seconds, 1e-12)
        deviation = (np.log(elapsed) - self.mu) / self.sigma
        bell = np.exp(-0.5 * deviation**2) / (self.sigma * math.sqrt(2.0 * math.pi) * elapsed)
        return self.distance_metres * bell

    def progress(self, time_seconds: NDArray[np.float64]) -> NDArray[np.float64]:
        """Share of the distance covered, 0 at t0, tending to 1."""
        elapsed = np.maximum(np.asarray(time_seconds, dtype=np.float64) - self.start_seconds, 1e-12)
        return 0.5 * (1.0 + erf((np.log(elapsed) - self.mu) / (self.sigma * math.sqrt(2.0))))

    def velocity(self, time_seconds: NDArray[np.float64]) -> NDArray[np.float64]:
        """Planar velocity [n, 2] in m/s."""
        angle = self.start_angle + (self.end_angle - self.start_angle) * self.progress(time_seconds)
        return self.speed(time_seconds)[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)

    @property
    def end_seconds(self) -> float:
        return self.start_seconds + math.exp(self.mu + END_DEVIATIONS * self.sigma)


def summed_velocity(submovements: Sequence[Submovement], time_seconds: NDArray[np.float64]) -> NDArray[np.float64]:
    """Vector sum [n, 2] in m/s; `time_seconds` increases. The cost grows with the overlap, not with the stroke's
    length."""
    velocity = np.zeros((len(time_seconds), 2))
    for submovement in submovements:
        span = [submovement.start_seconds, submovement.end_seconds + 0.05]
        first, last = np.searchsorted(time_seconds, span)
        velocity[first:last] += submovement.velocity(time_seconds[first:last])
    return velocity


# The largest tip speed of a stroke: the 99th percentile of real pen strokes in VR is 1.4 m/s.
MAXIMUM_SPEED_MPS = 1.5
# Root mean square of physiological postural tremor of a supported hand, 8-12 Hz.
DEFAULT_TREMOR_METRES = 5e-5
_FORCE_RANGE_NEWTONS = (0.1, 5.0)
TREMOR_BAND_HZ = (8.0, 12.0)


@dataclass(frozen=True)
class PlanarStroke:
    """time_seconds [n] uniform from 0; position_metres [n, 2]; velocity_mps [n, 2], the position's
    derivative.
    """

    time_seconds: NDArray[np.float64]
    position_metres: NDArray[np.float64]
    velocity_mps: NDArray[np.float64]

    @property
    def speed_mps(self) -> NDArray[np.float64]:
        return np.hypot(self.velocity_mps[:, 0], self.velocity_mps[:, 1])


@dataclass(frozen=True)
class SpatialStroke:
    """time_seconds [n] uniform from 0; position_metres [n, 3]; force_newtons [n] or None."""

    time_seconds: NDArray[np.float64]
    position_metres: NDArray[np.float64]
    force_newtons: NDArray[np.float64] | None


def random_planar_stroke(
    rng: np.random.Generator, *, duration_seconds: float, rate_hz: float, median_speed_mps: float, extent_metres: float
) -> PlanarStroke:
    """Free scribbling: overlapping submovements with curves, reversals, pauses, slow and fast passages.

    The median speed of the moving samples (above 5 % of the requested median) is `median_speed_mps`; no sample is
    faster than MAXIMUM_SPEED_MPS. The tip starts in the middle of a square of side `extent_metres` and turns back near
    an edge, so that it leaves the square by about one submovement at most.
    """
    time = np.arange(int(round(duration_seconds * rate_hz))) / rate_hz
    submovements = _random_submovements(rng, duration_seconds, median_speed_mps, extent_metres)
    velocity = _with_median(summed_velocity(submovements, time), median_speed_mps)
    ramp = np.clip(np.minimum(time, time[-1] - time) / 0.08, 0.0, 1.0)
    velocity *= (0.5 - 0.5 * np.cos(math.pi * ramp))[:, None]
    step = velocity / rate_hz
    position = np.cumsum(step, axis=0) - step
    return PlanarStroke(time, position, velocity)


def _random_submovements(
    rng: np.random.Generator, duration_seconds: float, median_speed_mps: float, extent_metres: float
) -> list[Submovement]:
    clock, position, heading = 0.0, np.zeros(2), rng.uniform(-math.pi, math.pi)
    half = extent_metres / 2.0
    submovements: list[Submovement] = []
    while clock < duration_seconds:
        duration = float(np.clip(0.55 * math.exp(0.35 * rng.standard_normal()), 0.2, 1.4))
        distance = median_speed_mps * duration * 0.62 * math.exp(0.55 * rng.standard_normal())
        distance = min(distance, extent_metres)
        if rng.random() < 0.18:
            heading += math.pi + 0.3 * rng.standard_normal()
        else:
            heading += 0.45 * rng.standard_normal()
        ahead = position + distance * np.array([math.cos(heading), math.sin(heading)])
        if np.max(np.abs(ahead)) > half:
            goal = rng.uniform(-0.6, 0.6, size=2) * half
            heading = math.atan2(*(goal - position)[::-1])
        curve = 0.9 * rng.standard_normal()
        submovements.append(
            Submovement.lasting(
                clock,
                duration,
                distance,
                sigma=float(rng.uniform(0.22, 0.4)),
                start_angle=heading - curve / 2,
                end_angle=heading + curve / 2,
            )
        )
        position = position + distance * np.array([math.cos(heading), math.sin(heading)])
        heading += curve / 2
        clock += duration * float(rng.uniform(0.22, 0.5))
        if rng.random() < 0.03:
            clock += duration + float(rng.uniform(0.1, 0.5))
    return submovements


def _with_median(velocity: NDArray[np.float64], median_speed_mps: float) -> NDArray[np.float64]:
    """The stroke scaled to the median, with its peaks rounded off towards MAXIMUM_SPEED_MPS."""
    limited = velocity
    for _ in range(3):
        speed = np.hypot(limited[:, 0], limited[:, 1])
        moving = speed[speed > 0.05 * median_speed_mps]
        if moving.size:
            velocity = velocity * (median_speed_mps / float(np.median(moving)))
        speed = np.hypot(velocity[:, 0], velocity[:, 1])
        limited = velocity / ((1.0 + (speed / MAXIMUM_SPEED_MPS) ** 8) ** 0.125)[:, None]
    return limited


def force_profile(
    rng: np.random.Generator,
    *,
    duration_seconds: float,
    rate_hz: float,
    median_force_newtons: float,
    speed_mps: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Normal force [n] in newtons: slow wandering on a log scale, partly coupled to `speed_mps` [n].

    The coupling's sign and strength differ from stroke to stroke (some hands press harder when fast, others
    lift).
    """
    count = int(round(duration_seconds * rate_hz))
    knots = max(4, int(duration_seconds * 2.5) + 4)
    wander = np.interp(
        np.linspace(0.0, knots - 1.0, count), np.arange(knots), rng.standard_normal(knots)
    ) * float(rng.uniform(0.2, 0.6))
    scale = float(np.median(speed_mps)) + 1e-3
    wander = wander + float(rng.normal(0.05, 0.2)) * np.tanh(np.log((speed_mps + 0.1 * scale) / scale))
    sections = butter(2, min(4.0, 0.45 * rate_hz), fs=rate_hz, output="sos")
    smooth = sosfiltfilt(sections, wander, padlen=min(count - 1, int(rate_hz / 2)))
    smooth -= float(np.median(smooth))
    return np.clip(median_force_newtons * np.exp(smooth), *_FORCE_RANGE_NEWTONS)


def tremor(rng: np.random.Generator, count: int, rate_hz: float, rms_metres: float, axes: int) -> NDArray[np.float64]:
    """Physiological tremor [count, axes] in metres: noise between 8 and 12 Hz with the given root mean square."""
    margin = int(rate_hz)
    noise = rng.standard_normal((count + 2 * margin, axes))
    band = [min(edge, 0.45 * rate_hz) for edge in TREMOR_BAND_HZ]
    shaped = sosfiltfilt(butter(2, band, "bandpass", fs=rate_hz, output="sos"), noise, axis=0)
    return rms_metres * (shaped / np.std(shaped, axis=0))[margin : margin + count]


def scripted_stroke(
    waypoints_metres: Sequence[Sequence[float]],
    *,
    segment_seconds: float | Sequence[float],
    rate_hz: float = 120.0,
    seed: int = 0,
    tremor_metres: float = DEFAULT_TREMOR_METRES,
    force_newtons: Sequence[float] | None = None,
    smoothing_seconds: float = 0.0,
) -> SpatialStroke:
    """Sigma-lognormal movement through way-points [[x, y, z], ...], one submovement a leg.

    Legs overlap, so the tip rounds a way-point without stopping; a repeated way-point is a pause. `force_newtons` gives
    one force for each way-point, interpolated with the same progress. `smoothing_seconds` is the standard deviation of a
    Gaussian over the path, for way-points that only draw a curve: each leg is a movement of its own, whose start and
    stop would be felt. Deterministic by seed. ValueError if the
    way-points, times or rates cannot make a stroke.
    """
    points = np.asarray(waypoints_metres, dtype=np.float64)
    if points.ndim != 2 or points.shape[1] != 3 or len(points) < 2 or not np.all(np.isfinite(points)):
        raise ValueError("way-points must be two or more finite [x, y, z] triples in metres")
    legs = np.broadcast_to(np.asarray(segment_seconds, dtype=np.float64), (len(points) - 1,))
    if np.any(legs <= 0.0) or not np.all(np.isfinite(legs)) or not 30.0 <= rate_hz <= 10_000.0:
        raise ValueError("segment_seconds must be above zero and rate_hz between 30 and 10000")
    forces = None if force_newtons is None else np.asarray(force_newtons, dtype=np.float64)
    if forces is not None and (forces.shape != (len(points),) or np.any(forces < 0.0)):
        raise ValueError("force_newtons must give one force of zero or more for each way-point")

    rng = np.random.default_rng(seed)
    edges = np.concatenate([[0.0], np.cumsum(legs)])
    time = np.arange(int(math.floor(edges[-1] * rate_hz + 1e-9)) + 1) / rate_hz
    position = np.tile(points[0], (len(time), 1))
    force = None if forces is None else np.full(len(time), forces[0])
    for leg, (begin, end) in enumerate(zip(edges[:-1], edges[1:])):
        # A lognormal starts slowly: begin early and end late, so that neighbouring legs overlap while both move.
        start = max(0.0, begin - 0.5 * legs[leg])
        finish = min(edges[-1], end + 0.5 * legs[leg])
        movement = Submovement.lasting(start, finish - start, 1.0, sigma=float(rng.uniform(0.26, 0.34)))
        progress = movement.progress(time)
        position += progress[:, None] * (points[leg + 1] - points[leg])
        if force is not None and forces is not None:
            force += progress * (forces[leg + 1] - forces[leg])
    if smoothing_seconds > 0.0:
        position = gaussian_filter1d(position, smoothing_seconds * rate_hz, axis=0, mode="nearest")
    if tremor_metres > 0.0:
        position += tremor(rng, len(time), rate_hz, tremor_metres, 3)
    return SpatialStroke(time, position, force)
