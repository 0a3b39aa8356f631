"""Fits the psychometric function y = 100 / (1 + exp(-k (x - x0))) by maximum likelihood to single yes or no answers.

The likelihood is that of a logistic regression of the answer on the delay, with slope k and intercept -k x0; each
answer counts alike. Least squares through the percentages would treat a level at 2 % as if it were as uncertain as one
at 50 %. (All resamples are fitted at once by Newton's method; SciPy would fit them one by one.)
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import special
from scipy.stats import binomtest, norm, t

CONFIDENCE = 0.95


@dataclass(frozen=True)
class Interval:
    low: float
    high: float

    def covers(self, value: float) -> bool:
        return self.low <= value <= self.high


def expanded_interval(values: np.ndarray, participants: int) -> Interval:
    """Expanded percentile interval of resampled values, 95 %; nan values are left out.

    Hesterberg (2015), What teachers should know about the bootstrap: percentiles of a resampled statistic are too
    narrow by sqrt((n - 1) / n) and use normal instead of Student's t tails; the levels are moved outwards for both.
    """
    outer = np.sqrt(participants / (participants - 1)) * t.ppf(0.5 + CONFIDENCE / 2.0, participants - 1)
    low, high = np.quantile(values[~np.isnan(values)], norm.cdf([-outer, outer]))
    return Interval(float(low), float(high))


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


RESAMPLES = 2000
MINIMUM_PARTICIPANTS = 5
# With a larger share of resamples without a curve, an interval over the others would be biased.
_MAXIMUM_SHARE_WITHOUT_CURVE = 0.05
_NEWTON_STEPS = 60


@dataclass(frozen=True)
class Answers:
    """The answers under one condition, one entry an answer. delay_ms: as delivered; yes: 0 or 1; participant: a
    number from 0."""

    delay_ms: np.ndarray
    yes: np.ndarray
    participant: np.ndarray

    @property
    def participants(self) -> int:
        return int(self.participant.max()) + 1 if len(self.participant) else 0


@dataclass(frozen=True)
class Curve:
    """k in 1/ms; x0, the 50 % threshold, in ms."""

    k: float
    x0: float

    def percent(self, delay_ms: np.ndarray | float) -> np.ndarray:
        return np.asarray(100.0 * special.expit(self.k * (np.asarray(delay_ms) - self.x0)))


@dataclass(frozen=True)
class Fit:
    """The fit of one condition's answers.

    curve: None if there is none, with the reason in `statement`. The intervals (95 %) and standard errors are over
    participants; None if there are none, with the reason in `interval_statement`. resampled_x0 has one value a
    resample, nan if a resample has no curve.
    """

    curve: Curve | None
    statement: str = ""
    threshold_interval: Interval | None = None
    k_interval: Interval | None = None
    threshold_error: float | None = None
    k_error: float | None = None
    interval_statement: str = ""
    notes: tuple[str, ...] = ()
    resampled_x0: np.ndarray | None = None


@dataclass(frozen=True)
class _Counts:
    """Trials and yes answers of each participant (row) at each occurring delay (column)."""

    delays_ms: np.ndarray
    trials: np.ndarray
    yes: np.ndarray


def degenerate_statement(answers: Answers) -> str:
    """The reason why no curve can be fitted; empty if one can."""
    delay, yes = answers.delay_ms, answers.yes.astype(bool)
    if len(delay) == 0:
        return "there is no answer"
    if yes.all():
        return f"every answer is yes: the threshold lies below {delay.min():g} ms, the shortest delay"
    if not yes.any():
        return f"every answer is no: the threshold lies above {delay.max():g} ms, the longest delay"
    if np.ptp(delay) == 0.0:
        return f"every trial had the same delay, {delay[0]:g} ms: a curve needs several"
    longest_no, shortest_yes = delay[~yes].max(), delay[yes].min()
    if longest_no <= shortest_yes:
        steps = longest_no < shortest_yes
        where = f"between {longest_no:g} and {shortest_yes:g} ms" if steps else f"at {longest_no:g} ms"
        return (
            f"the answers step from no to yes without overlap: the threshold lies {where}, and the slope k has no "
            "maximum-likelihood value"
        )
    if delay[yes].max() <= delay[~yes].min():
        return "the answers step from yes to no as the delay grows: they do not detect delay"
    return ""


def fit_curve(answers: Answers) -> Curve | None:
    """None for degenerate answers, and if yes does not become more frequent with the delay."""
    if degenerate_statement(answers):
        return None
    k, x0 = _curves(_counted(answers), np.ones((1, answers.participants)))
    return None if np.isnan(k[0]) else Curve(float(k[0]), float(x0[0]))


def fit(answers: Answers, *, resamples: int = RESAMPLES, seed: int = 0) -> Fit:
    """Curve, intervals and standard errors. The same seed draws the same participants for every condition."""
    statement = degenerate_statement(answers)
    curve = fit_curve(answers)
    if curve is None:
        return Fit(None, statement or "yes does not become more frequent as the delay grows: there is no threshold")
    notes = _range_notes(answers, curve)
    count = answers.participants
    if count < MINIMUM_PARTICIPANTS:
        words = f"{count} participants are too few to resample, which takes {MINIMUM_PARTICIPANTS}"
        return Fit(curve, interval_statement=words, notes=notes)
    counted = _counted(answers)
    # How often each participant (column) is drawn in each resample (row), with replacement.
    drawn = np.random.default_rng(seed).multinomial(count, np.full(count, 1.0 / count), resamples)
    k, x0 = _curves(counted, drawn.astype(float))
    without = float(np.isnan(k).mean())
    if without > _MAXIMUM_SHARE_WITHOUT_CURVE:
        words = f"{100 * without:.0f} % of the resamples have no curve, because yes and no hardly overlap"
        return Fit(curve, interval_statement=words, notes=notes)
    threshold_interval = expanded_interval(x0, count)
    lowest, highest, span = answers.delay_ms.min(), answers.delay_ms.max(), np.ptp(answers.delay_ms)
    if threshold_interval.low < lowest - span or threshold_interval.high > highest + span:
        words = "in some resamples yes hardly depends on the delay, so that their thresholds lie anywhere"
        return Fit(curve, interval_statement=words, notes=notes)
    if without > 0.0:
        notes += (f"{100 * without:.2g} % of the resamples have no curve and were left out of the intervals",)
    k_without_one, x0_without_one = _curves(counted, 1.0 - np.eye(count))
    return Fit(
        curve,
        threshold_interval=threshold_interval,
        k_interval=expanded_interval(k, count),
        threshold_error=jackknife_error(x0_without_one),
        k_error=jackknife_error(k_without_one),
        notes=notes,
        resampled_x0=x0,
    )


def threshold_difference(first: Fit, second: Fit, participants: int) -> Interval | None:
    """Interval of the first threshold less the second, both fitted with one seed to the same participants' answers."""
    if first.resampled_x0 is None or second.resampled_x0 is None:
        return None
    return expanded_interval(first.resampled_x0 - second.resampled_x0, participants)


