"""Tests and effect sizes for paired ratings (rows are participants, columns methods): SciPy's tests, adapted to ties.

Ratings from 1 to 7 tie often, and two methods often get the same rating. Therefore Wilcoxon's signed-rank test is
applied as follows:

- Differences of zero take part in the ranking and are then left out (zero_method "pratt"). Without them ("wilcox") a
  few differences among many equal ratings would look unanimous.
- The p-value comes from the normal approximation, whose variance SciPy corrects for ties, without continuity
  correction: SciPy's exact distribution assumes ranks without ties.
- With up to 12 non-zero differences, where the approximation is coarse, every pattern of signs is counted instead
  (scipy.stats.permutation_test).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from itertools import combinations
from math import comb

import numpy as np
from scipy import stats

@cache
def possible_true_counts(methods: int) -> frozenset[int]:
    """The possible numbers of the k (k - 1) / 2 hypotheses of equality that are true at once.

    A group of j equal methods makes j (j - 1) / 2 hypotheses true; the remaining methods divide in the same way.
    """
    if methods < 2:
        return frozenset({0})
    return frozenset(
        comb(group, 2) + rest for group in range(1, methods + 1) for rest in possible_true_counts(methods - group)
    )


def factors(methods: int) -> list[int]:
    """The factors of the smallest p-value, the next one, and so on: the largest number that can be true at that
    step."""
    pairs = comb(methods, 2)
    counts = possible_true_counts(methods)
    return [max(count for count in counts if count <= pairs - rejected) for rejected in range(pairs)]


def adjusted(p_values: Sequence[float], factors_by_rank: Sequence[int]) -> list[float]:
    """The p-values, in the given order, times the factor of their rank; at most 1, and monotonic in the p-values."""
    order = np.argsort(p_values, kind="stable")
    result = np.empty(len(p_values))
    result[order] = np.maximum.accumulate(np.minimum(1.0, np.asarray(factors_by_rank) * np.asarray(p_values)[order]))
    return [float(p) for p in result]


SIGNIFICANCE = 0.05
TREND = 0.1
# The smallest difference that people call one, on scales of seven points: half a point (Jaeschke, Singer and Guyatt
# 1989, Measurement of health status: ascertaining the minimal clinically important difference, Controlled Clinical
# Trials 10, 407-415). Used where the settings of a study name no bound of its own.
EQUIVALENCE_POINTS = 0.5
_MAXIMUM_COUNTED_SIGNS = 12
# Rounding restores ties that a shift by an equivalence bound breaks in the last bits.
_DECIMALS = 9


@dataclass(frozen=True)
class Friedman:
    """chi_square has k - 1 degrees of freedom, corrected for ties. kendall_w: 0 no agreement on the order, 1 full."""

    chi_square: float
    p: float
    kendall_w: float


@dataclass(frozen=True)
class Pair:
    """`first` less `second`, by column.

    p: of Wilcoxon's test, two-sided; p_shaffer: adjusted, None if Friedman's test was not significant. rank_biserial:
    the share of the ranks that favours `first` less that for `second`, -1 to 1. cohen_dz: the mean difference in
    standard deviations of the differences. None if the differences are all zero, or have no spread. bound: in points of
    rating; p_equivalence: the larger of the two one-sided tests' p-values; p_holm: corrected for the number of pairs.
    """

    first: int
    second: int
    mean_difference: float
    p: float | None
    p_shaffer: float | None
    rank_biserial: float | None
    cohen_dz: float | None
    bound: float
    p_equivalence: float
    p_holm: float

    @property
    def differs(self) -> bool:
        return _is_significant(self.p_shaffer)

    @property
    def differs_alone(self) -> bool:
        return _is_significant(self.p)


@dataclass(frozen=True)
class RatingResult:
    """The tests of one material. friedman is None for two methods, whose pair is tested directly, and for ratings
    all equal."""

    normality_p: tuple[float | None, ...]
    friedman: Friedman | None
    friedman_statement: str
    pairs: tuple[Pair, ...]

    @property
    def differs(self) -> bool:
        """Whether Friedman's test found a difference."""
        return self.friedman is not None and _is_significant(self.friedman.p)


def _is_significant(p: float | None) -> bool:
    return p is not None and p < SIGNIFICANCE


def signed_rank_p(differences: np.ndarray, alternative: str = "two-sided") -> float | None:
    """The p-value of Wilcoxon's signed-rank test; None if every difference is zero."""
    rounded = np.round(np.asarray(differences, dtype=float), _DECIMALS)
    nonzero = int(np.count_nonzero(rounded))
    if nonzero == 0:
        return None
    if nonzero <= _MAXIMUM_COUNTED_SIGNS:
        return _counted_p(rounded, alternative)
    result = stats.wilcoxon(rounded, zero_method="pratt", correction=False, alternative=alternative, method="approx")
    return float(result.pvalue)


