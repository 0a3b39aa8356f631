"""Checks the analysis on simulated studies with known truth: does it find the truth as often as it states?"""

from __future__ import annotations

import tempfile
from collections import Counter
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import scipy
from scipy.stats import norm

from haptoflow_training.studies.intervals import Interval, share
from haptoflow_training.studies.latency_analysis import analyse_latency
from haptoflow_training.studies.log_columns import LATENCY, SIMILARITY
from haptoflow_training.studies.plans import CONDITIONS
from haptoflow_training.studies.power import findings, latency_answers, planned_signed_rank_power, rating_power
from haptoflow_training.studies.psychometric import Answers, Fit, fit, leave_one_out
from haptoflow_training.studies.rating_tests import (
    EQUIVALENCE_POINTS, SIGNIFICANCE, analysed, equivalences, signed_rank_p,
)  # fmt: skip
from haptoflow_training.studies.similarity_analysis import analyse_similarity
from haptoflow_training.studies.simulated_participants import (
    MATERIALS, METHODS, PAPER_CURVES, PLANNED_DZ, AnswerModel, RatingModel, planted,
)  # fmt: skip
from haptoflow_training.studies.simulation import simulate_latency, simulate_similarity
from haptoflow_training.studies.study_folder import read_faultless

PARTICIPANTS = 24
BETWEEN = (0.0, 0.3, 0.6)
EQUIVALENCE_BOUNDS = (EQUIVALENCE_POINTS, 0.75, 1.0)
EQUIVALENCE_PARTICIPANTS = (PARTICIPANTS, 48, 96, 144)
Advance = Callable[[], object]


def steps_of(studies: int, simulations: int) -> int:
    """How often `validated` calls advance."""
    return 2 * studies + (len(BETWEEN) + 4 + len(EQUIVALENCE_BOUNDS) + len(EQUIVALENCE_PARTICIPANTS)) * simulations


def validated(*, studies: int, simulations: int, seed: int, advance: Advance = int) -> dict[str, Any]:
    """studies: written as logs, read and analysed whole; simulations: of each single question, in memory."""
    return {
        "format": "haptoflow study validation",
        "version": 1,
        "scipy": scipy.__version__,
        "participants": PARTICIPANTS,
        "studies": studies,
        "simulations": simulations,
        "seed": seed,
        "thresholds": recovered_thresholds(studies, seed, advance),
        "planted": recovered_differences(studies, seed, advance),
        "planned": _planned_power(simulations, seed, advance),
        "intervals": [compared_intervals(between, simulations, seed, advance) for between in BETWEEN],
        "false_positives": false_positives(simulations, seed, advance),
        "equivalence": measured_equivalence(simulations, seed, advance),
    }


def recovered_thresholds(studies: int, seed: int, advance: Advance = int) -> dict[str, Any]:
    """Logs of the latency study, one seed a study: how often the reported interval contains the paper's threshold."""
    covered: Counter[str] = Counter()
    found: dict[str, list[float]] = {condition: [] for condition in CONDITIONS}
    errors: dict[str, list[float]] = {condition: [] for condition in CONDITIONS}
    for study in range(studies):
        with tempfile.TemporaryDirectory() as folder:
            simulate_latency(Path(folder), PARTICIPANTS, seed + study)
            result = analyse_latency(read_faultless(Path(folder)).of(LATENCY), seed=seed + study)
        for condition in CONDITIONS:
            one = result.fits[condition]
            if one.curve is not None and one.threshold_interval is not None and one.threshold_error is not None:
                covered[condition] += one.threshold_interval.covers(PAPER_CURVES[condition].x0)
                found[condition].append(one.curve.x0)
                errors[condition].append(one.threshold_error)
        advance()
    return {
        condition: {
            "truth_ms": PAPER_CURVES[condition].x0,
            "mean_ms": round(float(np.mean(found[condition])), 2),
            "spread_ms": round(float(np.std(found[condition], ddof=1)), 2),
            "mean_standard_error_ms": round(float(np.mean(errors[condition])), 2),
            "covered": share(covered[condition], studies).as_json(),
        }
        for condition in CONDITIONS
    }


