"""The study of places: its measures, on waves whose answer is known."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

from haptoflow_benchmark.engine_render import read_recorded_strokes
from haptoflow_paper.studies.place_study import Pass, Profile, likeness, over_place
from haptoflow_paper.studies.velocity_cases import growing_parabola, made_motions, real_motions, sampled
from haptoflow_paper.studies.velocity_study import PRODUCT_SETTINGS, product_velocity


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


ROOT = Path(__file__).parents[2]
STROKES = ROOT.parent / "shared" / "strokes" / "vr-pen-on-surface" / "strokes.csv"
ENGINE = Path(os.environ.get("HAPTOFLOW_ENGINE", ROOT / "build" / "native" / "haptoflow"))


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
