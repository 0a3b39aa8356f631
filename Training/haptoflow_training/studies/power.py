"""The power of a planned sample: the whole analysis, run on many simulated studies."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from scipy import stats

from haptoflow_training.studies.psychometric import Answers, Share, fit, share, threshold_difference
from haptoflow_training.studies.plans import CONDITIONS
from haptoflow_training.studies.rating_tests import EQUIVALENCE_POINTS, SIGNIFICANCE, RatingResult, analysed
from haptoflow_training.studies.simulation import LEVELS_MS, AnswerModel, RatingModel

_RESAMPLES = 1000
# Asymptotic relative efficiency of a signed-rank test of each participant's difference, against a t test, for normal
# data.
_SIGNED_RANK_EFFICIENCY = 3.0 / math.pi


def planned_signed_rank_power(participants: int, difference_dz: float) -> float:
    """Of one two-sided Wilcoxon test at 0.05, from normal differences: the t test's noncentral t with n reduced by the
    asymptotic relative efficiency 3/pi, which is G*Power's "A.R.E." method with a normal parent.
    """
    reduced = participants * _SIGNED_RANK_EFFICIENCY
    noncentrality = difference_dz * math.sqrt(reduced)
    critical = stats.t.ppf(1.0 - SIGNIFICANCE / 2.0, reduced - 1.0)
    upper = stats.nct.sf(critical, reduced - 1.0, noncentrality)
    return float(upper + stats.nct.cdf(-critical, reduced - 1.0, noncentrality))


@dataclass(frozen=True)
class RatingPower:
    """Shares of simulated studies of one material in which the last method is rated lower than all others.

    friedman: a difference was found at all; pair: that of the first and the last method, after correction; pair_alone:
    the same without Friedman's test and correction; false_pair: a difference between methods that are alike;
    equivalence: of the first two methods, which are alike, after correction (None for two methods).
    """

    friedman: Share
    pair: Share
    pair_alone: Share
    false_pair: Share
    equivalence: Share | None


def rating_power(
    participants: int,
    methods: int,
    difference_dz: float,
    *,
    simulations: int,
    seed: int,
    bound: float = EQUIVALENCE_POINTS,
    advance: Callable[[], object] = int,
) -> RatingPower:
    """participants: at least 3; methods: at least 2; bound: of equivalence, in points of rating."""
    names = [f"method {place}" for place in range(1, methods + 1)]
    model = RatingModel(["material"], names, {("material", names[-1]): difference_dz})
    random = np.random.default_rng(seed)
    counts: Counter[str] = Counter()
    for _ in range(simulations):
        counts.update(findings(analysed(model.ratings(random, participants)[0], bound), methods - 1))
        advance()
    shares = {key: share(counts[key], simulations) for key in ("friedman", "pair", "alone", "false", "equivalence")}
    equivalence = shares["equivalence"] if methods > 2 else None
    return RatingPower(shares["friedman"], shares["pair"], shares["alone"], shares["false"], equivalence)


def findings(result: RatingResult, lowered: int) -> list[str]:
    """The shares to which a study contributes; lowered: column of the method that is rated lower."""
    pairs = {(pair.first, pair.second): pair for pair in result.pairs}
    planted = pairs[0, lowered]
    found = {
        "friedman": result.differs,
        "pair": planted.differs,
        "alone": planted.differs_alone,
        "false": any(pair.differs for pair in result.pairs if pair.second != lowered),
        "equivalence": lowered > 1 and pairs[0, 1].p_holm < SIGNIFICANCE,
    }
    return [key for key, is_found in found.items() if is_found]


@dataclass(frozen=True)
class LatencyPower:
    """widths_ms: median width of the thresholds' intervals by condition; covered: how often they contained the true
    threshold.

    differ: the interval of the thresholds' difference excludes 0. without_interval: studies without one.
    """

    widths_ms: Mapping[str, float]
    covered: Mapping[str, Share]
    differ: Share
    without_interval: int


def latency_power(
    participants: int, *, simulations: int, seed: int, advance: Callable[[], object] = int
) -> LatencyPower:
    """participants: at least 5, because fewer give no interval."""
    model = AnswerModel()
    random = np.random.default_rng(seed)
    widths: dict[str, list[float]] = {condition: [] for condition in CONDITIONS}
    covered: Counter[str] = Counter()
    differ = without = 0
    for place in range(simulations):
        answers = latency_answers(model, random, participants)
        fits = {condition: fit(answers[condition], resamples=_RESAMPLES, seed=place) for condition in CONDITIONS}
        difference = threshold_difference(*(fits[condition] for condition in CONDITIONS), participants)
        advance()
        if difference is None:
            without += 1
            continue
        differ += not difference.covers(0.0)
        for condition in CONDITIONS:
            interval = fits[condition].threshold_interval
            if interval is not None:
                widths[condition].append(interval.high - interval.low)
                covered[condition] += interval.covers(model.curves[condition].x0)
    complete = max(1, simulations - without)
    return LatencyPower(
        {condition: float(np.median(widths[condition])) if widths[condition] else math.nan for condition in CONDITIONS},
        {condition: share(covered[condition], complete) for condition in CONDITIONS},
        share(differ, simulations),
        without,
    )


def latency_answers(model: AnswerModel, random: np.random.Generator, participants: int) -> dict[str, Answers]:
    """The answers of one simulated study at the paper's levels, by condition."""
    delays = np.tile(np.array(LEVELS_MS), (participants, 1))
    own = random.standard_normal((participants, 1))
    who = np.repeat(np.arange(participants), len(LEVELS_MS))
    return {
        condition: Answers(delays.ravel(), model.answers(random, condition, delays, own).ravel().astype(int), who)
        for condition in CONDITIONS
    }
