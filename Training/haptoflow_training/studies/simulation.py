"""Simulated studies as logs: every participant's plan, answered by a simulated participant."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from datetime import datetime, timezone
from pathlib import Path
from typing import Any

import numpy as np
from scipy import special, stats
from scipy.stats import norm

from haptoflow_training.errors import InputError
from haptoflow_training.studies.log_table import LATENCY, SIMILARITY, STUDIES
from haptoflow_training.studies.plans import (
    CONDITIONS, MAIN, TURN_OFF, TURN_ON, LatencyTrial, SimilarityTrial, latency_plan, similarity_plan
)
from haptoflow_training.studies.psychometric import Answers, Curve, Share, fit, share, threshold_difference
from haptoflow_training.studies.rating_tests import EQUIVALENCE_POINTS, SIGNIFICANCE, RatingResult, analysed
from haptoflow_training.studies.session_file import EQUIVALENCE_KEY, NAME, write_session

# Section 4.2 of the paper.
PAPER_CURVES: Mapping[str, Curve] = {TURN_ON: Curve(0.0214, 130.25), TURN_OFF: Curve(0.0311, 107.74)}
LEVELS_MS = tuple(float(level) for level in range(50, 251, 20))
MATERIALS = ("ceramic", "jute", "wood", "plastic", "fur", "metal")
METHODS = ("haptoflow", "transformer", "dstn", "spsi")
# The effect size for which the paper's number of participants was planned.
PLANNED_DZ = 0.67


@dataclass(frozen=True)
class AnswerModel:
    """between: correlation, 0 to below 1, of a participant's answers with each other through the participant's own
    threshold. Whatever its value, the share of yes over all participants follows the curve exactly (a Gaussian
    copula of logistic thresholds), so that a fit should recover the curve."""

    curves: Mapping[str, Curve] = field(default_factory=lambda: dict(PAPER_CURVES))
    between: float = 0.3

    def answers(
        self, random: np.random.Generator, condition: str, delays_ms: np.ndarray, own: np.ndarray
    ) -> np.ndarray:
        """Yes (True) to each delay. own: a standard normal number for each participant, broadcast against delays_ms."""
        curve = self.curves[condition]
        noise = random.standard_normal(np.broadcast_shapes(delays_ms.shape, own.shape))
        quantile = norm.cdf(np.sqrt(self.between) * own + np.sqrt(1.0 - self.between) * noise)
        return np.asarray(delays_ms > curve.x0 + special.logit(quantile) / curve.k)


@dataclass(frozen=True)
class RatingModel:
    """Ratings from 1 to 7: mean, a participant's own offset, noise, rounded; in points of rating.

    lowered: for (material, method), by how many standard deviations of the differences (Cohen's d_z, before rounding)
    the method is rated below the others.
    """

    materials: Sequence[str] = MATERIALS
    methods: Sequence[str] = METHODS
    lowered: Mapping[tuple[str, str], float] = field(default_factory=dict)
    mean: float = 4.2
    between: float = 0.7
    noise: float = 1.1

    def ratings(self, random: np.random.Generator, participants: int) -> np.ndarray:
        """Ratings, materials by participants by methods."""
        shape = (len(self.materials), participants, len(self.methods))
        own = random.normal(0.0, self.between, (1, participants, 1))
        values = self.mean + own + random.normal(0.0, self.noise, shape)
        for (material, method), standard_deviations in self.lowered.items():
            shift = standard_deviations * np.sqrt(2.0) * self.noise
            values[list(self.materials).index(material), :, list(self.methods).index(method)] -= shift
        return np.asarray(np.clip(np.round(values), 1, 7))


def planted(materials: Sequence[str], methods: Sequence[str], difference_dz: float) -> RatingModel:
    """The last method is rated lower on every second material, beginning with the first; 0 lowers none."""
    lowered = {(material, methods[-1]): difference_dz for material in materials[::2]} if difference_dz else {}
    return RatingModel(materials, methods, lowered)


_WORDS = "simulated: haptoflow-training study simulate"
# A headset with 72 frames a second, blocks of 256 frames at 48 kHz, and an assumed device delay.
_REFRESH_HZ, _OUTPUT_HZ, _BLOCK_FRAMES, _DEVICE_MS = 72.0, 48000, 256, 20.0
_INFERENCE_MS = {LATENCY: 0.0, SIMILARITY: 15.0}
_ARTIFICIAL_MS = 10.0


def simulate_latency(folder: Path, participants: int, seed: int, advance: Callable[[], object] = int) -> None:
    """Write one session for each participant, with the paper's levels. InputError if the folder holds sessions
    already."""
    model = AnswerModel()
    _refuse_sessions(folder, LATENCY)
    random = np.random.default_rng((seed, STUDIES.index(LATENCY)))
    curves = {condition: asdict(curve) for condition, curve in model.curves.items()}
    truth = {"curves": curves, "correlation_of_a_participants_answers": model.between}
    for participant in range(1, participants + 1):
        plan = latency_plan(participant, seed, LEVELS_MS)
        own = random.standard_normal(1)
        rows = []
        for trial in plan:
            is_yes = bool(model.answers(random, trial.condition, np.array([trial.delay_ms]), own)[0])
            rows.append(_latency_row(random, trial, is_yes))
        settings = {"levels_ms": list(LEVELS_MS), "simulated_truth": truth}
        write_session(folder, _sidecar(random, LATENCY, participant, seed, settings, plan), _timed(rows))
        advance()


def simulate_similarity(
    folder: Path, participants: int, seed: int, model: RatingModel | None = None, advance: Callable[[], object] = int
) -> None:
    """Write one session for each participant, with the model's materials and methods. InputError as for the latency
    study."""
    model = model or RatingModel()
    _refuse_sessions(folder, SIMILARITY)
    random = np.random.default_rng((seed, STUDIES.index(SIMILARITY)))
    ratings = model.ratings(random, participants)
    places = {name: place for names in (model.materials, model.methods) for place, name in enumerate(names)}
    lowered = [
        {"material": material, "method": method, "lower_by_dz": value}
        for (material, method), value in model.lowered.items()
    ]
    settings = {
        "materials": list(model.materials), "methods": list(model.methods), EQUIVALENCE_KEY: EQUIVALENCE_POINTS,
        "simulated_truth": {"lowered": lowered},
    }  # fmt: skip
    for participant in range(1, participants + 1):
        plan = similarity_plan(participant, seed, model.materials, model.methods)
        rows = []
        for trial in plan:
            rating = int(ratings[places[trial.material], participant - 1, places[trial.method]])
            rows.append(_similarity_row(random, trial, rating if trial.block == MAIN else 4))
        write_session(folder, _sidecar(random, SIMILARITY, participant, seed, settings, plan), _timed(rows))
        advance()


def _refuse_sessions(folder: Path, study: str) -> None:
    for path in sorted(folder.rglob("*.json")) if folder.is_dir() else ():
        name = NAME.fullmatch(path.stem)
        if name is None:
            continue
        if name[1] == study or '"simulated": true' not in path.read_text(encoding="utf-8", errors="replace"):
            raise InputError(f"{folder}: holds {path.name} already; simulated studies need a folder of their own")


def _delay_parts(study: str) -> dict[str, float]:
    return {
        "pose_interval_ms": 1000.0 / _REFRESH_HZ,
        "inference_ms": _INFERENCE_MS[study],
        "block_ms": 1000.0 * _BLOCK_FRAMES / _OUTPUT_HZ,
        "device_ms": _DEVICE_MS,
    }


def _sidecar(
    random: np.random.Generator,
    study: str,
    participant: int,
    seed: int,
    settings: Mapping[str, Any],
    plan: Sequence[LatencyTrial | SimilarityTrial],
) -> dict[str, Any]:
    return {
        "study": study,
        "participant": participant,
        "session": f"{random.integers(1 << 32):08x}",
        "seed": seed,
        "simulated": True,
        "created": datetime.now(timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ"),
        "finished": True,
        "resumptions": 0,
        "build": {"application": _WORDS, "unity": "", "package": "", "platform": ""},
        "device": {
            "headset": "none: simulated",
            "refresh_rate_hz": _REFRESH_HZ,
            "output_rate_hz": _OUTPUT_HZ,
            "block_frames": _BLOCK_FRAMES,
            "device_delay_ms": _DEVICE_MS,
            "device_delay_source": "estimated",
            "device_delay_note": "none: simulated",
        },
        "delay": _delay_parts(study),
        "models": [],
        "settings": settings,
        "plan": [asdict(trial) for trial in plan],
    }


def _delays(study: str, planned_ms: float | None) -> dict[str, float]:
    system = round(sum(_delay_parts(study).values()), 6)
    planned = system + _ARTIFICIAL_MS if planned_ms is None else planned_ms
    return {
        "delay_ms": planned,
        "system_delay_ms": system,
        "artificial_delay_ms": planned - system,
        "delivered_delay_ms": planned,
    }


def _latency_row(random: np.random.Generator, trial: LatencyTrial, is_yes: bool) -> dict[str, Any]:
    strokes = int(random.integers(2, 6))
    return {
        **asdict(trial),
        **_delays(LATENCY, trial.delay_ms),
        "starts": strokes,
        "stops": strokes,
        "answer": "yes" if is_yes else "no",
        **_contact(random, 150.0, 1.5 * strokes),
    }


def _similarity_row(random: np.random.Generator, trial: SimilarityTrial, rating: int) -> dict[str, Any]:
    real, virtual, free = (float(seconds) for seconds in random.uniform(4.0, 12.0, 3))
    return {
        **asdict(trial),
        **_delays(SIMILARITY, None),
        "real_edges_seconds": real,
        "virtual_edges_seconds": virtual,
        "free_seconds": free,
        "rating": rating,
        **_contact(random, 100.0, real + virtual + free),
    }


def _contact(random: np.random.Generator, speed_mmps: float, seconds: float) -> dict[str, Any]:
    speed = float(speed_mmps * random.uniform(0.8, 1.2))
    return {
        "response_seconds": float(random.lognormal(0.7, 0.4)),
        "contact_seconds": seconds,
        "path_mm": seconds * speed,
        "mean_speed_mmps": speed,
        "mean_force_newtons": float(random.uniform(0.4, 1.2)),
        "underruns": 0,
        "attempt": 1,
    }


def _timed(rows: Sequence[dict[str, Any]]) -> list[dict[str, Any]]:
    elapsed = 0.0
    for row in rows:
        elapsed += row["contact_seconds"] + row["response_seconds"]
        row["elapsed_seconds"] = elapsed
    return list(rows)


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
