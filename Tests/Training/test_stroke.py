"""Hand-like strokes: the lognormal's shape and distance, way-points, speeds, files."""

from __future__ import annotations

import numpy as np
import pytest

from haptoflow_training.cli import main
from haptoflow_training.hand_stroke import MAXIMUM_SPEED_MPS, Submovement, random_planar_stroke, scripted_stroke

WAYPOINTS = [[0.0, 0.05, 0.0], [0.1, 0.0, 0.0], [0.2, 0.0, 0.05], [0.3, 0.05, 0.0]]


def test_a_submovements_speed_integrates_to_its_distance():
    submovement = Submovement.lasting(0.2, 0.6, 0.08, sigma=0.35)
    time = np.linspace(0.0, 3.0, 300_001)
    assert np.trapz(submovement.speed(time), time) == pytest.approx(0.08, rel=1e-6)
    assert submovement.progress(np.array([0.2]))[0] == 0.0
    assert submovement.progress(np.array([0.8]))[0] == pytest.approx(0.9998, abs=5e-5)


@pytest.mark.parametrize("median", [0.02, 0.2, 0.9])
def test_a_random_stroke_has_the_median_speed_asked_for_and_stays_within_what_hands_do(median):
    stroke = random_planar_stroke(
        np.random.default_rng(4), duration_seconds=10.0, rate_hz=1000.0, median_speed_mps=median, extent_metres=0.3
    )
    speed = stroke.speed_mps
    assert np.median(speed[speed > 0.05 * median]) == pytest.approx(median, rel=0.1)
    assert speed.max() <= MAXIMUM_SPEED_MPS
    assert speed[0] == 0.0 and speed[-1] == 0.0
    assert np.percentile(speed, 95) > 1.4 * median
    assert np.ptp(stroke.position_metres, axis=0).max() < 1.0


def test_a_random_strokes_velocity_is_the_derivative_of_its_position():
    stroke = random_planar_stroke(
        np.random.default_rng(5), duration_seconds=4.0, rate_hz=1000.0, median_speed_mps=0.3, extent_metres=0.3
    )
    difference = np.diff(stroke.position_metres, axis=0) * 1000.0
    assert np.allclose(difference, stroke.velocity_mps[:-1], atol=1e-9)


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
        stroke = scripted_stroke(curve, segment_seconds=0.016, tremor_metres=0.0, smoothing_seconds=smoothing_seconds)
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


@pytest.mark.parametrize(
    "change", [{"waypoints_metres": [[0, 0, 0]]}, {"segment_seconds": 0.0}, {"rate_hz": 1.0}, {"force_newtons": [1.0]}]
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
