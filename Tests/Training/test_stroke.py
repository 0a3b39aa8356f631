"""Hand-like strokes: the lognormal's shape and distance, way-points, speeds, files."""

from __future__ import annotations

import numpy as np
import pytest

from haptoflow_training.cli import main
from haptoflow_training.strokes.hand_stroke import (
    MAXIMUM_SPEED_MPS,
    force_profile,
    random_planar_stroke,
    scripted_stroke,
)
from haptoflow_training.strokes.sigma_lognormal import Submovement, summed_velocity

WAYPOINTS = [[0.0, 0.05, 0.0], [0.1, 0.0, 0.0], [0.2, 0.0, 0.05], [0.3, 0.05, 0.0]]


def test_a_submovements_speed_integrates_to_its_distance():
    submovement = Submovement.lasting(0.2, 0.6, 0.08, sigma=0.35)
    time = np.linspace(0.0, 3.0, 300_001)
    assert np.trapz(submovement.speed(time), time) == pytest.approx(0.08, rel=1e-6)
    assert submovement.progress(np.array([0.2]))[0] == 0.0
    assert submovement.progress(np.array([0.8]))[0] == pytest.approx(0.9998, abs=5e-5)


def test_a_submovement_s_speed_has_one_skewed_peak():
    submovement = Submovement.lasting(0.0, 0.6, 0.08)
    time = np.linspace(0.0, 1.0, 2001)
    speed = submovement.speed(time)
    peak = int(np.argmax(speed))
    assert np.all(np.diff(speed[: peak + 1]) >= 0) and np.all(np.diff(speed[peak:]) <= 0)
    assert time[peak] == pytest.approx(np.exp(submovement.mu - submovement.sigma**2), abs=1e-3)
    half = np.flatnonzero(speed > 0.5 * speed[peak])
    assert time[half[-1]] - time[peak] > 1.1 * (time[peak] - time[half[0]])


def test_a_turning_submovement_ends_at_its_end_angle():
    submovement = Submovement.lasting(0.0, 0.5, 0.1, start_angle=0.0, end_angle=np.pi / 2)
    velocity = submovement.velocity(np.array([0.06, 0.45]))
    headings = np.arctan2(velocity[:, 1], velocity[:, 0])
    assert headings[0] == pytest.approx(0.0, abs=0.05)
    assert headings[1] == pytest.approx(np.pi / 2, abs=0.05)


def test_overlapping_submovements_add_as_vectors():
    time = np.linspace(0.0, 2.0, 4001)
    there = Submovement.lasting(0.0, 0.8, 0.1)
    back = Submovement.lasting(0.3, 0.8, 0.1, start_angle=np.pi, end_angle=np.pi)
    travelled = np.trapz(summed_velocity([there, back], time), time, axis=0)
    assert np.allclose(travelled, 0.0, atol=1e-4)


@pytest.mark.parametrize("median", [0.02, 0.2, 0.9])
def test_a_random_stroke_has_the_median_speed_asked_for_and_stays_within_what_hands_do(median):
    stroke = random_planar_stroke(
        np.random.default_rng(4),
        duration_seconds=10.0,
        rate_hz=1000.0,
        median_speed_mps=median,
        extent_metres=0.3,
    )
    speed = stroke.speed_mps
    assert np.median(speed[speed > 0.05 * median]) == pytest.approx(median, rel=0.1)
    assert speed.max() <= MAXIMUM_SPEED_MPS
    assert speed[0] == 0.0 and speed[-1] == 0.0
    assert np.percentile(speed, 95) > 1.4 * median
    assert np.ptp(stroke.position_metres, axis=0).max() < 1.0


def test_a_random_strokes_velocity_is_the_derivative_of_its_position():
    stroke = random_planar_stroke(
        np.random.default_rng(5),
        duration_seconds=4.0,
        rate_hz=1000.0,
        median_speed_mps=0.3,
        extent_metres=0.3,
    )
    difference = np.diff(stroke.position_metres, axis=0) * 1000.0
    assert np.allclose(difference, stroke.velocity_mps[:-1], atol=1e-9)


def test_a_random_stroke_is_not_sinusoidal():
    stroke = random_planar_stroke(
        np.random.default_rng(6),
        duration_seconds=16.0,
        rate_hz=500.0,
        median_speed_mps=0.3,
        extent_metres=0.3,
    )
    power = np.abs(np.fft.rfft(stroke.velocity_mps[:, 0] * np.hanning(len(stroke.velocity_mps)))) ** 2
    assert np.sort(power)[-3:].sum() < 0.5 * power.sum()


def test_force_varies_within_its_limits_around_the_median():
    force = force_profile(
        np.random.default_rng(8), duration_seconds=8.0, rate_hz=1000.0, median_force_newtons=1.0,
        speed_mps=np.full(8000, 0.1),
    )  # fmt: skip
    assert len(force) == 8000
    assert np.median(force) == pytest.approx(1.0, rel=0.05)
    assert force.min() >= 0.1 and force.max() <= 5.0
    assert np.std(np.log(force)) > 0.08


