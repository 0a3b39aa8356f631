"""Estimators of velocity: the product is the chosen one, and the study finds what it is told."""

from __future__ import annotations

import json
import os
from pathlib import Path

import numpy as np
import pytest

from haptoflow_benchmark.engine_render import read_recorded_strokes
from haptoflow_paper.velocity.velocity_cases import made_motions, real_motions, sampled
from haptoflow_paper.velocity.velocity_estimators import (
    Estimator,
    adaptive_window,
    end_of_parabola,
    growing_parabola,
    kalman,
    line,
)
from haptoflow_paper.velocity.velocity_report import page_words
from haptoflow_paper.velocity.velocity_study import PRODUCT, PRODUCT_SETTINGS, product_velocity
from haptoflow_training.model_stamp import with_measured_words

ROOT = Path(__file__).parents[2]
STROKES = ROOT.parent / "shared" / "strokes" / "vr-pen-on-surface" / "strokes.csv"
ENGINE = Path(os.environ.get("HAPTOFLOW_ENGINE", ROOT / "build" / "native" / "haptoflow"))
RESULTS = ROOT / "Training" / "haptoflow_paper" / "results" / "velocity.json"
PAGE = ROOT / "Documentation~" / "velocity.md"


@pytest.mark.parametrize("rate_hz", [72.0, 500.0])
def test_the_product_is_the_growing_parabola_with_the_settings_that_the_study_names(rate_hz: float) -> None:
    assert ENGINE.is_file(), f"{ENGINE} is missing: build it with `npm run build`"
    motions = list(made_motions())
    if STROKES.is_file():
        motions += list(real_motions(read_recorded_strokes(STROKES), ("2",)))
    estimate = growing_parabola(**PRODUCT_SETTINGS)
    for motion in motions:
        case = sampled(motion, rate_hz, 0.00002, 9)
        wanted = estimate(case.times_s, case.measured_m, case.noise_known_m)
        found, is_known = product_velocity(ENGINE, case)
        assert is_known.all()
        # Before the third measurement the study's windows are one place longer than the product's history.
        assert np.abs(found - wanted[:, [0, 2]])[3:].max() < 1e-6, motion.kind


@pytest.mark.parametrize(
    "estimate",
    [line(0.035), end_of_parabola(0.05), adaptive_window(1, 3.0, 2), adaptive_window(2, 3.0, 3),
     growing_parabola(3.0, 0.01), kalman(10.0)],
)  # fmt: skip
def test_every_estimator_is_exact_for_steady_motion_at_uneven_times(estimate: Estimator) -> None:
    times = np.cumsum(np.random.default_rng(1).uniform(0.008, 0.02, 200))
    places = times[:, None] * np.array([0.3, 0.0, -0.1]) + 1000.0
    found = estimate(times, places, np.full(len(times), 1e-5))
    assert np.abs(found[100:] - [0.3, 0.0, -0.1]).max() < 1e-6


def test_the_page_shows_the_committed_results() -> None:
    page = PAGE.read_text(encoding="utf-8")
    results = json.loads(RESULTS.read_text(encoding="utf-8"))
    assert results["rows"][PRODUCT]["cells"] and not set(results["choosing"]) & set(results["reporting"])
    assert page == with_measured_words(page, page_words(results)), "write it anew: haptoflow-paper velocity --page"
