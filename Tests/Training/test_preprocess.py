from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from dataset_samples import small_recording

from haptoflow_training.errors import InputError
from haptoflow_training.preprocessing import signals
from haptoflow_training.preprocessing.pipeline import PreparedRecording, pad_recording, preprocess_recording
from haptoflow_training.recordings.recording import STANDARD_GRAVITY_MPS2, Recording


def tone_recording(hertz: float, amplitude_g: float = 0.5, seconds: float = 2.0) -> Recording:
    """A tone on X, gravity on Z, sampled at its true, irregular time stamps."""
    recording = small_recording(seconds=seconds)
    time = recording.acceleration_time_seconds
    tone = amplitude_g * np.sin(2 * np.pi * hertz * time)
    acceleration = np.column_stack([tone, np.zeros_like(tone), np.full_like(tone, -1.0)])
    return replace(recording, acceleration_g=acceleration)


@pytest.mark.parametrize("hertz", [40.0, 150.0, 400.0])
def test_a_tone_keeps_its_frequency_and_amplitude_in_metres_per_second_squared(hertz: float) -> None:
    prepared = preprocess_recording(tone_recording(hertz))
    time = 0.0005 * np.arange(len(prepared.waveform_mps2))
    basis = np.column_stack([np.sin(2 * np.pi * hertz * time), np.cos(2 * np.pi * hertz * time)])
    weights, residual, *_ = np.linalg.lstsq(basis, prepared.waveform_mps2.astype(np.float64), rcond=None)
    assert np.hypot(*weights) == pytest.approx(0.5 * STANDARD_GRAVITY_MPS2, rel=0.02)
    assert residual[0] / np.sum(prepared.waveform_mps2**2) < 1e-3


def test_the_waveform_is_aligned_with_the_true_time_stamps() -> None:
    recording = tone_recording(100.0)
    prepared = preprocess_recording(recording)
    start = max(recording.acceleration_time_seconds[0], 0.0) + 0.3
    time = start + 0.0005 * np.arange(len(prepared.waveform_mps2))
    expected = 0.5 * STANDARD_GRAVITY_MPS2 * np.sin(2 * np.pi * 100.0 * time)
    assert np.abs(prepared.waveform_mps2 - expected)[100:-100].max() < 0.05 * expected.max()


@pytest.mark.parametrize("hertz", [1100.0, 1300.0])
def test_a_tone_above_the_band_leaves_less_than_half_a_percent(hertz: float) -> None:
    prepared = preprocess_recording(tone_recording(hertz))
    assert np.sqrt(2 * np.mean(prepared.waveform_mps2**2)) < 0.005 * 0.5 * STANDARD_GRAVITY_MPS2


def test_decimation_is_flat_to_950_hz_6_db_down_at_nyquist_and_60_db_above_1050_hz() -> None:
    time = np.arange(16000) / 8000.0

    def gain_db(hertz: float) -> float:
        out = signals.decimate(np.sin(2 * np.pi * hertz * time), 8000, 2000)
        assert len(out) == 4000
        return float(20 * np.log10(np.sqrt(2 * np.mean(out[400:-400] ** 2)) + 1e-12))

    assert max(abs(gain_db(hertz)) for hertz in (20.0, 300.0, 700.0, 900.0, 945.0)) < 0.05
    assert gain_db(999.0) == pytest.approx(-6.0, abs=1.0)
    assert gain_db(1055.0) < -60.0
    assert gain_db(1301.0) < -60.0


def test_the_motion_of_a_straight_pass_is_its_speed_along_its_direction() -> None:
    prepared = preprocess_recording(small_recording("0_45_40_1000_0", seconds=2.0))
    steady = prepared.motion[200:-200]
    np.testing.assert_allclose(steady[:, :2], 0.04 / np.sqrt(2), atol=0.0015)
    np.testing.assert_allclose(steady[:, 2], 1.0, atol=0.01)


def test_velocity_follows_a_hand_at_3_hertz_within_2_percent() -> None:
    time = np.arange(400) / 100.0
    position = np.column_stack([60.0 * np.sin(2 * np.pi * 3 * time), np.zeros(400)])
    grid = np.arange(1000, 7000) / 2000.0
    found = signals.velocity_mps(time, position, grid, 0.09)[:, 0]
    true = 0.06 * 2 * np.pi * 3 * np.cos(2 * np.pi * 3 * grid)
    assert np.abs(found - true).max() < 0.02 * true.max()


