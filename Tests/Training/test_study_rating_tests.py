"""Tests and effect sizes of ratings with ties, with zeros and without differences."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from scipy import stats

from haptoflow_training.studies.rating_tests import (
    EQUIVALENCE_POINTS, analysed, cohen_dz, equivalence, friedman, holm, normality_p, rank_biserial, signed_rank_p,
)  # fmt: skip


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


def test_five_differences_of_one_sign_are_not_significant_as_the_normal_approximation_would_have_it() -> None:
    assert signed_rank_p(np.array([1.0, 1.0, 2.0, 1.0, 3.0])) == pytest.approx(0.0625)


def test_a_single_difference_is_never_significant() -> None:
    one = np.array([0.0, 0.0, 2.0, 0.0])
    assert signed_rank_p(one) == 1.0 and signed_rank_p(one, "greater") == 0.5 and signed_rank_p(one, "less") == 1.0


def test_many_differences_rank_their_zeros_and_correct_the_variance_for_ties() -> None:
    differences = np.array([1.0] * 8 + [2.0] * 5 + [-1.0] * 4 + [0.0] * 7)
    ranks = stats.rankdata(np.abs(differences))[differences != 0.0]
    z = (ranks[differences[differences != 0.0] > 0.0].sum() - ranks.sum() / 2.0) / np.sqrt(np.sum(ranks**2) / 4.0)
    assert signed_rank_p(differences) == pytest.approx(2.0 * stats.norm.sf(abs(z)), rel=1e-9)


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


def test_two_methods_are_tested_directly() -> None:
    result = analysed(ratings_of(5, 24, [5.0, 3.5]))
    (pair,) = result.pairs
    assert result.friedman is None and pair.p == pair.p_shaffer and pair.p is not None and pair.p < 0.01


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


def test_scatter_does_not_widen_the_bound() -> None:
    calm, wild = (ratings_of(3, 24, [4.6, 4.0], spread) for spread in (0.6, 3.0))
    assert equivalence(*wild.T, 1.0) > equivalence(*calm.T, 1.0)
    assert {pair.bound for pair in (*analysed(calm).pairs, *analysed(wild).pairs)} == {EQUIVALENCE_POINTS}


def test_holm_s_correction_is_that_of_its_definition() -> None:
    assert holm([0.01, 0.04, 0.03, 0.005]) == pytest.approx([0.03, 0.06, 0.06, 0.02])
    assert holm([0.9, 0.6]) == [1.0, 1.0] and holm([0.2]) == [0.2]


def test_equivalence_is_corrected_for_the_number_of_pairs() -> None:
    result = analysed(ratings_of(8, 24, [4.0] * 4), 1.0)
    assert [pair.p_holm for pair in result.pairs] == holm([pair.p_equivalence for pair in result.pairs])
    assert max(pair.p_holm for pair in result.pairs) > max(pair.p_equivalence for pair in result.pairs) - 1e-12
    assert min(pair.p_holm for pair in result.pairs) == pytest.approx(6 * min(p.p_equivalence for p in result.pairs))


def test_a_method_that_everyone_rates_alike_can_still_be_compared_with_one_that_varies() -> None:
    result = analysed(np.column_stack([np.full(24, 7.0), ratings_of(4, 24, [3.0]).ravel()]))
    assert result.normality_p[0] is None and result.normality_p[1] is not None
    assert result.pairs[0].p is not None and result.pairs[0].p < 0.001


def test_normality_is_rejected_for_clustered_ratings_and_not_tested_for_two() -> None:
    piled = normality_p(np.array([7.0] * 20 + [1.0, 2.0, 6.0, 6.0]))
    assert piled is not None and piled < 0.001
    assert normality_p(np.array([1.0, 2.0])) is None
