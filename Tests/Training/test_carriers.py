"""What a device with one carrier plays of the labels: each figure sees the defect that it is for."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from haptoflow_benchmark.carriers.carrier_figures import (
    FRAME_SECONDS,
    WAVE_RATE_HZ,
    CarrierCase,
    case_of,
    distances,
    medians_by_label,
    modulation_left,
    step_delays_ms,
    step_percentiles_db,
    taps_on_noise,
)

_ROW = [(name, "f8") for name in ("seconds", "frequency_hz", "amplitude_mps2", "intensity")]
_SAMPLES = int(FRAME_SECONDS * WAVE_RATE_HZ)


def _frames(wave: NDArray[np.floating], lag: int = 0, smooth: int = 1) -> NDArray[np.void]:
    """RMS of each frame, of `smooth` frames up to it, `lag` frames late."""
    count = len(wave) // _SAMPLES
    power = np.mean(np.square(wave[: count * _SAMPLES].reshape(count, _SAMPLES)), axis=1)
    power = np.convolve(power, np.ones(smooth) / smooth)[:count]
    power = np.concatenate([np.zeros(lag), power])[:count]
    rows = np.zeros(count, dtype=_ROW)
    rows["seconds"] = FRAME_SECONDS * np.arange(count)
    rows["frequency_hz"] = 100.0
    rows["amplitude_mps2"] = np.sqrt(2.0 * power)
    rows["intensity"] = 100.0 * rows["amplitude_mps2"]
    return rows


def _case(label: str, hertz: float) -> CarrierCase:
    return CarrierCase(label, 0.1, 1.0, np.array([hertz, hertz, 2.0 * hertz]), np.array([1.0]))


def test_labels_a_semitone_apart_are_alike_and_an_octave_apart_are_not() -> None:
    found = distances(medians_by_label([_case("a", 100.0), _case("b", 100.0 * 2 ** (1 / 12)), _case("c", 200.0)]))
    assert found.smallest == pytest.approx(1.0) and found.median == pytest.approx(11.0)
    assert found.apart == pytest.approx(2 / 3) and found.alike == (("a", "b"),)


def test_steps_are_counted_in_decibels_and_silence_is_left_out() -> None:
    rows = np.zeros(5, dtype=_ROW)
    rows["amplitude_mps2"] = [0.0, 1.0, 10.0, 1.0, 0.0]
    case = case_of("a", 0.1, 1.0, rows)
    assert case.steps_db.tolist() == pytest.approx([20.0, 20.0])
    assert step_percentiles_db([case]) == pytest.approx((20.0, 20.0))


def test_smoothing_is_seen_as_lost_modulation_a_lower_tap_and_a_late_stop() -> None:
    def smooth(wave: NDArray[np.floating]) -> NDArray[np.void]:
        return _frames(wave, smooth=12)

    assert modulation_left(smooth, 10.0) < 0.7 * modulation_left(_frames, 10.0)
    plain, smoothed = step_delays_ms(_frames, 0.0), step_delays_ms(smooth, 0.0)
    assert smoothed[0] > plain[0] + 20.0


def test_a_lag_is_seen_in_the_delay_of_steps_and_of_taps() -> None:
    def late(wave: NDArray[np.floating]) -> NDArray[np.void]:
        return _frames(wave, lag=2)

    assert step_delays_ms(late, 10.0)[0] > step_delays_ms(_frames, 10.0)[0] + 5.0
    assert np.median(taps_on_noise(late)[:, 1]) > np.median(taps_on_noise(_frames)[:, 1]) + 5.0
