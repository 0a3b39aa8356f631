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


def summed_velocity(
    submovements: Sequence[Submovement], time_seconds: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Vector sum [n, 2] in m/s; `time_seconds` increases. The cost grows with the overlap, not with the stroke's
    length."""
    velocity = np.zeros((len(time_seconds), 2))
    for submovement in submovements:
        span = [submovement.start_seconds, submovement.end_seconds + 0.05]
        first, last = np.searchsorted(time_seconds, span)
        velocity[first:last] += submovement.velocity(time_seconds[first:last])
    return velocity
