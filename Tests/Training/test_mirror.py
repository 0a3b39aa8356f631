"""Recordings with the faults of the real data set: each is there, and reading and preparation lose little to it."""

from __future__ import annotations

import dataclasses
import json
from pathlib import Path

import numpy as np
import pytest

from haptoflow_benchmark.cli import main
from haptoflow_benchmark.mirror.comparison import Loss, losses_of, mirror_rows
from haptoflow_benchmark.mirror.faults import ALL_FAULTS, Fault, MachinePass, simulated_pass
from haptoflow_training.cli import main as inspect_main
from haptoflow_training.preprocessing.pipeline import PreparedRecording, preprocess_recording
from haptoflow_training.preprocessing.settings import PreprocessingSettings
from haptoflow_training.recordings.apparatus import plane_powers, x_over_y_db
from haptoflow_training.recordings.cluster_dataset import open_dataset
from haptoflow_training.recordings.dataset_writer import write_recording
from haptoflow_training.recordings.recording import Recording, RecordingIdentity
from haptoflow_training.recordings.synthetic import load_materials

MATERIALS = {material.label: material for material in load_materials()}
CLEAN: frozenset[Fault] = frozenset()


def _pass(label: str = "wood", direction: int = 45, speed: int = 60, force: int = 1000, repeat: int = 0) -> MachinePass:
    identity = RecordingIdentity(MATERIALS[label].texture_id, direction, speed, force, repeat)
    return simulated_pass(MATERIALS[label], identity, seed=1)


def _prepared(recording: Recording) -> PreparedRecording:
    """As a file of the data set is prepared, which has noise."""
    return preprocess_recording(dataclasses.replace(recording, has_sensor_noise=True), PreprocessingSettings())


@pytest.fixture(scope="module")
def one() -> MachinePass:
    return _pass()


@pytest.fixture(scope="module")
def clean(one: MachinePass) -> Recording:
    return one.recorded(CLEAN)


@pytest.fixture(scope="module")
def losses() -> dict[str, Loss]:
    passes = [_pass(direction=direction) for direction in range(0, 360, 90)]
    return losses_of(passes, mirror_rows(), _prepared)


def test_rows_come_at_the_real_rate_and_as_unevenly(one: MachinePass, clean: Recording) -> None:
    steps = np.diff(one.recorded({Fault.UNEVEN_ROWS}).acceleration_time_seconds)
    assert 1.0 / steps.mean() == pytest.approx(8650.0, rel=0.01)
    assert steps.std() / steps.mean() == pytest.approx(0.34, abs=0.01) and steps.min() > 0.0
    assert np.diff(clean.acceleration_time_seconds).std() < 1e-6


def test_the_force_changes_80_times_a_second_and_is_4_per_cent_high(one: MachinePass, clean: Recording) -> None:
    force = one.recorded({Fault.HELD_FORCE}).force_newtons
    assert np.mean(np.diff(force) == 0.0) > 0.99
    assert np.median(force) / np.median(clean.force_newtons) == pytest.approx(1.04, abs=0.005)


def test_acceleration_comes_in_whole_milligravities(one: MachinePass, clean: Recording) -> None:
    stepped = one.recorded({Fault.STEPS_AND_NOISE}).acceleration_g
    np.testing.assert_allclose(1000.0 * stepped, np.round(1000.0 * stepped), atol=1e-6)
    assert np.mean(np.abs(1000.0 * clean.acceleration_g % 1.0) > 1e-6) > 0.5


def test_gravity_pulls_on_the_sensor_s_normal_and_a_little_on_x(one: MachinePass) -> None:
    mean = np.asarray(one.recorded({Fault.GRAVITY}).acceleration_g).mean(axis=0)
    np.testing.assert_allclose(mean, [0.035, 0.0, -0.999], atol=0.01)


def test_steppers_shake_a_sensor_that_rests(one: MachinePass, clean: Recording) -> None:
    rests = clean.acceleration_time_seconds < 0.3
    assert np.asarray(clean.acceleration_g)[rests].std() < 1e-6
    assert np.asarray(one.recorded({Fault.STEPPERS}).acceleration_g)[rests].std() > 5e-4


def test_the_apparatus_makes_the_band_from_54_to_85_hertz_the_strongest_of_x(one: MachinePass) -> None:
    def share(recording: Recording, axis: int) -> float:
        wave = np.asarray(recording.acceleration_g)[:, axis]
        hertz = np.fft.rfftfreq(len(wave), 1.0 / 8650.0)
        power = np.abs(np.fft.rfft(wave - wave.mean())) ** 2
        return float(power[(hertz > 54.0) & (hertz < 85.0)].sum() / power[hertz > 24.0].sum())

    with_it, without = one.recorded({Fault.APPARATUS}), one.recorded(CLEAN)
    assert share(with_it, 0) > 0.6 > 0.5 > share(without, 0) and share(with_it, 1) == share(without, 1)