def test_a_scripted_stroke_starts_and_ends_at_its_waypoints_and_rounds_the_others_without_stopping():
    stroke = scripted_stroke(WAYPOINTS, segment_seconds=0.5, rate_hz=240.0, seed=2, tremor_metres=0.0)
    assert np.allclose(stroke.position_metres[0], WAYPOINTS[0])
    assert np.allclose(stroke.position_metres[-1], WAYPOINTS[-1], atol=2e-4)
    speed = np.linalg.norm(np.diff(stroke.position_metres, axis=0), axis=1) * 240.0
    moving = speed[int(0.25 * 240) : int(1.05 * 240)]
    assert moving.min() > 0.05 * moving.max()
    for waypoint in WAYPOINTS[1:-1]:
        assert np.min(np.linalg.norm(stroke.position_metres - waypoint, axis=1)) < 0.03


def test_smoothing_takes_the_movements_out_of_waypoints_that_draw_a_curve():
    angles = np.linspace(0.0, np.pi, 60)
    curve = [[0.05 * np.cos(angle), 0.0, 0.05 * np.sin(angle)] for angle in angles]

    def swing(smoothing_seconds):
        stroke = scripted_stroke(
            curve, segment_seconds=0.016, tremor_metres=0.0, smoothing_seconds=smoothing_seconds
        )
        speed = np.linalg.norm(np.diff(stroke.position_metres, axis=0), axis=1)[25:-25]
        return speed.std() / speed.mean()

    assert swing(0.0) > 0.2
    assert swing(0.02) < 0.03


def test_a_repeated_waypoint_is_a_pause_and_force_follows_its_waypoints():
    stroke = scripted_stroke(
        [[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.1, 0.0, 0.0]],
        segment_seconds=[0.5, 1.0],
        tremor_metres=0.0,
        force_newtons=[0.5, 2.0, 2.0],
    )
    still = stroke.position_metres[stroke.time_seconds > 0.9]
    assert np.ptp(still[:, 0]) < 1e-4
    assert stroke.force_newtons[0] == 0.5
    assert stroke.force_newtons[-1] == pytest.approx(2.0, abs=1e-3)


def test_tremor_lies_between_8_and_12_hz_and_has_the_size_asked_for():
    stroke = scripted_stroke(
        [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0]], segment_seconds=20.0, rate_hz=120.0, seed=1, tremor_metres=1e-4
    )
    assert np.std(stroke.position_metres[:, 1]) == pytest.approx(1e-4, rel=0.3)
    power = np.abs(np.fft.rfft(stroke.position_metres[:, 1])) ** 2
    frequency = np.fft.rfftfreq(len(stroke.time_seconds), 1 / 120.0)
    assert power[(frequency > 6) & (frequency < 14)].sum() > 0.85 * power[1:].sum()


@pytest.mark.parametrize(
    "change",
    [{"waypoints_metres": [[0, 0, 0]]}, {"segment_seconds": 0.0}, {"rate_hz": 1.0}, {"force_newtons": [1.0]}],
)
def test_an_impossible_script_is_refused(change):
    words = {"waypoints_metres": WAYPOINTS, "segment_seconds": 0.5} | change
    with pytest.raises(ValueError):
        scripted_stroke(words.pop("waypoints_metres"), **words)


def _script(folder, text):
    path = folder / "stroke.toml"
    path.write_text(text)
    return path


def test_the_stroke_command_writes_the_same_file_twice_and_another_for_another_seed(tmp_path):
    script = _script(
        tmp_path,
        "waypoints_metres = [[0, 0.1, 0], [0.2, 0, 0.1]]\nsegment_seconds = 1.0\n"
        "force_newtons = [0.0, 1.0]\nseed = 3\n",
    )
    for name, extra in (("a", []), ("b", []), ("c", ["--seed", "4"])):
        assert main(["stroke", "--script", str(script), "--out", str(tmp_path / name), *extra]) == 0
    first = (tmp_path / "a").read_bytes()
    assert first == (tmp_path / "b").read_bytes()
    assert first != (tmp_path / "c").read_bytes()
    assert first.startswith(b"t,x,y,z,force\n")
    table = np.loadtxt(tmp_path / "a", delimiter=",", skiprows=1)
    assert table.shape == (121, 5)
    assert np.allclose(np.diff(table[:, 0]), 1 / 120, atol=1e-6)


def test_the_stroke_command_names_the_key_that_is_wrong(tmp_path, capsys):
    script = _script(tmp_path, "waypoints_metres = [[0, 0, 0], [1, 0, 0]]\nseconds = 1.0\n")
    assert main(["stroke", "--script", str(script), "--out", str(tmp_path / "o.csv")]) == 3
    assert "seconds" in capsys.readouterr().err
    assert not (tmp_path / "o.csv").exists()
