"""The synthetic recorder's physics and protocols, and its determinism."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from haptoflow_training.preprocessing.pipeline import preprocess_recording
from haptoflow_training.recordings.recording import STANDARD_GRAVITY_MPS2, RecordingIdentity
from haptoflow_training.recordings.synthetic import (
    hand_conditions, load_materials, machine_conditions, record_condition, record_condition_of
)
from haptoflow_training.recordings.synthetic.contact import SIMULATION_RATE_HZ
from haptoflow_training.recordings.synthetic.surface import TipPath, random_height

MATERIALS = {material.label: material for material in load_materials()}


def _vibration(label, *, velocity=(0.1, 0.0), force=1.0, seconds=1.0, seed=1, noise=False, material=None):
    recording = record_condition(
        material or MATERIALS[label],
        velocity_mps=velocity,
        force_newtons=force,
        duration_seconds=seconds,
        seed=seed,
        accelerometer_noise=noise,
        motion_noise=noise,
    )
    settled = recording.acceleration_g[int(0.15 * len(recording.acceleration_g)) :]
    return (settled - settled.mean(axis=0)) * STANDARD_GRAVITY_MPS2, recording


def _rms(values):
    return float(np.sqrt(np.mean(np.sum(values**2, axis=1))))


def _uniform_spectrum(recording, axis=2):
    time = recording.acceleration_time_seconds
    grid = np.arange(time[0] + 0.2, time[-1], 1 / 4000.0)
    values = np.interp(grid, time, recording.acceleration_g[:, axis])
    power = np.abs(np.fft.rfft((values - values.mean()) * np.hanning(len(values)))) ** 2
    return np.fft.rfftfreq(len(values), 1 / 4000.0), power


def _straight(start_mm, heading, speed_mmps, count):
    velocity = np.tile(speed_mmps * np.array([np.cos(heading), np.sin(heading)]), (count, 1))
    time = np.arange(count) / SIMULATION_RATE_HZ
    return TipPath(np.asarray(start_mm) + velocity * time[:, None], velocity)


def test_the_same_spot_has_the_same_height_at_another_speed_and_on_the_way_back():
    wood = MATERIALS["wood"]
    slow = random_height(wood, _straight([3.0, 4.0], 0.3, 100.0, 4001), specimen=1)[0]
    fast = random_height(wood, _straight([3.0, 4.0], 0.3, 200.0, 2001), specimen=1)[0]
    end = np.array([3.0, 4.0]) + 50.0 * np.array([np.cos(0.3), np.sin(0.3)])
    back = random_height(wood, _straight(end, 0.3 + np.pi, 100.0, 4001), specimen=1)[0]
    assert np.allclose(back[::-1], slow, atol=1e-6)
    # At another speed only the octaves that fade in and out differ.
    assert np.corrcoef(np.diff(slow[::2]), np.diff(fast))[0, 1] > 0.9


def test_a_resting_tip_does_not_vibrate_on_any_material():
    for label in MATERIALS:
        vibration, _ = _vibration(label, velocity=(0.0, 0.0), seconds=0.5)
        assert _rms(vibration) < 1e-9, label


@pytest.mark.parametrize("label", ["glass", "corduroy", "sandpaper", "rubber"])
def test_level_grows_with_speed_and_everything_stays_within_the_sensors_range(label):
    levels = []
    for speed in (0.03, 0.1, 0.4, 1.5):
        vibration, recording = _vibration(label, velocity=(speed * 0.8, speed * 0.6))
        levels.append(_rms(vibration))
        assert np.all(np.isfinite(recording.acceleration_g))
        assert np.max(np.abs(recording.acceleration_g)) <= 16.0
    assert np.all(np.diff(levels) > 0.0)
    assert levels[-1] < 80.0


@pytest.mark.parametrize(("label", "wavelength_mm"), [("corduroy", 2.5), ("metal mesh", 1.2)])
@pytest.mark.parametrize("speed", [0.1, 0.2])
def test_a_ruled_surface_vibrates_at_speed_over_wavelength(label, wavelength_mm, speed):
    _, recording = _vibration(label, velocity=(speed, 0.01 * speed), seconds=2.0)
    frequency, power = _uniform_spectrum(recording)
    expected = 1e3 * speed / wavelength_mm
    near = (frequency > 0.6 * expected) & (frequency < 1.5 * expected)
    assert frequency[near][np.argmax(power[near])] == pytest.approx(expected, rel=0.03)
    assert power[near].max() > 20 * np.median(power[near])


def test_wood_is_smoother_along_its_grain():
    along = np.mean([_rms(_vibration("wood", velocity=(0.1, 0.0), seed=seed)[0]) for seed in range(3)])
    across = np.mean([_rms(_vibration("wood", velocity=(0.0, 0.1), seed=seed)[0]) for seed in range(3)])
    assert along < 0.85 * across


def test_impacts_give_concrete_heavier_tails_than_the_same_surface_without_them():
    def kurtosis(material):
        normal = np.concatenate(
            [_vibration("concrete", material=material, seconds=2.0, seed=seed)[0][:, 2] for seed in range(3)]
        )
        return np.mean(normal**4) / np.var(normal) ** 2

    concrete = MATERIALS["concrete"]
    assert kurtosis(concrete) > 4.0
    assert kurtosis(replace(concrete, impact_strength=0.0)) < 3.7


def _prepared_wave(label, *, material=None, speed=0.03, seconds=6.0, seeds=range(6), accelerometer_noise=False):
    waves = []
    for seed in seeds:
        heading = 0.2 + seed
        recording = record_condition(
            material or MATERIALS[label],
            velocity_mps=(speed * np.cos(heading), speed * np.sin(heading)),
            force_newtons=1.0,
            duration_seconds=seconds,
            seed=seed,
            accelerometer_noise=accelerometer_noise,
        )
        waves.append(preprocess_recording(recording).waveform_mps2.astype(float))
    return np.concatenate(waves)


@pytest.mark.parametrize("label", ["stone", "sandpaper"])
def test_asperities_that_mostly_push_up_skew_the_vibration_of_rough_stone_upwards(label):
    def skewness(material):
        wave = _prepared_wave(label, material=material)
        return np.mean((wave - wave.mean()) ** 3) / np.std(wave) ** 3

    rough = MATERIALS[label]
    assert rough.impact_upward_share == 0.85
    assert skewness(rough) > 0.05
    assert skewness(replace(rough, impact_upward_share=0.15)) < -0.05


def test_without_the_accelerometer_s_noise_rest_is_digital_silence_and_the_other_sensors_stay_as_they_are():
    clean, noisy = (
        record_condition(
            MATERIALS["wood"], velocity_mps=(0.0, 0.0), force_newtons=1.0, duration_seconds=2.0, seed=4,
            accelerometer_noise=noise,
        )
        for noise in (False, True)
    )  # fmt: skip
    assert np.all(clean.vibration_g == 0.0) and np.any(noisy.vibration_g != 0.0)
    for name in ("acceleration_time_seconds", "force_time_seconds", "force_newtons", "position_mm"):
        assert np.array_equal(getattr(clean, name), getattr(noisy, name))
    assert not np.any(preprocess_recording(clean).waveform_mps2)


def test_stick_slip_vibrates_along_the_movement_and_vanishes_at_speed():
    rubber = MATERIALS["rubber"]
    calm = replace(rubber, stick_slip_strength=0.0)

    def added(speed):
        slips = _vibration("rubber", velocity=(speed, 0.0), seconds=2.0)[0]
        none = _vibration("rubber", material=calm, velocity=(speed, 0.0), seconds=2.0)[0]
        return np.std(slips - none, axis=0), np.std(none, axis=0)

    slipping, base = added(0.08)
    assert slipping[0] > 0.15 * base[0]
    assert slipping[2] < 1e-9
    assert added(0.6)[0][0] < 0.01 * added(0.6)[1][0]


def test_the_sensors_are_those_of_the_published_machine():
    _, recording = _vibration("plastic", velocity=(0.0, 0.0), seconds=3.0, noise=True)
    steps = np.diff(recording.acceleration_time_seconds)
    assert steps.min() >= 129e-6 and steps.max() <= 211e-6 and np.std(steps) > 5e-6
    assert np.allclose(recording.acceleration_g * 1000, np.round(recording.acceleration_g * 1000), atol=1e-6)
    assert recording.acceleration_g[:, 2].mean() == pytest.approx(-1.0, abs=2e-3)
    noise = np.std(recording.acceleration_g, axis=0)
    bandwidth = 0.5 / np.mean(steps)
    assert np.allclose(noise, 75e-6 * np.sqrt(bandwidth), rtol=0.05)
    assert np.allclose(np.diff(recording.position_time_seconds), 0.01)
    assert np.allclose(np.diff(recording.force_time_seconds), 1 / 6000)
    assert np.max(np.abs(recording.force_newtons - 1.0)) <= 0.06
    changes = np.count_nonzero(np.diff(recording.force_newtons))
    assert 1 < changes < 80 * 3


def test_a_machine_pass_rests_at_both_ends_and_moves_as_its_name_says():
    identity = RecordingIdentity(0, 45, 40, 500, 1)
    recording = record_condition_of(MATERIALS["wood"], identity, seed=5)
    velocity = np.diff(recording.position_mm, axis=0) * 100.0
    speed = np.hypot(*velocity.T)
    assert np.all(speed[:25] == 0.0) and np.all(speed[-25:] == 0.0)
    assert np.median(speed) == pytest.approx(40.0, abs=1.0)
    travelled = recording.position_mm[-1] - recording.position_mm[0]
    assert np.hypot(*travelled) == pytest.approx(90.0, abs=0.5)
    assert np.degrees(np.arctan2(-travelled[1], travelled[0])) == pytest.approx(45.0, abs=0.5)
    assert recording.force_newtons.mean() == pytest.approx(0.5, abs=0.1)


def test_the_frame_s_vibration_is_present_at_rest_and_stronger_in_motion():
    recording = record_condition_of(MATERIALS["glass"], RecordingIdentity(6, 0, 60, 500, 0), seed=5)
    time = recording.acceleration_time_seconds
    still, moving = (recording.acceleration_g[(time > low) & (time < low + 0.3)] for low in (0.0, 0.8))

    def low_over_high(values):
        power = np.sum(np.abs(np.fft.rfft(values - values.mean(axis=0), axis=0)) ** 2, axis=1)
        return power[3:40].mean() / power[len(power) // 2 :].mean()

    assert low_over_high(still) > 1.5
    assert low_over_high(moving) > 2.0 * low_over_high(still)


def _same(one, other):
    return all(
        np.array_equal(getattr(one, name), getattr(other, name))
        for name in (
            "acceleration_time_seconds",
            "acceleration_g",
            "force_time_seconds",
            "force_newtons",
            "position_time_seconds",
            "position_mm",
        )
    )


def _strokes(*labels):
    return {
        identity: record_condition_of(MATERIALS[label], identity, seed=9, duration_seconds=2.0)
        for label in labels
        for identity in hand_conditions(MATERIALS[label], seed=9, recordings=2)
    }


def _passes(seed, forces_millinewtons):
    stone = MATERIALS["stone"]
    identities = machine_conditions(
        stone, directions=[90], speeds_mmps=[60], forces_millinewtons=forces_millinewtons, repeats=2
    )
    return [record_condition_of(stone, identity, seed=seed) for identity in identities]


def test_recordings_are_the_same_bytes_again_in_any_order_and_subset():
    everything, backwards = _strokes("wood", "stone"), _strokes("stone")
    assert len(everything) == 4 and len(backwards) == 2
    for identity, recording in backwards.items():
        assert _same(recording, everything[identity])
    first, again = _passes(9, [500, 1000]), _passes(9, [1000])
    assert _same(first[2], again[0]) and _same(first[3], again[1])
    assert not _same(first[2], first[3])
    assert not _same(_passes(10, [500])[0], first[0])


def test_a_trajectory_of_arrays_is_followed():
    recording = record_condition(
        MATERIALS["paper"],
        velocity_mps=(np.array([0.0, 0.2, 0.0]), 0.0),
        force_newtons=np.array([0.5, 1.5]),
        duration_seconds=1.0,
        seed=3,
        accelerometer_noise=False,
        motion_noise=False,
    )
    assert np.ptp(recording.position_mm[:, 0]) == pytest.approx(100.0, abs=1.0)
    assert recording.force_newtons[0] == pytest.approx(0.5)
    assert recording.force_newtons[-1] == pytest.approx(1.5, abs=0.01)
    with pytest.raises(ValueError):
        record_condition(
            MATERIALS["paper"], velocity_mps=(np.nan, 0.0), force_newtons=1.0, duration_seconds=1.0, seed=3
        )
