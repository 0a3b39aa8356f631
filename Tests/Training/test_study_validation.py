"""The analysis on studies with known truth, in a short form of `study validate`."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from scipy import stats

from haptoflow_training.cli import main
from haptoflow_training.studies.intervals import share
from haptoflow_training.studies.plans import CONDITIONS
from haptoflow_training.studies.power import latency_power, planned_signed_rank_power, rating_power
from haptoflow_training.studies.rating_tests import analysed
from haptoflow_training.studies.simulated_participants import PAPER_CURVES, AnswerModel, RatingModel
from haptoflow_training.studies.validation import (
    bca_interval, measured_equivalence, recovered_differences, recovered_thresholds,
)  # fmt: skip

ROOT = Path(__file__).parents[2]
RESULTS = ROOT / "Training" / "results" / "study-validation.json"


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


def test_thresholds_of_24_simulated_participants_are_recovered_from_their_logs() -> None:
    found = recovered_thresholds(16, 500)
    for condition in CONDITIONS:
        one = found[condition]
        assert one["mean_ms"] == pytest.approx(PAPER_CURVES[condition].x0, abs=6.0)
        # At 95 %, 12 or fewer of 16 would occur less than once in a hundred times.
        assert one["covered"]["rate"] * 16 >= 12.5
        assert one["mean_standard_error_ms"] == pytest.approx(one["spread_ms"], rel=0.5)


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


def test_a_planted_difference_is_found_in_logs_as_often_as_planned() -> None:
    planned = rating_power(24, 4, 0.67, simulations=150, seed=9)
    found = recovered_differences(10, 900)
    for power, name in ((planned.friedman, "friedman"), (planned.pair, "pair"), (planned.pair_alone, "pair_alone")):
        one = found[name]
        assert one["of"] == 30 and one["low"] <= power.high and one["high"] >= power.low
    assert planned.friedman.rate > 0.7 and planned.pair_alone.rate >= planned.pair.rate


def test_the_planned_power_of_one_pair_is_that_of_wilcoxons_test_on_normal_differences() -> None:
    # By hand: df = 24 * 3 / pi - 1, noncentrality 0.67 sqrt(24 * 3 / pi).
    assert planned_signed_rank_power(24, 0.67) == pytest.approx(0.865, abs=0.002)
    assert planned_signed_rank_power(24, 0.0) == pytest.approx(0.05, abs=1e-6)
    random = np.random.default_rng(2)
    found = sum(stats.wilcoxon(random.normal(0.67, 1.0, 24)).pvalue < 0.05 for _ in range(1000))
    assert share(found, 1000).covers(planned_signed_rank_power(24, 0.67))


def test_power_grows_with_participants_and_equals_the_level_without_a_difference() -> None:
    few, many = (rating_power(count, 3, 0.67, simulations=80, seed=4, bound=1.0) for count in (10, 40))
    assert many.pair.rate > few.pair.rate and many.equivalence is not None and few.equivalence is not None
    assert many.equivalence.rate > few.equivalence.rate
    assert rating_power(24, 3, 0.0, simulations=150, seed=4).friedman.rate < 0.12
    assert rating_power(24, 2, 0.67, simulations=20, seed=4).equivalence is None


def test_methods_that_differ_by_the_bound_are_called_equal_no_more_often_than_the_level() -> None:
    for one in measured_equivalence(40, 3).values():
        # Six of 40 or more would occur less than once in a hundred times at 5 %.
        assert one["at_the_bound"]["rate"] * 40 < 6.5 and one["any_of_four"]["rate"] * 40 < 6.5
        assert one["alike"]["144"]["rate"] >= one["alike"]["24"]["rate"]


def test_shares_have_wilsons_interval() -> None:
    one = share(190, 200)
    assert one.rate == 0.95
    assert (one.low, one.high) == pytest.approx((0.9104, 0.9726), abs=5e-4)
    assert one.covers(0.95) and not one.covers(0.9)


def test_the_bca_interval_of_a_symmetric_statistic_is_that_of_its_percentiles() -> None:
    values = np.random.default_rng(1).standard_normal(40001)
    interval = bca_interval(float(np.median(values)), values, np.array([-1.0, 1.0, -0.5, 0.5]))
    assert (interval.low, interval.high) == pytest.approx(tuple(np.quantile(values, [0.025, 0.975])), abs=0.02)


def test_the_validation_writes_its_figures_and_the_pages_part(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    page = tmp_path / "page.md"
    page.write_text("# Page\n\n<!-- measured: begin (x) -->\nbefore it\n<!-- measured: end -->\n\nend\n", encoding="utf-8")
    words = ["study", "validate", "--studies", "2", "--simulations", "2", "--out", str(tmp_path / "v.json")]
    assert main([*words, "--page", str(page)]) == 0
    found = json.loads((tmp_path / "v.json").read_text())
    assert found["studies"] == 2 and found["thresholds"]["turn-on"]["truth_ms"] == 130.25
    text = page.read_text(encoding="utf-8")
    assert "before it" not in text and "| turn-off | 107.74 |" in text and text.endswith("end\n")
    assert main([*words, "--studies", "1"]) == 3
    assert "--studies 1: expected 2 or more" in capsys.readouterr().err


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