def recovered_differences(studies: int, seed: int, advance: Advance = int) -> dict[str, Any]:
    """Logs of the similarity study, in which the last method is rated lower on every second material."""
    model = planted(MATERIALS, METHODS, PLANNED_DZ)
    lowered = {material for material, _ in model.lowered}
    counts: Counter[str] = Counter()
    for study in range(studies):
        with tempfile.TemporaryDirectory() as folder:
            simulate_similarity(Path(folder), PARTICIPANTS, seed + study, model)
            result = analyse_similarity(read_faultless(Path(folder)).of(SIMILARITY))
        for material, one in result.by_material.items():
            if material in lowered:
                counts.update(findings(one, len(METHODS) - 1))
            else:
                counts["no difference"] += one.differs
        advance()
    found, empty = studies * len(lowered), studies * (len(MATERIALS) - len(lowered))
    return {
        "difference_dz": PLANNED_DZ,
        "friedman": share(counts["friedman"], found).as_json(),
        "pair": share(counts["pair"], found).as_json(),
        "pair_alone": share(counts["alone"], found).as_json(),
        "friedman_without_difference": share(counts["no difference"], empty).as_json(),
    }


def _planned_power(simulations: int, seed: int, advance: Advance) -> dict[str, Any]:
    """The power that `study power` states, and G*Power's formula beside Wilcoxon's test on differences that are not
    rounded."""
    power = rating_power(
        PARTICIPANTS, len(METHODS), PLANNED_DZ, simulations=simulations, seed=seed + 1_000_000, advance=advance
    )  # fmt: skip
    random = np.random.default_rng((seed, 2))
    found = sum(
        (signed_rank_p(random.normal(PLANNED_DZ, 1.0, PARTICIPANTS)) or 0.0) < SIGNIFICANCE for _ in range(simulations)
    )
    return {
        "friedman": power.friedman.as_json(),
        "pair": power.pair.as_json(),
        "pair_alone": power.pair_alone.as_json(),
        "formula": round(planned_signed_rank_power(PARTICIPANTS, PLANNED_DZ), 4),
        "unrounded": share(found, simulations).as_json(),
    }


def compared_intervals(between: float, simulations: int, seed: int, advance: Advance = int) -> dict[str, Any]:
    """How often percentile, BCa and expanded percentile intervals contain the true threshold, from the same
    resamples."""
    model = AnswerModel(between=between)
    random = np.random.default_rng((seed, 3, int(100 * between)))
    covered: Counter[tuple[str, str]] = Counter()
    widths: dict[tuple[str, str], list[float]] = {}
    for study in range(simulations):
        for condition, answers in latency_answers(model, random, PARTICIPANTS).items():
            one = fit(answers, seed=seed + study)
            for name, interval in _intervals(answers, one).items():
                covered[name, condition] += interval.covers(model.curves[condition].x0)
                widths.setdefault((name, condition), []).append(interval.high - interval.low)
        advance()
    return {
        "between": between,
        "by_interval": {
            name: {
                condition: {
                    **share(covered[name, condition], simulations).as_json(),
                    "median_width_ms": round(float(np.median(widths[name, condition])), 1),
                }
                for condition in CONDITIONS
            }
            for name in ("percentile", "BCa", "expanded percentile")
        },
    }


def _intervals(answers: Answers, one: Fit) -> dict[str, Interval]:
    """Coverage of the intervals; a study without an interval counts as missed."""
    if one.curve is None or one.threshold_interval is None or one.resampled_x0 is None:
        return {}
    resampled = one.resampled_x0[~np.isnan(one.resampled_x0)]
    low, high = np.quantile(resampled, [0.025, 0.975])
    return {
        "percentile": Interval(float(low), float(high)),
        "BCa": bca_interval(one.curve.x0, resampled, leave_one_out(answers)[1]),
        "expanded percentile": one.threshold_interval,
    }


def bca_interval(estimate: float, resampled: np.ndarray, without_one: np.ndarray) -> Interval:
    """Efron (1987), Better bootstrap confidence intervals: 95 %, bias-corrected and accelerated."""
    below = np.mean(resampled < estimate) / 2.0 + np.mean(resampled <= estimate) / 2.0
    bias = norm.ppf(np.clip(below, 1e-6, 1.0 - 1e-6))
    deviations = without_one.mean() - without_one
    acceleration = np.sum(deviations**3) / (6.0 * np.sum(deviations**2) ** 1.5)
    outer = bias + norm.ppf([0.025, 0.975])
    low, high = np.quantile(resampled, norm.cdf(bias + outer / (1.0 - acceleration * outer)))
    return Interval(float(low), float(high))


