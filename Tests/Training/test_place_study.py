"""The study of places: its measures, on waves whose answer is known."""

from __future__ import annotations

import numpy as np
import pytest

from haptoflow_paper.place.creeping import holds
from haptoflow_paper.place.hand_overs import HOP_SAMPLES, hand_overs
from haptoflow_paper.place.likeness import Profile, bumps, found_again, likeness, over_place
from haptoflow_paper.place.passes import Pass, Rounds, Table
from haptoflow_paper.place.place_report import page_words
from haptoflow_paper.place.place_study import RULED, second_passes, summary


def _surface(places_metres: np.ndarray, seed: int = 3) -> np.ndarray:
    """Heights that vary over half a millimetre and more."""
    rng = np.random.default_rng(seed)
    waves = rng.uniform(100.0, 2000.0, 40), rng.uniform(0.0, 2.0 * np.pi, 40)
    return np.sin(2.0 * np.pi * places_metres[:, None] * waves[0] + waves[1]).sum(axis=1)


def _felt(stroke: Pass, delay_seconds: float = 0.0, seed: int = 3) -> Profile:
    times = np.arange(0.0, abs(stroke.end_metres - stroke.start_metres) / stroke.speed_mps, 1.0 / 2000.0)
    places = stroke.start_metres + stroke.direction * stroke.speed_mps * (times - delay_seconds)
    return over_place(_surface(places, seed), stroke)


@pytest.mark.parametrize(
    "stroke",
    [Pass(), Pass().begun_earlier(0.00173), Pass(-0.01, 0.068, 0.12), Pass(-0.02, 0.075, 0.2), Pass(-0.005, 0.06, 0.05),
     Pass(0.065, -0.01)],
)  # fmt: skip
def test_any_pass_over_one_place_is_alike_and_in_its_place(stroke: Pass) -> None:
    found = likeness(_felt(Pass()), _felt(stroke), 0.002, 0.052)
    assert found.correlation > 0.97
    assert abs(found.shift_metres) <= 2.5e-5


@pytest.mark.parametrize("earlier_metres", [0.00051, 0.00173, 0.002475])
def test_a_pass_begun_a_part_of_a_sample_earlier_is_alike_up_to_800_hz(earlier_metres: float) -> None:
    rng = np.random.default_rng(5)
    frequencies_hz, turns = rng.uniform(100.0, 800.0, 40), rng.uniform(0.0, 2.0 * np.pi, 40)

    def felt(stroke: Pass) -> Profile:
        seconds = stroke.start_metres / stroke.speed_mps + np.arange(1600) / 2000.0
        return over_place(np.sin(2.0 * np.pi * seconds[:, None] * frequencies_hz + turns).sum(axis=1), stroke)

    assert likeness(felt(Pass()), felt(Pass().begun_earlier(earlier_metres)), 0.002, 0.052).correlation > 0.99


def test_a_late_vibration_is_shifted_and_not_unlike() -> None:
    found = likeness(_felt(Pass()), _felt(Pass(), delay_seconds=0.005), 0.002, 0.052)
    assert found.correlation > 0.97
    assert found.shift_metres == pytest.approx(5e-4, abs=5e-5)
    assert found.unshifted < 0.5


def test_another_surface_is_unlike() -> None:
    assert likeness(_felt(Pass()), _felt(Pass(), seed=4), 0.002, 0.052).correlation < 0.5


def test_outsized_asperities_are_found_where_they_are() -> None:
    rng = np.random.default_rng(1)
    first = over_place(rng.standard_normal(4000), Pass(0.0, 0.2))
    first.values[[8000, 24000]] = 12.0
    second = over_place(rng.standard_normal(4000), Pass(0.0, 0.2))
    second.values[8080] = 10.0
    places = bumps(first, 0.0, 0.19)
    assert places == pytest.approx([0.05, 0.15])
    assert found_again(places, second, 0.0, 0.19) == 1


