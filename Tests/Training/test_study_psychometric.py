"""The psychometric fit: maximum likelihood, correct intervals, and reasons where there is no number."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import optimize, special

from haptoflow_training.studies.psychometric import (
    Answers,
    Curve,
    expanded_interval,
    fit,
    fit_curve,
    threshold_difference,
)

LEVELS = np.arange(50.0, 251.0, 20.0)


def answers_of(yes: np.ndarray, delays: np.ndarray = LEVELS) -> Answers:
    """yes: participants by levels."""
    participants, levels = yes.shape
    return Answers(
        np.tile(delays, participants), yes.ravel().astype(int), np.repeat(np.arange(participants), levels)
    )


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
