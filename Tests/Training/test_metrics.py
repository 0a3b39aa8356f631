"""Metrics of the evaluation on waveforms whose figures are known."""

from __future__ import annotations

import numpy as np
import pytest

from haptoflow_benchmark import waveform_metrics as metrics
from haptoflow_paper.metrics import row_metrics

RATE_HZ = 2000


def _noise(seconds: float, seed: int) -> np.ndarray:
    return np.random.default_rng(seed).standard_normal(int(seconds * RATE_HZ))


def _tone(frequency_hz: float, seconds: float) -> np.ndarray:
    return np.sqrt(2.0) * np.sin(2.0 * np.pi * frequency_hz * np.arange(int(seconds * RATE_HZ)) / RATE_HZ)


def test_a_waveform_has_perfect_figures_against_itself() -> None:
    wave = _noise(4.0, 1)
    assert metrics.gfc_recording(wave, wave) == pytest.approx(1.0)
    assert row_metrics.gfc_segment(wave, wave) == pytest.approx(1.0)
    assert row_metrics.relative_rmse(wave, wave) == 0.0
    assert metrics.level_error_db(wave, wave) == 0.0
    assert metrics.log_spectral_distance_db(wave, wave) == 0.0
    assert np.abs(row_metrics.critical_band_errors_db(wave, wave)).max() == 0.0


def test_half_the_amplitude_is_minus_six_decibels_and_leaves_gfc_unchanged() -> None:
    wave = _noise(4.0, 1)
    assert metrics.level_error_db(0.5 * wave, wave) == pytest.approx(-6.02, abs=0.01)
    assert metrics.log_spectral_distance_db(0.5 * wave, wave) == pytest.approx(6.02, abs=0.01)
    np.testing.assert_allclose(row_metrics.critical_band_errors_db(0.5 * wave, wave), -6.02, atol=0.01)
    assert metrics.gfc_recording(0.5 * wave, wave) == pytest.approx(1.0)


def test_rmse_favours_silence_over_an_independent_draw_and_segment_gfc_penalises_correct_randomness() -> None:
    wave, draw = _noise(8.0, 1), _noise(8.0, 2)
    assert row_metrics.relative_rmse(np.zeros_like(wave), wave) == pytest.approx(1.0, abs=0.01)
    assert row_metrics.relative_rmse(draw, wave) == pytest.approx(np.sqrt(2.0), abs=0.03)
    assert row_metrics.gfc_segment(draw, wave) < 0.85
    assert metrics.gfc_recording(draw, wave) > 0.98


def test_a_band_that_a_recording_lacks_is_compared_with_the_floor_and_not_with_its_numbers_last_digits() -> None:
    tone = _tone(100.0, 8.0)
    # 7 bins of 126 hold the tone and its window; the rest is noise of 0.1 over the floor: 20 dB.
    distance = metrics.log_spectral_distance_db(tone + 0.1 * _noise(8.0, 4), tone)
    assert distance == pytest.approx(20.0, abs=1.0)


def test_the_fundamental_is_found_between_bins() -> None:
    wave = _tone(123.4, 4.0) + 0.3 * _noise(4.0, 3)
    assert row_metrics.fundamental_hz(wave, 120.0) == pytest.approx(123.4, rel=0.002)


def test_a_step_at_every_hop_shows_in_the_jump_ratio() -> None:
    wave, hops = _noise(4.0, 1), np.arange(0, 8000, 28)
    assert row_metrics.hop_jump_ratio(wave, hops) == pytest.approx(1.0, abs=0.1)
    stepped = wave + 3.0 * (np.arange(8000) // 28 % 2)
    assert row_metrics.hop_jump_ratio(stepped, hops) > 2.0
