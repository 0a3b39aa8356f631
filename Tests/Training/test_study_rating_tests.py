"""Tests and effect sizes of ratings with ties, with zeros and without differences."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from scipy import stats

from haptoflow_training.studies.rating_tests import (
    analysed,
    cohen_dz,
    equivalence,
    friedman,
    holm,
    rank_biserial,
    signed_rank_p,
)


def ratings_of(seed: int, participants: int, means: list[float], spread: float = 1.2) -> np.ndarray:
    random = np.random.default_rng(seed)
    drawn = np.array(means) + random.normal(0.0, spread, (participants, len(means)))
    return np.clip(np.round(drawn), 1, 7)


def every_sign_p(differences: np.ndarray, alternative: str) -> float:
    """By listing every pattern of signs on Pratt's ranks."""
    ranks = stats.rankdata(np.abs(differences))[differences != 0]
    seen = float(ranks[differences[differences != 0] > 0].sum())
    sums = np.array([np.dot(signs, ranks) for signs in product((0, 1), repeat=len(ranks))])
    greater, less = np.mean(sums >= seen - 1e-9), np.mean(sums <= seen + 1e-9)
    return float({"greater": greater, "less": less, "two-sided": min(1.0, 2 * min(greater, less))}[alternative])


@pytest.mark.parametrize("alternative", ["two-sided", "greater", "less"])
def test_few_differences_are_tested_by_counting_every_pattern_of_signs(alternative: str) -> None:
    differences = np.array([1.0, 2.0, 0.0, -1.0, 1.0, 3.0, 0.0, 2.0, -2.0])
    assert signed_rank_p(differences, alternative) == pytest.approx(every_sign_p(differences, alternative))


def test_the_approximation_is_near_the_counted_value_where_it_takes_over() -> None:
    random = np.random.default_rng(3)
    compared = 0
    for _ in range(40):
        differences = np.round(random.normal(0.7, 1.5, 16))
        counted = every_sign_p(differences, "two-sided")
        if np.count_nonzero(differences) > 12 and counted < 0.1:
            assert signed_rank_p(differences) == pytest.approx(counted, abs=0.05)
            compared += 1
    assert compared >= 8


def test_differences_that_are_all_zero_have_no_p_value_and_no_effect() -> None:
    nothing = np.zeros(24)
    assert signed_rank_p(nothing) is None and rank_biserial(nothing) is None and cohen_dz(nothing) is None


def test_the_effect_sizes_are_those_of_their_definitions() -> None:
    differences = np.array([2.0, 1.0, -1.0, 3.0])
    assert rank_biserial(differences) == pytest.approx((3 + 1.5 + 4 - 1.5) / 10)
    assert cohen_dz(differences) == pytest.approx(1.25 / np.std(differences, ddof=1))
    assert rank_biserial(np.array([1.0, 2.0])) == 1.0 and rank_biserial(np.array([-1.0])) == -1.0
    assert cohen_dz(np.array([1.0, 1.0])) is None and cohen_dz(np.array([1.0])) is None


def test_kendalls_w_is_one_for_full_agreement_and_follows_from_friedmans_chi_square() -> None:
    agreed = friedman(np.tile([1.0, 3.0, 5.0, 7.0], (10, 1)))
    assert agreed is not None and agreed.kendall_w == pytest.approx(1.0)
    ratings = ratings_of(2, 24, [4.0, 4.5, 5.0, 3.5])
    found = friedman(ratings)
    assert found is not None
    assert found.chi_square == pytest.approx(float(stats.friedmanchisquare(*ratings.T).statistic))
    assert found.kendall_w == pytest.approx(found.chi_square / (24 * 3))


def test_ratings_that_are_all_equal_get_a_reason_in_place_of_tests() -> None:
    result = analysed(np.full((24, 4), 4.0))
    assert result.friedman is None and result.friedman_statement == "every participant rated all methods alike"
    assert all(pair.p is None and pair.p_shaffer is None for pair in result.pairs)
    # That all ratings are equal is the strongest evidence for equivalence.
    assert all(pair.p_equivalence < 0.001 for pair in result.pairs)
    assert all(p is None for p in result.normality_p)


def test_pairs_are_followed_up_only_where_the_methods_differ() -> None:
    same, different = analysed(ratings_of(1, 24, [4.0] * 4)), analysed(ratings_of(1, 24, [5.5, 4.0, 4.0, 3.0]))
    assert same.friedman is not None and same.friedman.p > 0.05
    assert all(pair.p_shaffer is None for pair in same.pairs) and "no pair is tested" in same.friedman_statement
    assert different.friedman_statement == ""
    for pair in different.pairs:
        assert pair.p is not None and pair.p_shaffer is not None and pair.p_shaffer >= pair.p
    assert min(pair.p_shaffer for pair in different.pairs) < 0.001  # type: ignore[type-var]


def test_equal_methods_are_equivalent_with_enough_participants_and_different_ones_never() -> None:
    assert equivalence(*ratings_of(8, 300, [4.0, 4.0]).T, 0.5) < 0.001
    assert equivalence(*ratings_of(8, 300, [5.5, 3.0]).T, 0.5) > 0.99


def test_the_larger_side_of_equivalence_decides_and_a_wider_bound_is_easier() -> None:
    first, second = ratings_of(9, 24, [4.2, 4.0]).T
    below, above = signed_rank_p(first - second - 0.5, "less"), signed_rank_p(first - second + 0.5, "greater")
    assert equivalence(first, second, 0.5) == max(below, above)  # type: ignore[type-var]
    assert equivalence(first, second, 2.0) < equivalence(first, second, 1.0) < equivalence(first, second, 0.5)
    # All differences at the bound are no evidence for a smaller one.
    assert equivalence(np.full(24, 5.0), np.full(24, 4.0), 1.0) == 1.0


def test_holm_s_correction_is_that_of_its_definition() -> None:
    assert holm([0.01, 0.04, 0.03, 0.005]) == pytest.approx([0.03, 0.06, 0.06, 0.02])
    assert holm([0.9, 0.6]) == [1.0, 1.0] and holm([0.2]) == [0.2]
