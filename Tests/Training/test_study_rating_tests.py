"""Tests and effect sizes of ratings with ties, with zeros and without differences."""

from __future__ import annotations

from itertools import combinations, product

import numpy as np
import pytest
from scipy import optimize, special, stats

from haptoflow_training.cli import main
from haptoflow_training.studies.plans import CONDITIONS
from haptoflow_training.studies.simulation import PAPER_CURVES, AnswerModel, RatingModel, latency_power
from haptoflow_training.studies.psychometric import (
    Answers, Curve, expanded_interval, fit, fit_curve, share, threshold_difference
)
from haptoflow_training.studies.rating_tests import (
    adjusted, analysed, cohen_dz, equivalence, factors, friedman, holm, possible_true_counts, rank_biserial,
    signed_rank_p
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
    assert equivalence(np.subtract(*ratings_of(8, 300, [4.0, 4.0]).T), 0.5) < 0.001
    assert equivalence(np.subtract(*ratings_of(8, 300, [5.5, 3.0]).T), 0.5) > 0.99


def test_the_larger_side_of_equivalence_decides_and_a_wider_bound_is_easier() -> None:
    differences = np.subtract(*ratings_of(9, 24, [4.2, 4.0]).T)
    below, above = signed_rank_p(differences - 0.5, "less"), signed_rank_p(differences + 0.5, "greater")
    assert equivalence(differences, 0.5) == max(below, above)  # type: ignore[type-var]
    assert equivalence(differences, 2.0) < equivalence(differences, 1.0) < equivalence(differences, 0.5)
    # All differences at the bound are no evidence for a smaller one.
    assert equivalence(np.full(24, 1.0), 1.0) == 1.0


def test_holm_s_correction_is_that_of_its_definition() -> None:
    assert holm([0.01, 0.04, 0.03, 0.005]) == pytest.approx([0.03, 0.06, 0.06, 0.02])
    assert holm([0.9, 0.6]) == [1.0, 1.0] and holm([0.2]) == [0.2]


@pytest.mark.parametrize(
    ("methods", "published"),
    [
        # Shaffer (1986), table 1 and its procedure for four means.
        (4, [6, 3, 3, 3, 2, 1]),
        # Hommel (1988), Biometrika 75, page 384.
        (5, [10, 6, 6, 6, 6, 4, 4, 3, 2, 1]),
        # Holland and Copenhaver (1987), Biometrics 43, table 2.
        (6, [15, 10, 10, 10, 10, 10, 7, 7, 7, 6, 4, 4, 3, 2, 1]),
    ],
)
def test_factors_are_the_published_ones(methods: int, published: list[int]) -> None:
    assert factors(methods) == published


@pytest.mark.parametrize("methods", range(2, 7))
def test_the_possible_numbers_of_true_hypotheses_are_those_of_every_way_to_be_equal(methods: int) -> None:
    counts = {
        sum(values[first] == values[second] for first, second in combinations(range(methods), 2))
        for values in product(range(methods), repeat=methods)
    }
    assert possible_true_counts(methods) == counts


def test_adjusted_values_keep_the_order_and_stay_below_one_whatever_the_values() -> None:
    random = np.random.default_rng(4)
    for methods in range(2, 7):
        for _ in range(50):
            p_values = list(random.uniform(size=len(factors(methods))) ** 3)
            result = adjusted(p_values, factors(methods))
            assert all(raw <= value <= 1.0 for raw, value in zip(p_values, result, strict=True))
            by_rank = [value for _, value in sorted(zip(p_values, result, strict=True))]
            assert by_rank == sorted(by_rank)


@pytest.mark.parametrize("between", [0.0, 0.3, 0.9])
def test_simulated_answers_follow_the_curve_whatever_their_correlation(between: float) -> None:
    model = AnswerModel(between=between)
    random = np.random.default_rng(3)
    own = random.standard_normal((40000, 1))
    delays = np.array([[70.0, 130.25, 210.0]])
    yes = model.answers(random, "turn-on", delays, own)
    assert yes.mean(axis=0) == pytest.approx(PAPER_CURVES["turn-on"].percent(delays[0]) / 100.0, abs=0.012)
    correlation = np.corrcoef(yes[:, 0], yes[:, 1])[0, 1]
    assert correlation < 0.02 if between == 0.0 else correlation > 0.08


def test_intervals_hold_the_thresholds_at_their_nominal_rate_over_200_studies() -> None:
    found = latency_power(24, simulations=200, seed=11)
    for condition in CONDITIONS:
        assert found.covered[condition].covers(0.95) and found.covered[condition].of == 200
    assert found.without_interval == 0
    narrow = latency_power(96, simulations=20, seed=11)
    assert narrow.widths_ms["turn-on"] < 0.6 * found.widths_ms["turn-on"]
    assert narrow.differ.rate > found.differ.rate


def test_no_test_of_ratings_exceeds_its_false_positive_rate() -> None:
    random = np.random.default_rng(5)
    results = [analysed(RatingModel(["m"]).ratings(random, 24)[0]) for _ in range(300)]
    friedman = sum(one.friedman is not None and one.friedman.p < 0.05 for one in results)
    any_pair = sum(any(pair.p_shaffer is not None and pair.p_shaffer < 0.05 for pair in one.pairs) for one in results)
    alone = sum(one.pairs[0].p is not None and one.pairs[0].p < 0.05 for one in results)
    for count in (friedman, any_pair, alone):
        # More than 25 of 300 would occur less than once in a hundred times at 5 %.
        assert count <= 25
    assert min(friedman, alone) >= 5


def test_shares_have_wilsons_interval() -> None:
    one = share(190, 200)
    assert one.rate == 0.95
    assert (one.low, one.high) == pytest.approx((0.9104, 0.9726), abs=5e-4)
    assert one.covers(0.95) and not one.covers(0.9)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["similarity", "--participants", "4"], "--participants 4: expected 5 to 999"),
        (["similarity", "--methods", "7"], "--methods 7: expected 2 to 6"),
        (["similarity", "--equivalence-points", "0"], "--equivalence-points 0: expected 0.1 to 6"),
        (["latency", "--simulations", "1"], "--simulations 1: expected 10 to 100000"),
        (["latency", "--seed", "-1"], "--seed -1: expected 0 or more"),
    ],
)
def test_plans_that_cannot_be_simulated_are_refused(
    capsys: pytest.CaptureFixture[str], words: list[str], said: str
) -> None:
    assert main(["study", "power", "--study", *words]) == 3
    assert said in capsys.readouterr().err