def _range_notes(answers: Answers, curve: Curve) -> tuple[str, ...]:
    low, high = answers.delay_ms.min(), answers.delay_ms.max()
    if low <= curve.x0 <= high:
        return ()
    return (f"the threshold lies outside the tested delays of {low:g} to {high:g} ms: it is extrapolated",)


def _counted(answers: Answers) -> _Counts:
    delays, place = np.unique(answers.delay_ms, return_inverse=True)
    trials = np.zeros((answers.participants, len(delays)))
    yes = np.zeros_like(trials)
    np.add.at(trials, (answers.participant, place), 1.0)
    np.add.at(yes, (answers.participant, place), answers.yes.astype(float))
    return _Counts(delays, trials, yes)


def _curves(counted: _Counts, weights: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """k and x0 for each row of weights over the participants; nan without overlap of yes and no, or with k <= 0.

    Newton's method on the concave log-likelihood, all rows at once. Steps are limited to 2 in units of the delays'
    standard deviation, because a whole step from a flat start can leave the region of convergence.
    """
    delays = counted.delays_ms
    centre, scale = delays.mean(), delays.std()
    standardised = (delays - centre) / scale
    trials, yes = weights @ counted.trials, weights @ counted.yes
    longest_no = np.where(trials - yes > 0.0, delays, -np.inf).max(axis=1)
    shortest_yes = np.where(yes > 0.0, delays, np.inf).min(axis=1)
    longest_yes = np.where(yes > 0.0, delays, -np.inf).max(axis=1)
    shortest_no = np.where(trials - yes > 0.0, delays, np.inf).min(axis=1)
    overlaps = (longest_no > shortest_yes) & (longest_yes > shortest_no)
    intercept, slope = np.zeros(len(weights)), np.zeros(len(weights))
    solved = np.flatnonzero(overlaps)
    trials, yes = trials[solved], yes[solved]
    for _ in range(_NEWTON_STEPS):
        if len(solved) == 0:
            break
        expected = special.expit(intercept[solved, None] + slope[solved, None] * standardised)
        residual = yes - trials * expected
        spread = trials * expected * (1.0 - expected)
        gradient = residual.sum(axis=1), residual @ standardised
        curvature = spread.sum(axis=1), spread @ standardised, spread @ standardised**2
        determinant = curvature[0] * curvature[2] - curvature[1] ** 2
        steps = np.stack(
            [
                (curvature[2] * gradient[0] - curvature[1] * gradient[1]) / determinant,
                (curvature[0] * gradient[1] - curvature[1] * gradient[0]) / determinant,
            ]
        )
        steps /= np.maximum(1.0, np.abs(steps).max(axis=0) / 2.0)
        intercept[solved] += steps[0]
        slope[solved] += steps[1]
        if np.abs(steps).max() < 1e-10:
            break
    rises = overlaps & (slope > 0.0)
    divisor = np.where(rises, slope, 1.0)
    return np.where(rises, slope / scale, np.nan), np.where(rises, centre - intercept * scale / divisor, np.nan)