def test_points_on_a_turned_table_are_the_same_points_of_the_table() -> None:
    table = Table("wood", position_metres=(0.3, 0.2, -0.4), turn_degrees=35.0)
    _, along, beside = Rounds().points()
    world = table.to_world(along, beside)
    angle = np.radians(35.0)
    local = world - np.array([0.3, 0.2, -0.4])
    assert local[:, 0] * np.cos(angle) - local[:, 2] * np.sin(angle) == pytest.approx(along)
    assert local[:, 0] * np.sin(angle) + local[:, 2] * np.cos(angle) == pytest.approx(beside)


class _Bursts:
    """A renderer of noise that is 3 dB louder for 5 ms of every hop."""

    def wave(self, table: Table, stroke: Pass, seed: int = 1) -> np.ndarray:
        wave = np.random.default_rng(1).standard_normal(40_000)
        wave[np.arange(len(wave)) % HOP_SAMPLES < 10] *= np.sqrt(2.0)
        return wave


def test_a_burst_at_every_hand_over_is_seen() -> None:
    found = hand_overs(_Bursts(), "wood")
    # 2 over the mean of ten samples at 2 and eighteen at 1.
    assert found["burst"] == pytest.approx(10.0 * np.log10(2.0 / (38.0 / 28.0)), abs=0.3)
    assert found["swing"] > 2.5
    assert found["burst_chance"] < 0.4


def test_a_held_pen_is_found_and_a_moving_one_is_not() -> None:
    times = np.arange(0.0, 1.0, 0.01)
    tremor = 2e-4 * np.stack([np.sin(60.0 * times), np.cos(50.0 * times)], axis=1)
    held = np.column_stack([times, tremor + 0.1, np.zeros_like(times)])
    moving = np.column_stack([times, 0.1 * times, np.zeros_like(times), np.zeros_like(times)])
    found = holds({"held": held, "moving": moving})
    assert len(found) == 1
    assert found[0].diameter_metres == pytest.approx(5.5e-4, rel=0.2)
    assert found[0].times[-1] >= 5.0
    assert np.all(np.diff(found[0].times) > 0.0)


def test_the_page_says_met_and_missed() -> None:
    figures = {"correlation": 0.62, "unshifted": 0.6, "shift_mm": 0.01}
    chance = {"correlation": 0.1, "unshifted": 0.0, "shift_mm": 0.4}
    names = [*second_passes(), "second round of a circle"]
    by_label = {
        label: {name: chance if name in ("1 mm beside", "another object") else figures for name in names}
        | ({"bumps": {"bumps": 10, "again": 4, "by_chance": 1}} if label == "stone" else {})
        for label in ("wood", "stone", *RULED)
    }
    assert summary(by_label, "backwards")["median"] == pytest.approx(0.62)
    creeping = {"wood": {"now": {"2": {"peak_mps2": 0.1, "kurtosis": 3.0}}, "recorder": {"2": {"peak_mps2": 0.0, "kurtosis": 0.0}}}}
    words = page_words(
        {"model_sha256": "ab", "likeness": {"now": by_label}, "creeping": creeping,
         "hand_overs": {"wood": [{"swing": 2.0, "chance": 0.6, "burst": 0.4, "burst_chance": 0.2}]},
         "held": [{"diameter_mm": 0.7, "peak_mps2": 0.0}, {"diameter_mm": 1.4, "peak_mps2": 0.2}]}
    )  # fmt: skip
    assert "| same direction and speed | 0.62 (0.62 to 0.62) | 0.97: missed |" in words
    assert "| backwards | 0.62 (0.62 to 0.62) | 0.68: missed |" in words
    assert "| 1 mm beside | 0.10 (0.10 to 0.10) | chance: met |" in words
    assert "next pass has 4 within a millimetre" in words
    assert "1 are exactly silent" in words and "heard are 1.40 mm (goal missed)" in words