def test_force_steps_of_a_load_cell_are_smoothed_without_delay_and_never_negative() -> None:
    time = np.arange(6000) / 6000.0
    held = np.floor(time * 80) / 80
    grid = np.arange(2000) / 2000.0
    found = signals.force_newtons(time, held, grid, 50.0)
    np.testing.assert_allclose(found[200:-200], grid[200:-200] - 0.5 / 80, atol=0.002)
    assert signals.force_newtons(time, -held, grid, 50.0).min() >= 0.0


def _broken(recording: Recording, how: str) -> Recording:
    time = recording.acceleration_time_seconds.copy()
    acceleration = np.array(recording.acceleration_g)
    if how == "time":
        time[500] = time[499]
        return replace(recording, acceleration_time_seconds=time)
    if how == "nan":
        acceleration[7, 1] = np.nan
        return replace(recording, acceleration_g=acceleration)
    if how == "gap":
        keep = (time < 0.8) | (time > 0.9)
        return replace(recording, acceleration_time_seconds=time[keep], acceleration_g=acceleration[keep])
    if how == "apart":
        return replace(recording, force_time_seconds=recording.force_time_seconds + 100.0)
    return small_recording(seconds=0.15)


@pytest.mark.parametrize(
    ("how", "words"),
    [
        ("time", "acceleration time stops rising after sample 499"),
        ("nan", "not finite"),
        ("gap", "acceleration misses 0.1"),
        ("apart", "three sensors of the same pass"),
        ("short", "left after trimming"),
    ],
)
def test_a_recording_that_cannot_be_prepared_is_refused_by_name(how: str, words: str) -> None:
    with pytest.raises(InputError, match=f"0_90_40_500_0.*{words}"):
        preprocess_recording(_broken(small_recording(), how))


def _loud(samples: int = 2000) -> PreparedRecording:
    moving = np.tile(np.array([0.04, 0.03, 0.5], dtype=np.float32), (samples, 1))
    place = np.linspace([1.0, 2.0], [1.0 + 0.02 * samples, 2.0 + 0.015 * samples], samples, dtype=np.float32)
    wander = np.linspace([0.1, -0.1, 3.0], [0.2, 0.1, 90.0], samples)
    return PreparedRecording(np.ones(samples, dtype=np.float32), moving, place, wander)


def test_padding_puts_whole_silent_segments_before_and_after_with_the_probability_asked_for() -> None:
    padded = [pad_recording(_loud(), f"0_90_40_500_{number}", 1) for number in range(1000)]
    before, after = (np.array([entry[place] for entry in padded]) for place in (1, 2))
    for found in (before, after):
        assert set(found) == {0, 200, 400, 600}
        assert (found > 0).mean() == pytest.approx(0.3, abs=0.05)
    assert (before != after).any()


def test_padding_is_silent_without_velocity_and_fades_into_the_recording_in_10_ms() -> None:
    forces = set()
    velocity_fade = (0.5 - 0.5 * np.cos(np.pi * (np.arange(20) + 0.5) / 20))[:, None] * [0.04, 0.03]
    every = (pad_recording(_loud(), f"0_90_40_500_{number}", 1) for number in range(1000))
    for padded, front, back in (one for one in every if one[1] and one[2]):
        wave, moving = padded.waveform_mps2, padded.motion
        assert len(wave) == len(moving) == 2000 + front + back
        wander = padded.wander_turns
        np.testing.assert_array_equal(wander[: front + 1], np.tile(_loud().wander_turns[0], (front + 1, 1)))
        np.testing.assert_array_equal(wander[-back - 1 :], np.tile(_loud().wander_turns[-1], (back + 1, 1)))
        silent = np.r_[0:front, len(wave) - back : len(wave)]
        assert not np.any(wave[silent]) and not np.any(moving[silent, :2])
        assert np.all(np.diff(wave[front : front + 20]) > 0) and np.all(wave[front + 20 : -back - 20] == 1.0)
        assert np.abs(np.diff(wave)).max() < 0.09
        np.testing.assert_allclose(moving[front : front + 20, :2], velocity_fade, atol=1e-6)
        forces.add((round(float(moving[0, 2]), 3), round(float(moving[front - 1, 2]), 3)))
    assert forces == {(0.5, 0.5), (0.0, 0.5), (0.0, 0.0)}