LEVELS = np.arange(50.0, 251.0, 20.0)


def answers_of(yes: np.ndarray, delays: np.ndarray = LEVELS) -> Answers:
    """yes: participants by levels."""
    participants, levels = yes.shape
    return Answers(np.tile(delays, participants), yes.ravel().astype(int), np.repeat(np.arange(participants), levels))


def drawn(seed: int, k: float = 0.0214, x0: float = 130.25, participants: int = 24) -> Answers:
    random = np.random.default_rng(seed)
    return answers_of(random.uniform(size=(participants, len(LEVELS))) < special.expit(k * (LEVELS - x0)))


@pytest.mark.parametrize("seed", range(5))
def test_the_curve_is_the_maximum_likelihood_found_by_a_general_optimiser(seed: int) -> None:
    answers = drawn(seed)

    def loss(parameters: np.ndarray) -> float:
        signs = np.where(answers.yes == 1, 1.0, -1.0)
        return float(np.sum(np.log1p(np.exp(-signs * parameters[0] * (answers.delay_ms - parameters[1] * 100.0)))))

    exactly = {"xatol": 1e-10, "fatol": 1e-12, "maxiter": 5000}
    best = optimize.minimize(loss, [0.02, 1.2], method="Nelder-Mead", options=exactly)
    curve = fit_curve(answers)
    assert curve is not None
    assert curve.k == pytest.approx(best.x[0], rel=1e-5)
    assert curve.x0 == pytest.approx(best.x[1] * 100.0, rel=1e-6)


def test_very_many_answers_recover_the_curve_they_were_drawn_from() -> None:
    curve = fit_curve(drawn(1, participants=20000))
    assert curve is not None
    assert curve.k == pytest.approx(0.0214, rel=0.02)
    assert curve.x0 == pytest.approx(130.25, abs=0.6)
    assert curve.percent(curve.x0) == pytest.approx(50.0)


