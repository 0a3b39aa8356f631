"""The analysis on studies with known truth, in a short form of `study validate`."""

from __future__ import annotations


import numpy as np
import pytest

from haptoflow_training.cli import main
from haptoflow_training.studies.psychometric import share
from haptoflow_training.studies.plans import CONDITIONS
from haptoflow_training.studies.power import latency_power
from haptoflow_training.studies.rating_tests import analysed
from haptoflow_training.studies.simulation import PAPER_CURVES, AnswerModel, RatingModel


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
