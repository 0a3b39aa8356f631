"""The study of places: its measures, on waves whose answer is known."""

from __future__ import annotations

import json

import numpy as np
import pytest

from haptoflow_benchmark.engine_render import read_recorded_strokes
from haptoflow_paper.studies.creeping import hand_overs
from haptoflow_paper.studies import place_report
from haptoflow_paper.studies.place_study import RULED, Pass, Profile, bumps, likeness, over_place, second_passes, summary
from haptoflow_paper.studies.velocity_cases import growing_parabola, made_motions, real_motions, sampled
from haptoflow_paper.studies.velocity_study import PRODUCT, PRODUCT_SETTINGS, page_words, product_velocity
from haptoflow_training.model_stamp import with_measured_words
from places import ENGINE, ROOT


def _surface(places_metres: np.ndarray, seed: int = 3) -> np.ndarray:
    """Heights that vary over half a millimetre and more."""
    rng = np.random.default_rng(seed)
    waves = rng.uniform(100.0, 2000.0, 40), rng.uniform(0.0, 2.0 * np.pi, 40)
    return np.sin(2.0 * np.pi * places_metres[:, None] * waves[0] + waves[1]).sum(axis=1)


def _felt(stroke: Pass, delay_seconds: float = 0.0, seed: int = 3) -> Profile:
    times = np.arange(0.0, abs(stroke.end_metres - stroke.start_metres) / stroke.speed_mps, 1.0 / 2000.0)
    places = stroke.start_metres + stroke.direction * stroke.speed_mps * (times - delay_seconds)
    return over_place(_surface(places, seed), stroke)


@pytest.mark.parametrize(
    "stroke",
    [Pass(), Pass().begun_earlier(0.00173), Pass(-0.01, 0.068, 0.12), Pass(-0.02, 0.075, 0.2), Pass(-0.005, 0.06, 0.05),
     Pass(0.065, -0.01)],
)  # fmt: skip
def test_any_pass_over_one_place_is_alike_and_in_its_place(stroke: Pass) -> None:
    found = likeness(_felt(Pass()), _felt(stroke), 0.002, 0.052)
    assert found.correlation > 0.97
    assert abs(found.shift_metres) <= 2.5e-5


def test_a_late_vibration_is_shifted_and_not_unlike() -> None:
    found = likeness(_felt(Pass()), _felt(Pass(), delay_seconds=0.005), 0.002, 0.052)
    assert found.correlation > 0.97
    assert found.shift_metres == pytest.approx(5e-4, abs=5e-5)
    assert found.unshifted < 0.5


def test_the_page_says_met_and_missed() -> None:
    figures = {"correlation": 0.62, "unshifted": 0.6, "shift_mm": 0.01}
    chance = {"correlation": 0.1, "unshifted": 0.0, "shift_mm": 0.4}
    names = [*second_passes(), "second round of a circle"]
    by_label = {
        label: {name: chance if name in ("1 mm beside", "another object") else figures for name in names}
        | ({"bumps": {"bumps": 10, "again": 4, "by_chance": 1}} if label == "stone" else {})
        for label in ("wood", "stone", *RULED)
    }
    assert summary(by_label, "backwards")["median"] == pytest.approx(0.62)
    creeping = {"wood": {"now": {"2": {"peak_mps2": 0.1, "kurtosis": 3.0}}, "recorder": {"2": {"peak_mps2": 0.0, "kurtosis": 0.0}}}}
    words = place_report.page_words(
        {"model_sha256": "ab", "likeness": {"now": by_label}, "creeping": creeping,
         "hand_overs": {"wood": [{"swing": 2.0, "chance": 0.6, "burst": 0.4, "burst_chance": 0.2}]},
         "held": [{"diameter_mm": 0.7, "peak_mps2": 0.0}, {"diameter_mm": 1.4, "peak_mps2": 0.2}]}
    )  # fmt: skip
    assert "| same direction and speed | 0.62 (0.62 to 0.62) | 0.97: missed |" in words
    assert "| backwards | 0.62 (0.62 to 0.62) | 0.68: missed |" in words
    assert "| 1 mm beside | 0.10 (0.10 to 0.10) | chance: met |" in words
    assert "next pass has 4 within a millimetre" in words
    assert "1 are exactly silent" in words and "heard are 1.40 mm (goal missed)" in words


STROKES = ROOT.parent / "shared" / "strokes" / "vr-pen-on-surface" / "strokes.csv"
RESULTS = ROOT / "Training" / "haptoflow_paper" / "results" / "velocity.json"
PAGE = ROOT / "Training" / "haptoflow_paper" / "results" / "velocity.md"


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


def test_the_page_shows_the_committed_results() -> None:
    page = PAGE.read_text(encoding="utf-8")
    results = json.loads(RESULTS.read_text(encoding="utf-8"))
    assert results["rows"][PRODUCT]["cells"] and not set(results["choosing"]) & set(results["reporting"])
    assert page == with_measured_words(page, page_words(results)), "write it anew: haptoflow-paper velocity --page"