@pytest.mark.parametrize(
    ("yes", "said"),
    [
        (np.ones((24, 11)), "every answer is yes: the threshold lies below 50 ms"),
        (np.zeros((24, 11)), "every answer is no: the threshold lies above 250 ms"),
        (np.tile(LEVELS > 120.0, (24, 1)), "the threshold lies between 110 and 130 ms, and the slope k has no"),
        (np.vstack([np.tile(LEVELS > 120.0, (12, 1)), np.tile(LEVELS > 100.0, (12, 1))]), "lies at 110 ms"),
        (np.tile(LEVELS < 120.0, (24, 1)), "step from yes to no as the delay grows"),
        (np.vstack([np.tile(LEVELS < 120.0, (20, 1)), np.ones((2, 11))]), "does not become more frequent"),
    ],
)
def test_degenerate_answers_get_a_reason_and_no_number(yes: np.ndarray, said: str) -> None:
    result = fit(answers_of(yes))
    assert result.curve is None and result.threshold_interval is None and result.threshold_error is None
    assert said in result.statement


def test_a_single_participant_has_a_curve_without_an_interval_and_a_reason() -> None:
    yes = np.zeros((1, 11))
    yes[0, [3, 5, 6, 7, 8, 9, 10]] = 1
    result = fit(answers_of(yes))
    assert isinstance(result.curve, Curve)
    assert result.threshold_interval is None and "too few to resample" in result.interval_statement


def test_an_interval_is_refused_where_yes_and_no_hardly_overlap() -> None:
    yes = np.tile(LEVELS > 120.0, (24, 1)).astype(float)
    yes[0, 4], yes[0, 3] = 0.0, 1.0
    result = fit(answers_of(yes))
    assert result.curve is not None and result.threshold_interval is None
    assert "hardly overlap" in result.interval_statement


def test_an_interval_is_refused_where_some_resamples_are_almost_flat() -> None:
    random = np.random.default_rng(12)
    results = [fit(answers_of(random.uniform(size=(8, 11)) < 0.5), seed=1) for _ in range(40)]
    refused = [one for one in results if one.curve is not None and one.threshold_interval is None]
    assert refused and all(one.interval_statement for one in refused)
    for one in results:
        if one.threshold_interval is not None:
            assert -150.0 <= one.threshold_interval.low <= one.threshold_interval.high <= 450.0


def test_a_threshold_beyond_the_tested_delays_is_called_extrapolated() -> None:
    result = fit(drawn(3, x0=290.0))
    assert result.curve is not None and result.curve.x0 > 250.0
    assert any("extrapolated" in note for note in result.notes)


def test_the_same_seed_gives_the_same_interval_and_more_participants_a_narrower_one() -> None:
    few, many = fit(drawn(5, participants=12), seed=3), fit(drawn(5, participants=96), seed=3)
    assert few.threshold_interval == fit(drawn(5, participants=12), seed=3).threshold_interval
    assert few.threshold_interval is not None and many.threshold_interval is not None
    width = many.threshold_interval.high - many.threshold_interval.low
    assert width < 0.6 * (few.threshold_interval.high - few.threshold_interval.low)
    assert few.threshold_interval.covers(few.curve.x0)  # type: ignore[union-attr]


def test_participants_are_drawn_whole_so_that_copies_of_each_other_widen_the_interval() -> None:
    answers = drawn(6, participants=12)
    doubled = Answers(np.tile(answers.delay_ms, 2), np.tile(answers.yes, 2), np.tile(answers.participant, 2))
    assert fit(answers, seed=1).threshold_interval == fit(doubled, seed=1).threshold_interval


def test_the_difference_of_two_thresholds_is_resampled_by_the_same_participants() -> None:
    turn_on, turn_off = drawn(7), drawn(8, 0.0311, 107.74)
    first, second = fit(turn_on, seed=2), fit(turn_off, seed=2)
    difference = threshold_difference(first, second, 24)
    assert difference is not None and first.curve is not None and second.curve is not None
    assert difference.covers(first.curve.x0 - second.curve.x0)
    same = threshold_difference(first, fit(turn_on, seed=2), 24)
    assert same is not None and (same.low, same.high) == (0.0, 0.0)


def test_the_expanded_interval_is_wider_than_the_percentiles_by_students_t_and_the_count() -> None:
    values = np.random.default_rng(1).standard_normal(200000)
    interval = expanded_interval(np.append(values, np.nan), 24)
    assert interval.high == pytest.approx(np.sqrt(24 / 23) * 2.0687, abs=0.03)
    assert interval.low == pytest.approx(-interval.high, abs=0.05)
