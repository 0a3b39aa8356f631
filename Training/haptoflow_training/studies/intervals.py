"""Intervals and standard errors: over participants, whose own answers are correlated, and of shares of studies.

scipy.stats.bootstrap has percentile, basic and BCa intervals, but not the expanded percentile interval used here.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.stats import binomtest, norm, t

CONFIDENCE = 0.95


@dataclass(frozen=True)
class Interval:
    low: float
    high: float

    def covers(self, value: float) -> bool:
        return self.low <= value <= self.high


def participant_weights(participants: int, resamples: int, seed: int) -> np.ndarray:
    """How often each participant (column) is drawn in each resample (row), with replacement."""
    random = np.random.default_rng(seed)
    return random.multinomial(participants, np.full(participants, 1.0 / participants), resamples).astype(float)


def expanded_interval(values: np.ndarray, participants: int) -> Interval:
    """Expanded percentile interval of resampled values, 95 %; nan values are left out.

    Hesterberg (2015), What teachers should know about the bootstrap: percentiles of a resampled statistic are too
    narrow by sqrt((n - 1) / n) and use normal instead of Student's t tails; the levels are moved outwards for both.
    """
    percentile_levels = expanded_levels(participants)
    low, high = np.quantile(values[~np.isnan(values)], percentile_levels)
    return Interval(float(low), float(high))


def expanded_levels(participants: int) -> tuple[float, float]:
    """The two levels of the expanded interval, in place of 0.025 and 0.975."""
    outer = np.sqrt(participants / (participants - 1)) * t.ppf(0.5 + CONFIDENCE / 2.0, participants - 1)
    return float(norm.cdf(-outer)), float(norm.cdf(outer))


def jackknife_error(without_one: np.ndarray) -> float | None:
    """Standard error from a statistic's values with each participant left out in turn; None if one has no value.

    Unlike the resamples' standard deviation, it is not dominated by a few resamples whose curve is almost flat.
    """
    if np.isnan(without_one).any():
        return None
    count = len(without_one)
    return float(np.sqrt((count - 1) / count * np.sum((without_one - without_one.mean()) ** 2)))


@dataclass(frozen=True)
class Share(Interval):
    """low, high: Wilson's interval of 95 % for the underlying rate."""

    count: int
    of: int

    @property
    def rate(self) -> float:
        return self.count / self.of

    def __str__(self) -> str:
        return f"{100 * self.rate:.1f} % ({100 * self.low:.1f}-{100 * self.high:.1f})"


def share(count: int, of: int) -> Share:
    """The share of `count` among `of` studies; of: at least 1."""
    interval = binomtest(count, of).proportion_ci(0.95, method="wilson")
    return Share(float(interval.low), float(interval.high), count, of)
