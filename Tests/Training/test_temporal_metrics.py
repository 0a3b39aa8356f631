"""Temporal metrics on waveforms whose figures are known from theory."""

from __future__ import annotations

import numpy as np
import pytest

from haptoflow_benchmark.metrics import temporal_metrics as metrics
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


def test_a_sine_has_kurtosis_one_and_a_half_and_crest_factor_root_two() -> None:
    wave = np.sin(2.0 * np.pi * 100.0 * _time(4.0) + 0.3)
    assert metrics.kurtosis(wave) == pytest.approx(1.5, abs=0.01)
    assert metrics.crest_factor(wave) == pytest.approx(np.sqrt(2.0), abs=0.01)


def test_one_impulse_in_a_hundred_samples_has_kurtosis_one_hundred_and_crest_ten() -> None:
    wave = np.zeros(20000)
    wave[::100] = np.where(np.arange(200) % 2 == 0, 1.0, -1.0)
    assert metrics.kurtosis(wave) == pytest.approx(100.0, rel=0.01)
    assert metrics.crest_factor(wave) == pytest.approx(10.0, rel=0.01)


def test_silence_has_neither_kurtosis_nor_crest_factor() -> None:
    wave = np.zeros(8000)
    assert metrics.kurtosis(wave) == 0.0 and metrics.crest_factor(wave) == 0.0
    assert metrics.rib_modulation_depth(wave, 20.0) == 0.0 and row_metrics.rib_coherence(wave, 20.0) == 0.0
    assert np.all(np.isfinite(metrics.modulation_spectrum_db(wave)))
    assert metrics.log_ratio(0.0, 3.0) == pytest.approx(np.log(0.01 / 3.0))


def test_the_envelope_is_the_rms_of_five_milliseconds() -> None:
    wave = np.repeat([1.0, -3.0, 2.0], 10)
    np.testing.assert_allclose(metrics.envelope(np.append(wave, [9.0] * 9)), [1.0, 3.0, 2.0])


def test_the_envelope_of_white_noise_varies_by_a_fifth_as_a_chi_distribution_of_ten_does() -> None:
    # sqrt(chi^2_10 / 10): mean 0.9754, standard deviation 0.2206.
    assert metrics.variation(metrics.envelope(_noise(60.0, 2))) == pytest.approx(0.226, abs=0.01)


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


def test_modulated_noise_is_decibels_from_unmodulated_noise_in_both_directions() -> None:
    time = _time(24.0)
    swinging = _noise(24.0, 5) * (1.0 + 0.9 * np.sin(2.0 * np.pi * 5.0 * time))
    there = metrics.modulation_error_db(swinging, _noise(24.0, 6))
    assert there > 1.5 and metrics.modulation_error_db(_noise(24.0, 6), swinging) == pytest.approx(there)


@pytest.mark.parametrize("rate_hz", [8.3, 25.0, 125.0, 417.0])
def test_noise_modulated_at_the_rib_rate_has_that_modulation_depth(rate_hz: float) -> None:
    depth = 0.8
    swing = np.sqrt(1.0 + depth * np.cos(2.0 * np.pi * rate_hz * _time(16.0) + 1.0))
    assert metrics.rib_modulation_depth(_noise(16.0, 7) * swing, rate_hz) == pytest.approx(depth, rel=0.1)


def test_noise_without_ribs_has_nearly_no_modulation_depth() -> None:
    plain = _noise(16.0, 8)
    swinging = _noise(16.0, 9) * np.sqrt(1.0 + np.cos(2.0 * np.pi * 25.0 * _time(16.0)))
    assert metrics.rib_modulation_depth(plain, 25.0) < 0.06
    assert metrics.rib_modulation_error_db(plain, swinging, 25.0) < -20.0
    assert metrics.rib_modulation_error_db(0.1 * swinging, swinging, 25.0) == pytest.approx(0.0, abs=1e-6)


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


def test_a_line_with_random_phase_drift_loses_its_coherence() -> None:
    generator = np.random.default_rng(11)
    drift = np.cumsum(generator.standard_normal(64000)) * np.sqrt(2.0 * np.log(2.0) / 1000.0)
    # Phase variance 2 ln 2 over half a second: exp(-variance / 2) = 0.5 for instants; the window adds its own.
    drifting = np.cos(2.0 * np.pi * 125.0 * _time(32.0) + drift)
    assert 0.2 < row_metrics.rib_coherence(drifting, 125.0) < 0.7


def test_a_line_slightly_off_frequency_keeps_its_coherence() -> None:
    assert row_metrics.rib_coherence(np.cos(2.0 * np.pi * 125.3 * _time(16.0)), 125.0) > 0.98


def test_a_waveform_that_is_too_short_is_refused() -> None:
    with pytest.raises(ValueError, match="second and a half"):
        row_metrics.rib_coherence(_noise(0.9, 1), 50.0)


def test_too_high_a_ratio_counts_like_too_low_a_ratio() -> None:
    assert metrics.folded(1.25) == pytest.approx(0.8) and metrics.folded(0.8) == 0.8 and metrics.folded(0.0) == 0.0
