"""The noise of an own recording's accelerometer is found at rest and removed before training."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from own_samples import csv_one_axis, stroke

from haptoflow_training.commands import inspect
from haptoflow_training.errors import InputError
from haptoflow_training.preprocessing.pipeline import PreparedRecording, preprocess_parts, preprocess_recording
from haptoflow_training.preprocessing.settings import SETTINGS
from haptoflow_training.recordings.dataset_inspection import inspect_dataset
from haptoflow_training.recordings.open_recordings import open_recordings
from haptoflow_training.recordings.recording import Recording
from haptoflow_training.recordings.synthetic import load_materials, record_condition

MATERIALS = {material.label: material for material in load_materials()}
SECONDS_EACH = 12.0
SPEEDS_MPS = (0.0, 0.005, 0.01, 0.03, 0.1, 0.3)


def _recorded(label: str, *, noise: bool, speeds: tuple[float, ...] = SPEEDS_MPS, motion_noise: bool = True) -> Recording:
    """Back and forth every half second, each speed for as long."""
    count = int(1000 * SECONDS_EACH)
    back_and_forth = np.where(np.arange(count) // 500 % 2 == 0, 1.0, -1.0)
    velocity = np.concatenate([speed * back_and_forth for speed in speeds])
    return record_condition(
        MATERIALS[label], velocity_mps=(velocity, 0.0), force_newtons=1.0, duration_seconds=SECONDS_EACH * len(speeds),
        seed=3, accelerometer_noise=noise, motion_noise=motion_noise,
    )  # fmt: skip


def _prepared(recording: Recording, *, removes_noise: bool) -> PreparedRecording:
    return preprocess_recording(replace(recording, has_sensor_noise=removes_noise))


def _steps(wave: NDArray[np.float32]) -> list[NDArray[np.float64]]:
    """The wave at each speed, without the ends."""
    start = round(2000 * SETTINGS.trim_seconds)
    ends = [(round(2000 * SECONDS_EACH * k) - start, round(2000 * SECONDS_EACH * (k + 1)) - start) for k in range(6)]
    return [wave[max(first, 0) + 1000 : last - 1000].astype(np.float64) for first, last in ends]


def test_slow_strokes_get_the_level_of_a_recording_without_noise() -> None:
    clean = _prepared(_recorded("wood", noise=False), removes_noise=False)
    removed = _prepared(_recorded("wood", noise=True), removes_noise=True)
    assert removed.noise.source == "rest" and 0.02 < removed.noise.rms_mps2 < 0.06
    steps = zip(SPEEDS_MPS, *(_steps(each.waveform_mps2) for each in (clean, removed)), strict=True)
    for speed, truth, after in list(steps)[1:]:
        assert abs(10.0 * np.log10(np.mean(after**2) / np.mean(truth**2))) < (1.0 if speed < 0.02 else 0.1)


def test_all_stretches_between_gaps_lose_the_noise_that_one_shows() -> None:
    noisy = replace(_recorded("wood", noise=True, speeds=(0.0, 0.005, 0.1)), has_sensor_noise=True)
    time = noisy.acceleration_time_seconds
    kept = (time < 11.0) | (time > 13.0)
    gapped = replace(noisy, acceleration_time_seconds=time[kept], acceleration_g=noisy.acceleration_g[kept])
    first, second = preprocess_parts(gapped)
    assert first.noise == second.noise and first.noise.source == "rest"
    whole = preprocess_recording(noisy)
    slow = slice(1000, 18_000)
    assert np.std(second.waveform_mps2[slow]) == pytest.approx(np.std(whole.waveform_mps2[26_400:][slow]), rel=0.15)


def test_a_recording_of_nothing_but_noise_is_refused_by_name() -> None:
    silent = replace(_recorded("wood", noise=True, speeds=(0.0,)), has_sensor_noise=True)
    moving = _recorded("wood", noise=True, speeds=(0.1,))
    half = len(silent.position_mm) // 2
    path = silent.position_mm[half] + moving.position_mm[half:] - moving.position_mm[half]
    position = np.concatenate([silent.position_mm[:half], path])
    with pytest.raises(InputError, match=r"recording .*: the acceleration is no stronger where the tip slides"):
        preprocess_recording(replace(silent, position_mm=position))


def _noisy_file(folder: Path) -> None:
    made = stroke(12.0)
    rest = made.time_seconds < 1.5
    made.velocity_mps[rest] = 0.0
    made.acceleration_mps2[rest] = 0.0
    made.acceleration_mps2[:] += 0.04 * np.random.default_rng(2).standard_normal(len(rest))
    csv_one_axis(folder, "one", "denim", made)


def test_inspect_says_what_training_will_remove(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    _noisy_file(tmp_path)
    report = inspect_dataset(open_recordings(tmp_path))
    assert report["sensor_noise"]["from"] == {"rest": 1}
    low, middle, high = report["sensor_noise"]["mps2"]
    # The sensor's 2 kHz become the 1 kHz that are learnt.
    assert low == middle == high == pytest.approx(0.04 / np.sqrt(2.0), rel=0.1)
    assert inspect.run(argparse.Namespace(folder=tmp_path, labels=None, json=False)) == 0
    assert f"sensor noise  {low:.2g} to {high:.2g} m/s^2 RMS" in capsys.readouterr().out


def test_only_recordings_with_a_motion_of_their_own_are_asked_for_their_noise(tmp_path: Path) -> None:
    loaded: Callable[[], Recording] = next(iter(open_recordings(_constant_speed(tmp_path)))).load
    assert not loaded().has_sensor_noise
    _noisy_file(tmp_path / "moving")
    assert next(iter(open_recordings(tmp_path / "moving"))).load().has_sensor_noise


def _constant_speed(folder: Path) -> Path:
    made = stroke(4.0)
    (folder / "constant").mkdir()
    rows = np.column_stack([made.time_seconds, made.acceleration_mps2])
    path = folder / "constant" / "one.csv"
    np.savetxt(path, rows, fmt="%.7g", delimiter=",", header="time_s,acceleration_mps2", comments="")
    path.with_suffix(".json").write_text('{"label": "denim", "speed_mps": 0.1, "force_newtons": 1}', encoding="utf-8")
    return folder / "constant"
