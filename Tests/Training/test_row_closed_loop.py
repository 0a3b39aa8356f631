"""The closed loop of the evaluation: what the command line renders, and what a voice plays where labels change."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from haptoflow_benchmark.engine_library import default_engine
from haptoflow_benchmark.engine_render import render_motion
from haptoflow_benchmark.waveform_metrics import log_spectral_distance_db, rms
from haptoflow_paper.rows.closed_loop import closed_loop
from haptoflow_paper.rows.engine_generator import EngineGenerator
from places import DEFAULT, ROOT

STEADY = np.tile(np.array([0.1, 0.0, 1.0], np.float32), (8000, 1))


def _names(generator: EngineGenerator) -> list[str]:
    return [str(label["name"]) for label in generator.header["labels"]]


@pytest.mark.parametrize("tier", ["sketch", "standard"])
def test_a_played_label_has_the_level_and_spectrum_that_the_command_line_renders(tmp_path: Path, tier: str) -> None:
    with EngineGenerator(default_engine(ROOT), DEFAULT, tier) as generator:
        run = closed_loop(
            generator, STEADY[None], np.array([_names(generator).index("stone")]), update_rate_hz=72.0, seed=3
        )
    rendered = render_motion(
        ROOT / "build" / "native" / "haptoflow", "stone", STEADY, tmp_path, model=DEFAULT, options=("--quality", tier)
    ).waveform_mps2
    made, reference = run.waves[0, 400:], rendered[400:]
    assert abs(20.0 * np.log10(rms(made) / rms(reference))) < 0.5
    # The command line's output passes the resampler, which ends at 900 Hz.
    assert log_spectral_distance_db(made, reference, band_hz=(20.0, 900.0)) < 1.2


def test_another_label_sounds_from_the_hop_at_which_it_is_published() -> None:
    with EngineGenerator(default_engine(ROOT), DEFAULT, "sketch") as generator:
        stone, glass = (_names(generator).index(name) for name in ("stone", "glass"))
        labels = np.full((3, 288), stone)
        labels[1, 100:] = labels[2] = glass
        one, changed, other = closed_loop(generator, np.stack([STEADY] * 3), labels, update_rate_hz=72.0, seed=3).waves
    start = 100 * 2000 // 72
    # Each has its own surface, so that levels compare and samples do not; the resampler's delay is 2 samples.
    assert abs(20.0 * np.log10(rms(changed[400:start]) / rms(one[400:start]))) < 0.5
    assert abs(20.0 * np.log10(rms(changed[start + 20 :]) / rms(other[start + 20 :]))) < 0.5
    assert abs(20.0 * np.log10(rms(one) / rms(other))) > 3.0


def test_a_waveform_is_the_same_every_time_and_another_with_another_seed() -> None:
    with EngineGenerator(default_engine(ROOT), DEFAULT, "draft") as generator:
        first, again, another = (
            closed_loop(generator, STEADY[None, :1000], np.array([0]), update_rate_hz=72.0, seed=seed).waves
            for seed in (3, 3, 4)
        )
    np.testing.assert_array_equal(first, again)
    assert not np.allclose(first, another)


def test_the_first_correction_begins_at_a_hop_start() -> None:
    runs = []
    for tier in ("sketch", "standard"):
        with EngineGenerator(default_engine(ROOT), DEFAULT, tier) as generator:
            runs.append(closed_loop(generator, STEADY[None, :1000], np.array([0]), update_rate_hz=72.0, seed=3))
    differs = np.abs(runs[0].waves - runs[1].waves)[0] > 1e-3 * rms(runs[0].waves[0])
    assert np.min(np.abs(runs[1].hop_starts - int(np.argmax(differs)))) <= 2
