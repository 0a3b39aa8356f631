"""The lag from stylus to vibration: found where it is known, and of the shipped engine within its goal."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

from haptoflow_benchmark.stylus_lag import correlations, lag_strokes, mean_power, peak_ms

ROOT = Path(__file__).parents[2]
ENGINE = Path(os.environ.get("HAPTOFLOW_ENGINE", ROOT / "build" / "native" / "haptoflow"))
MODEL = ROOT / "Packages" / "com.haptoflow.runtime" / "Runtime" / "Models" / "default.haptoflow"


@pytest.mark.parametrize("lag_ms", [0.0, 12.0, 33.0])
def test_noise_whose_level_follows_the_speed_late_has_that_lag(lag_ms: float) -> None:
    generator = np.random.default_rng(5)
    for stroke in lag_strokes({}):
        times = np.arange(int(stroke.seconds * 2000)) / 2000.0
        level = np.maximum(stroke.speed(times - lag_ms / 1000.0), 0.004)
        power = np.mean([(level * generator.standard_normal(len(times))) ** 2 for _ in range(8)], axis=0)
        assert peak_ms(correlations(stroke, power)) == pytest.approx(lag_ms, abs=1.0), stroke.name


def test_the_engine_follows_a_scribble_within_a_pose_interval_lead_and_hop() -> None:
    assert ENGINE.is_file(), f"{ENGINE} is missing: build it with `npm run build`"
    stroke = next(iter(lag_strokes({})))
    lag_ms = peak_ms(correlations(stroke, mean_power(ENGINE, MODEL, stroke, 90.0, "wood")))
    assert 2.0 < lag_ms < 11.1 + 8.0 + 5.0