def false_positives(simulations: int, seed: int, advance: Advance = int) -> dict[str, Any]:
    """Rates of false positives, which should be at most 5 %, for ratings from 1 to 7 of four methods."""
    random = np.random.default_rng((seed, 4))
    alike, crowded = RatingModel(["m"]), RatingModel(["m"], mean=6.0, between=0.5, noise=0.6)
    one_lower = RatingModel(["m"], lowered={("m", METHODS[-1]): 1.5})
    counts: Counter[str] = Counter()
    for model, name in ((alike, "alike"), (crowded, "crowded"), (one_lower, "one_lower")):
        for _ in range(simulations):
            counts.update(f"{name} {what}" for what in _false_findings(model, random))
            advance()
    return {
        name: share(counts[key], simulations).as_json()
        for name, key in (
            ("friedman", "alike friedman"),
            ("wilcoxon", "alike wilcoxon"),
            ("any_pair_after_shaffer", "alike any"),
            ("friedman_crowded", "crowded friedman"),
            ("wilcoxon_crowded", "crowded wilcoxon"),
            ("any_pair_crowded", "crowded any"),
            ("any_pair_of_three_alike_beside_a_lower_one", "one_lower any"),
        )
    }


def _false_findings(model: RatingModel, random: np.random.Generator) -> Sequence[str]:
    result = analysed(model.ratings(random, PARTICIPANTS)[0])
    pairs = [pair for pair in result.pairs if not model.lowered or pair.second < len(METHODS) - 1]
    found = {
        "friedman": result.differs,
        "wilcoxon": pairs[0].differs_alone,
        "any": any(pair.differs for pair in pairs),
    }
    return [key for key, is_found in found.items() if is_found]


def measured_equivalence(simulations: int, seed: int, advance: Advance = int) -> dict[str, Any]:
    """How often methods that are just not equivalent are called so, and how often methods that are alike are found so.

    at_the_bound: two methods whose means are the bound apart, one test alone. any_of_four: four methods of which two
    are alike and the other two the bound above them, so that four pairs are not equivalent: any of these after correction.
    alike: four methods without a difference, a given pair after correction, by number of participants.
    """
    random = np.random.default_rng((seed, 6))
    by_bound = {}
    for bound in EQUIVALENCE_BOUNDS:
        alone = any_of_four = 0
        for _ in range(simulations):
            ratings = _apart(random, bound)
            # The pairs in order: 1-2, 1-3, 1-4, 2-3, 2-4, 3-4.
            apart = equivalences(ratings, bound)[1:5]
            alone += apart[0][0] < SIGNIFICANCE
            any_of_four += any(corrected < SIGNIFICANCE for _, corrected in apart)
            advance()
        by_bound[str(bound)] = {
            "at_the_bound": share(alone, simulations).as_json(),
            "any_of_four": share(any_of_four, simulations).as_json(),
            "alike": {},
        }
    for count in EQUIVALENCE_PARTICIPANTS:
        found: Counter[float] = Counter()
        for _ in range(simulations):
            ratings = RatingModel(["m"]).ratings(random, count)[0]
            for bound in EQUIVALENCE_BOUNDS:
                found[bound] += equivalences(ratings, bound)[0][1] < SIGNIFICANCE
            advance()
        for bound in EQUIVALENCE_BOUNDS:
            by_bound[str(bound)]["alike"][str(count)] = share(found[bound], simulations).as_json()
    return by_bound


def _apart(random: np.random.Generator, points: float) -> np.ndarray:
    """Whole ratings from 1 to 7 of four methods; the last two have means that lie `points` above the first two."""
    model = RatingModel(["m"])
    own = random.normal(0.0, model.between, (PARTICIPANTS, 1))
    # About the middle of the scale its ends shorten both sides alike.
    means = 4.0 + points * np.array([-0.5, -0.5, 0.5, 0.5])
    values = means + own + random.normal(0.0, model.noise, (PARTICIPANTS, len(METHODS)))
    return np.asarray(np.clip(np.round(values), 1, 7))
