"""Metrics of the evaluation on waveforms whose figures are known."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from haptoflow_benchmark import waveform_metrics
from haptoflow_paper.report import row_metrics, temporal_metrics
from haptoflow_paper.report.cell_figures import measure_cell
from haptoflow_paper.report.told_apart import logistic_regression, told_apart_percent
from haptoflow_paper.rows.reference_conditions import Condition, is_on_other_label
from haptoflow_paper.rows.reference_set import ReferencePair

RATE_HZ = 2000


def _noise(seconds: float, seed: int) -> np.ndarray:
    return np.random.default_rng(seed).standard_normal(int(seconds * RATE_HZ))


def _tone(frequency_hz: float, seconds: float) -> np.ndarray:
    return np.sqrt(2.0) * np.sin(2.0 * np.pi * frequency_hz * np.arange(int(seconds * RATE_HZ)) / RATE_HZ)


def test_a_waveform_has_perfect_figures_against_itself() -> None:
    wave = _noise(4.0, 1)
    assert waveform_metrics.gfc_recording(wave, wave) == pytest.approx(1.0)
    assert row_metrics.gfc_segment(wave, wave) == pytest.approx(1.0)
    assert row_metrics.relative_rmse(wave, wave) == 0.0
    assert waveform_metrics.level_error_db(wave, wave) == 0.0
    assert waveform_metrics.log_spectral_distance_db(wave, wave) == 0.0
    assert np.abs(row_metrics.critical_band_errors_db(wave, wave)).max() == 0.0


def test_half_the_amplitude_is_minus_six_decibels_and_leaves_gfc_unchanged() -> None:
    wave = _noise(4.0, 1)
    assert waveform_metrics.level_error_db(0.5 * wave, wave) == pytest.approx(-6.02, abs=0.01)
    assert waveform_metrics.log_spectral_distance_db(0.5 * wave, wave) == pytest.approx(6.02, abs=0.01)
    np.testing.assert_allclose(row_metrics.critical_band_errors_db(0.5 * wave, wave), -6.02, atol=0.01)
    assert waveform_metrics.gfc_recording(0.5 * wave, wave) == pytest.approx(1.0)


def test_rmse_favours_silence_over_an_independent_draw_and_segment_gfc_penalises_correct_randomness() -> None:
    wave, draw = _noise(8.0, 1), _noise(8.0, 2)
    assert row_metrics.relative_rmse(np.zeros_like(wave), wave) == pytest.approx(1.0, abs=0.01)
    assert row_metrics.relative_rmse(draw, wave) == pytest.approx(np.sqrt(2.0), abs=0.03)
    assert row_metrics.gfc_segment(draw, wave) < 0.85
    assert waveform_metrics.gfc_recording(draw, wave) > 0.98


def test_a_band_that_a_recording_lacks_is_compared_with_the_floor_and_not_with_its_numbers_last_digits() -> None:
    tone = _tone(100.0, 8.0)
    # 7 bins of 126 hold the tone and its window; the rest is noise of 0.1 over the floor: 20 dB.
    distance = waveform_metrics.log_spectral_distance_db(tone + 0.1 * _noise(8.0, 4), tone)
    assert distance == pytest.approx(20.0, abs=1.0)


def test_the_fundamental_is_found_between_bins() -> None:
    wave = _tone(123.4, 4.0) + 0.3 * _noise(4.0, 3)
    assert row_metrics.fundamental_hz(wave, 120.0) == pytest.approx(123.4, rel=0.002)


def test_a_step_at_every_hop_shows_in_the_jump_ratio() -> None:
    wave, hops = _noise(4.0, 1), np.arange(0, 8000, 28)
    assert row_metrics.hop_jump_ratio(wave, hops) == pytest.approx(1.0, abs=0.1)
    stepped = wave + 3.0 * (np.arange(8000) // 28 % 2)
    assert row_metrics.hop_jump_ratio(stepped, hops) > 2.0


def _time(seconds: float) -> np.ndarray:
    return np.arange(int(seconds * RATE_HZ)) / RATE_HZ


def test_a_modulation_of_the_envelope_shows_only_in_its_band_with_its_power() -> None:
    time = _time(20.0)
    carrier = np.where(np.arange(len(time)) % 2 == 0, 1.0, -1.0)
    bands = temporal_metrics.modulation_spectrum_db(carrier * (1.0 + 0.5 * np.sin(2.0 * np.pi * 20.0 * time)))
    at = temporal_metrics.MODULATION_EDGES_HZ.index(16.0)
    # 0.5^2 / 2 of the squared mean, a little less for the average over a frame.
    assert bands[at] == pytest.approx(10.0 * np.log10(0.125), abs=0.3)
    assert np.delete(bands, at).max() < bands[at] - 25.0


def test_the_modulation_spectrum_is_independent_of_level_and_two_draws_of_noise_agree_within_a_decibel() -> None:
    first, second = _noise(24.0, 3), _noise(24.0, 4)
    np.testing.assert_allclose(temporal_metrics.modulation_spectrum_db(7.0 * first), temporal_metrics.modulation_spectrum_db(first))
    assert temporal_metrics.modulation_error_db(first, second) < 1.0


@pytest.mark.parametrize("rate_hz", [8.3, 25.0, 125.0, 417.0])
def test_noise_modulated_at_the_rib_rate_has_that_modulation_depth(rate_hz: float) -> None:
    depth = 0.8
    swing = np.sqrt(1.0 + depth * np.cos(2.0 * np.pi * rate_hz * _time(16.0) + 1.0))
    assert temporal_metrics.rib_modulation_depth(_noise(16.0, 7) * swing, rate_hz) == pytest.approx(depth, rel=0.1)


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


_SAMPLES = 24000
_NOTHING = np.zeros(0, dtype=np.float32)
_STARTS = np.arange(0, _SAMPLES, 28)


def _cell_figures_noise(seed: int) -> NDArray[np.float32]:
    return np.random.default_rng(seed).standard_normal(_SAMPLES).astype(np.float32)


def _pair(recorded: NDArray[np.float32], kind: str = "constant", **more: Any) -> ReferencePair:
    motion = np.zeros((_SAMPLES, 3), dtype=np.float32)
    condition = Condition("a", 0, kind, 0.1, 1.0, 0.0, 12.0, 1, **more)
    return ReferencePair(condition, recorded, recorded, motion)


def _ribbed(depth: float, rate_hz: float, seed: int, drift: float = 0.0) -> NDArray[np.float32]:
    time = np.arange(_SAMPLES) / 2000.0
    wander = drift * np.cumsum(np.random.default_rng(seed + 1).standard_normal(_SAMPLES)) / np.sqrt(1000.0)
    line = np.cos(2 * np.pi * rate_hz * time + wander)
    return (_cell_figures_noise(seed) * np.sqrt(1.0 + depth * line) + 0.5 * line).astype(np.float32)


def test_gaussian_noise_in_place_of_impacts_lacks_crest_and_kurtosis_but_has_the_right_level() -> None:
    recorded = _cell_figures_noise(1)
    recorded[::400] *= 25.0
    made = _cell_figures_noise(2) * recorded.std()
    cell = measure_cell(_pair(recorded), made, _NOTHING, _STARTS)
    assert abs(cell["level_error_db"]) < 0.3 and cell["recorded_kurtosis"] > 20.0
    assert cell["crest_error_db"] < -5.0 and cell["kurtosis_log_ratio"] < -1.5
    assert cell["envelope_kurtosis_log_ratio"] < -1.0 and cell["envelope_variation_log_ratio"] < -0.5


def test_faint_and_drifting_ribs_are_detected_as_such() -> None:
    pair = _pair(_ribbed(0.9, 50.0, 3), rib_rates_hz=(50.0,))
    good = measure_cell(pair, _ribbed(0.9, 50.0, 5), _NOTHING, _STARTS)
    faint = measure_cell(pair, _ribbed(0.2, 50.0, 5), _NOTHING, _STARTS)
    drifting = measure_cell(pair, _ribbed(0.9, 50.0, 5, drift=3.0), _NOTHING, _STARTS)
    assert abs(good["rib_modulation_error_db"]) < 1.0 and good["rib_coherence"] > 0.95
    assert faint["rib_modulation_error_db"] < -6.0
    assert drifting["rib_coherence"] < 0.5 and good["f0_error_percent"] < 0.2


def test_a_change_of_label_is_judged_near_the_changes_only_and_in_each_direction() -> None:
    elsewhere = is_on_other_label(_SAMPLES)
    levels = np.where(elsewhere, 4.0, 1.0).astype(np.float32)
    pair = _pair(_cell_figures_noise(1) * levels, "change", other_label="b", other_index=1)
    right = measure_cell(pair, _cell_figures_noise(2) * levels, _NOTHING, _STARTS)
    assert abs(right["change_level_error_db"]) < 0.7 and abs(right["change_crest_error_db"]) < 0.7
    assert "level_error_db" not in right and "told_apart_percent" not in right
    # A generator that keeps the old label for 100 ms is detected in both directions.
    late = np.roll(levels, 200)
    assert abs(measure_cell(pair, _cell_figures_noise(2) * late, _NOTHING, _STARTS)["change_level_error_db"]) > 3.0
    away = (np.arange(_SAMPLES) % 1000 > 300) & (np.arange(_SAMPLES) % 1000 < 800)
    loud = _cell_figures_noise(2) * levels * np.where(away, 9.0, 1.0).astype(np.float32)
    assert abs(measure_cell(pair, loud, _NOTHING, _STARTS)["change_level_error_db"]) < 0.7


_TOLD_APART_SAMPLES = 24400


def _wave(seed: int, level: float, impacts: float = 0.0) -> NDArray[np.float32]:
    generator = np.random.default_rng(seed)
    wave = np.convolve(generator.standard_normal(_TOLD_APART_SAMPLES), np.hanning(7), mode="same")
    wave += impacts * np.where(generator.random(_TOLD_APART_SAMPLES) < 0.001, generator.choice([-1.0, 1.0], _TOLD_APART_SAMPLES), 0.0)
    return (level * wave).astype(np.float32)


def _pairs(label: str, kind: str = "constant", impacts: float = 0.0) -> list[ReferencePair]:
    motion = np.zeros((_TOLD_APART_SAMPLES, 3), dtype=np.float32)
    pairs = []
    for number in range(12):
        condition = Condition(label, 0, kind, 0.1 + 0.05 * number, 1.0, 0.0, 12.0, number)
        recorded, again = (_wave(100 * repeat + number, 1.0 + 0.3 * number, impacts) for repeat in (1, 2))
        pairs.append(ReferencePair(condition, recorded, again, motion))
    return pairs


def _mean(values: list[float | None]) -> float:
    return float(np.mean([value for value in values if value is not None]))


def test_another_draw_of_the_same_process_is_told_apart_only_by_chance() -> None:
    pairs = _pairs("stone", impacts=30.0)
    found = told_apart_percent(pairs, [pair.independent for pair in pairs])
    assert len(found) == 12 and 35.0 < _mean(found) < 62.0


def test_gaussian_noise_of_the_right_spectrum_is_told_from_rare_impacts() -> None:
    pairs = _pairs("stone", impacts=60.0)
    made = [
        (pair.recorded.std() / np.std(_wave(n, 1.0)) * _wave(7000 + n, 1.0)).astype(np.float32)
        for n, pair in enumerate(pairs)
    ]
    assert _mean(told_apart_percent(pairs, made)) > 85.0


def test_no_motion_is_used_for_both_fitting_and_testing() -> None:
    # Every motion has its own pitch. Memorised, each would identify its render; from other motions, none does.
    generator = np.random.default_rng(3)
    time = np.arange(_TOLD_APART_SAMPLES) / 2000.0
    motion = np.zeros((_TOLD_APART_SAMPLES, 3), dtype=np.float32)
    pairs, made = [], []
    for number in range(12):
        pitches = generator.uniform(50.0, 900.0, size=2)
        tones = [(np.sin(2 * np.pi * pitch * time) + 0.1 * generator.standard_normal(_TOLD_APART_SAMPLES)) for pitch in pitches]
        condition = Condition("a", 0, "constant", 0.1, 1.0, 0.0, 12.0, number)
        pairs.append(ReferencePair(condition, tones[0].astype(np.float32), tones[0].astype(np.float32), motion))
        made.append(tones[1].astype(np.float32))
    assert _mean(told_apart_percent(pairs, made)) < 75.0


def test_the_regression_recovers_the_weights_that_made_the_classes() -> None:
    generator = np.random.default_rng(5)
    given = generator.standard_normal((40000, 3))
    truth = np.array([1.0, -2.0, 0.0])
    sides = (generator.random(40000) < 1.0 / (1.0 + np.exp(-(given @ truth + 0.5)))).astype(np.float64)
    assert logistic_regression(given, sides) == pytest.approx([1.0, -2.0, 0.0, 0.5], abs=0.06)
