"""Temporal metrics on waveforms whose figures are known from theory."""

from __future__ import annotations

import numpy as np
import pytest

from haptoflow_paper.metrics import temporal_metrics as metrics
from haptoflow_paper.metrics import row_metrics

RATE_HZ = 2000


def _noise(seconds: float, seed: int) -> np.ndarray:
    return np.random.default_rng(seed).standard_normal(int(seconds * RATE_HZ))


def _time(seconds: float) -> np.ndarray:
    return np.arange(int(seconds * RATE_HZ)) / RATE_HZ


def test_gaussian_noise_has_kurtosis_three_and_crest_factor_three_point_three() -> None:
    wave = _noise(60.0, 1)
    assert metrics.kurtosis(wave) == pytest.approx(3.0, abs=0.1)
    assert metrics.crest_factor(wave) == pytest.approx(3.29, abs=0.1)


def test_the_envelope_is_the_rms_of_five_milliseconds() -> None:
    wave = np.repeat([1.0, -3.0, 2.0], 10)
    np.testing.assert_allclose(metrics.envelope(np.append(wave, [9.0] * 9)), [1.0, 3.0, 2.0])


def test_a_modulation_of_the_envelope_shows_only_in_its_band_with_its_power() -> None:
    time = _time(20.0)
    carrier = np.where(np.arange(len(time)) % 2 == 0, 1.0, -1.0)
    bands = metrics.modulation_spectrum_db(carrier * (1.0 + 0.5 * np.sin(2.0 * np.pi * 20.0 * time)))
    at = metrics.MODULATION_EDGES_HZ.index(16.0)
    # 0.5^2 / 2 of the squared mean, a little less for the average over a frame.
    assert bands[at] == pytest.approx(10.0 * np.log10(0.125), abs=0.3)
    assert np.delete(bands, at).max() < bands[at] - 25.0


def test_the_modulation_spectrum_is_independent_of_level_and_two_draws_of_noise_agree_within_a_decibel() -> None:
    first, second = _noise(24.0, 3), _noise(24.0, 4)
    np.testing.assert_allclose(metrics.modulation_spectrum_db(7.0 * first), metrics.modulation_spectrum_db(first))
    assert metrics.modulation_error_db(first, second) < 1.0


@pytest.mark.parametrize("rate_hz", [8.3, 25.0, 125.0, 417.0])
def test_noise_modulated_at_the_rib_rate_has_that_modulation_depth(rate_hz: float) -> None:
    depth = 0.8
    swing = np.sqrt(1.0 + depth * np.cos(2.0 * np.pi * rate_hz * _time(16.0) + 1.0))
    assert metrics.rib_modulation_depth(_noise(16.0, 7) * swing, rate_hz) == pytest.approx(depth, rel=0.1)


@pytest.mark.parametrize("rate_hz", [8.3, 125.0])
def test_ribs_that_keep_their_rate_are_coherent_and_noise_is_not(rate_hz: float) -> None:
    phase = 2.0 * np.pi * rate_hz * _time(16.0)
    noise = _noise(16.0, 10)
    if rate_hz < 25.0:
        steady = noise * np.sqrt(1.0 + 0.9 * np.cos(phase))
    else:
        steady = np.cos(phase) + 0.3 * noise
    assert row_metrics.rib_coherence(steady, rate_hz) > 0.95
    assert row_metrics.rib_coherence(noise, rate_hz) < 0.6