def _counted_p(differences: np.ndarray, alternative: str) -> float:
    ranks = stats.rankdata(np.abs(differences))[differences != 0.0]
    signed = ranks * np.sign(differences[differences != 0.0])
    if len(signed) == 1:
        # SciPy requires two observations; a rank of zero changes no sum.
        signed = np.append(signed, 0.0)
    # Rounded, because equal sums of half ranks may differ in their last bits.
    test = stats.permutation_test(
        (signed,),
        lambda values, axis: np.round(np.sum(values, axis=axis), _DECIMALS),
        permutation_type="samples",
        vectorized=True,
        n_resamples=np.inf,
        alternative=alternative,
    )
    return float(min(1.0, test.pvalue))


def equivalence(differences: np.ndarray, bound: float) -> float:
    """The larger p-value of two one-sided Wilcoxon tests against differences of `bound` points of rating.

    Schuirmann (1987), A comparison of the two one-sided tests procedure and the power approach, J. Pharmacokinetics and
    Biopharmaceutics 15, 657-680. The bound is chosen before the ratings are known: one that is estimated from them
    grows with their scatter, so that careless ratings would look equal.
    """
    above = signed_rank_p(differences + bound, "greater")
    below = signed_rank_p(differences - bound, "less")
    # Differences that all lie at a bound are no evidence against it.
    return max(1.0 if p is None else p for p in (above, below))


def holm(p_values: Sequence[float]) -> list[float]:
    """Adjusted p-values in the given order (Holm 1979, A simple sequentially rejective multiple test procedure, Scand.
    J. Statistics 6, 65-70): valid however the tests depend on each other.

    Shaffer's smaller factors are for hypotheses of equality, of which one implies others; two pairs that are equivalent
    do not make the third one so.
    """
    return adjusted(p_values, range(len(p_values), 0, -1))


def rank_biserial(differences: np.ndarray) -> float | None:
    """Kerby (2014), The simple difference formula, on Pratt's ranks; None if every difference is zero."""
    rounded = np.round(differences, _DECIMALS)
    ranks = stats.rankdata(np.abs(rounded))
    favourable, unfavourable = float(ranks[rounded > 0.0].sum()), float(ranks[rounded < 0.0].sum())
    total = favourable + unfavourable
    return (favourable - unfavourable) / total if total > 0.0 else None


def cohen_dz(differences: np.ndarray) -> float | None:
    """Mean difference in standard deviations of the differences; None if they do not vary."""
    spread = float(np.std(differences, ddof=1)) if len(differences) > 1 else 0.0
    return float(np.mean(differences)) / spread if spread > 0.0 else None


def normality_p(ratings: np.ndarray) -> float | None:
    """Of Shapiro and Wilk's test; None for ratings that are all equal or fewer than three."""
    return None if len(ratings) < 3 or np.ptp(ratings) == 0.0 else float(stats.shapiro(ratings).pvalue)


def friedman(ratings: np.ndarray) -> Friedman | None:
    """Friedman's test of three methods or more; None if every participant rated all methods alike."""
    participants, methods = ratings.shape
    if np.all(np.ptp(ratings, axis=1) == 0.0):
        return None
    result = stats.friedmanchisquare(*ratings.T)
    chi_square = float(result.statistic)
    return Friedman(chi_square, float(result.pvalue), chi_square / (participants * (methods - 1)))


def analysed(ratings: np.ndarray, bound: float = EQUIVALENCE_POINTS) -> RatingResult:
    """All tests of one material. ratings: participants by methods, at least two methods, without gaps. bound: of
    equivalence, in points of rating."""
    methods = ratings.shape[1]
    found = friedman(ratings) if methods > 2 else None
    statement = ""
    if methods == 2:
        statement = "two methods: their one pair is tested directly"
    elif found is None:
        statement = "every participant rated all methods alike"
    elif found.p >= SIGNIFICANCE:
        statement = "the methods' ratings do not differ significantly, so that no pair is tested for a difference"
    names = list(combinations(range(methods), 2))
    differences = [ratings[:, first] - ratings[:, second] for first, second in names]
    raw = [signed_rank_p(each) for each in differences]
    shaffer: Sequence[float | None] = [None] * len(names)
    if methods == 2 or not statement:
        # Pairs without any difference count as p = 1 in the correction, and get no p-value.
        corrected = adjusted([1.0 if p is None else p for p in raw], factors(methods))
        shaffer = [None if p is None else value for p, value in zip(raw, corrected, strict=True)]
    equivalent = [equivalence(each, bound) for each in differences]
    pairs = (
        Pair(
            *pair,
            mean_difference=float(each.mean()),
            p=p,
            p_shaffer=p_shaffer,
            rank_biserial=rank_biserial(each),
            cohen_dz=cohen_dz(each),
            bound=bound,
            p_equivalence=p_equivalence,
            p_holm=p_holm,
        )
        for pair, each, p, p_shaffer, p_equivalence, p_holm in zip(
            names, differences, raw, shaffer, equivalent, holm(equivalent), strict=True
        )
    )
    return RatingResult(tuple(normality_p(column) for column in ratings.T), found, statement, tuple(pairs))