def test_repeats_of_one_condition_differ_by_1_7_decibels_in_a_band() -> None:
    def bands(each: MachinePass, faults: frozenset[Fault]) -> np.ndarray:
        power = np.abs(np.fft.rfft(_prepared(each.recorded(faults)).waveform_mps2[:2000].astype(np.float64))) ** 2
        edges = np.round(50.0 * 2.0 ** (np.arange(13) / 3.0)).astype(int)
        return np.log10([power[low:high].sum() for low, high in zip(edges, edges[1:], strict=False)])

    gains = [bands(_pass(repeat=n), frozenset([Fault.REPEATS])) - bands(_pass(repeat=n), CLEAN) for n in range(6)]
    differences = [np.abs(one - other).mean() for n, one in enumerate(gains) for other in gains[:n]]
    assert np.mean(differences) == pytest.approx(0.173, rel=0.25)


@pytest.mark.parametrize(
    ("fault", "level_db", "lsd_db", "gfc"),
    [
        (Fault.UNEVEN_ROWS, 0.01, 0.05, 1e-4),
        (Fault.HELD_FORCE, 1e-6, 1e-6, 1e-6),
        (Fault.STEPS_AND_NOISE, 0.1, 0.4, 1e-3),
        (Fault.GRAVITY, 1e-3, 1e-3, 1e-6),
        (Fault.STEPPERS, 0.5, 0.3, 3e-3),
    ],
)
def test_what_preparation_loses_to_one_fault_is_within_its_limits(
    losses: dict[str, Loss], fault: Fault, level_db: float, lsd_db: float, gfc: float
) -> None:
    loss = losses[fault.value]
    assert abs(loss.level_db) <= level_db and loss.lsd_db <= lsd_db and 1.0 - loss.gfc <= gfc
    assert abs(loss.speed) < 0.01


def test_files_of_the_data_set_lose_their_sensor_s_noise(one: MachinePass, clean: Recording, tmp_path: Path) -> None:
    write_recording(tmp_path, one.recorded(ALL_FAULTS))
    read = next(iter(open_dataset(tmp_path))).load()
    prepared = preprocess_recording(read, PreprocessingSettings())
    assert prepared.noise.source == "rest" and prepared.noise.rms_mps2 > 0.03
    np.testing.assert_allclose(prepared.waveform_mps2, _prepared(one.recorded(ALL_FAULTS)).waveform_mps2, atol=1e-4)


def test_the_command_writes_a_row_for_each_fault_and_a_data_set_to_train_on(tmp_path: Path) -> None:
    out, folder = tmp_path / "mirror.json", tmp_path / "mirror"
    words = ["measure-mirror", "--labels", "wood", "--speeds", "60", "--repeats", "1", "--out", str(out)]
    assert main([*words, "--write", str(folder)]) == 0
    table = json.loads(out.read_text(encoding="utf-8"))
    assert list(table["median"]) == list(mirror_rows()) and list(table["labels"]) == ["wood"]
    assert len(list(open_dataset(folder))) == 16 and open_dataset(folder).synthetic


@pytest.mark.parametrize(("faults", "least", "most"), [(CLEAN, -1.5, 1.5), (frozenset([Fault.APPARATUS]), 5.0, 9.0)])
def test_what_the_apparatus_adds_to_one_axis_shows_in_the_sum_of_all_directions(
    faults: frozenset[Fault], least: float, most: float
) -> None:
    passes = [_pass(direction=direction, repeat=repeat) for direction in range(0, 360, 45) for repeat in range(2)]
    powers = [plane_powers(each.recorded(faults)) for each in passes]
    found = x_over_y_db(each for each in powers if each is not None)
    assert found is not None and least < found < most


def test_the_apparatus_is_not_judged_by_passes_in_one_direction(one: MachinePass) -> None:
    found = plane_powers(one.recorded(ALL_FAULTS))
    assert found is not None and x_over_y_db([found]) is None


def test_inspect_says_what_the_apparatus_adds_to_the_files(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for direction in range(0, 360, 90):
        write_recording(tmp_path, _pass(direction=direction).recorded(ALL_FAULTS))
    assert inspect_main(["inspect", str(tmp_path)]) == 0
    assert "apparatus     X over Y by" in capsys.readouterr().out
