from __future__ import annotations

from collections import Counter
from dataclasses import replace

import numpy as np
import pytest

from haptoflow_training.preprocessing.settings import PreprocessingSettings
from haptoflow_training.preprocessing.split import split_of
from haptoflow_training.recordings.recording import RecordingIdentity

SETTINGS = PreprocessingSettings()


def machine_grid(texture_id: int) -> list[RecordingIdentity]:
    return [
        RecordingIdentity(texture_id, direction, speed, force, repeat)
        for direction in range(0, 360, 45)
        for speed in (20, 30, 40, 50, 60)
        for force in (500, 1000)
        for repeat in (0, 1)
    ]


def hand_strokes(texture_id: int, count: int) -> list[RecordingIdentity]:
    generator = np.random.default_rng(texture_id)
    speeds, forces = generator.integers(15, 900, count), generator.integers(150, 3500, count)
    return [RecordingIdentity(texture_id, None, int(speeds[n]), int(forces[n]), n) for n in range(count)]


@pytest.mark.parametrize("texture_id", range(0, 118, 13))
def test_every_texture_is_split_70_10_20_on_the_machine(texture_id: int) -> None:
    found = Counter(split_of(identity, SETTINGS, 7) for identity in machine_grid(texture_id))
    assert found["train"] == pytest.approx(112, abs=4)
    assert found["validation"] == pytest.approx(16, abs=4)
    assert found["test"] == pytest.approx(32, abs=4)


@pytest.mark.parametrize("texture_id", range(0, 118, 13))
def test_a_few_hand_strokes_of_a_texture_reach_all_three_splits(texture_id: int) -> None:
    found = Counter(split_of(identity, SETTINGS, 7) for identity in hand_strokes(texture_id, 24))
    assert found["train"] == pytest.approx(17, abs=3)
    assert found["validation"] >= 1
    assert found["test"] == pytest.approx(5, abs=3)


def test_repeats_of_one_machine_pass_share_a_split_because_they_share_its_bumps() -> None:
    for texture_id in range(20):
        for identity in machine_grid(texture_id):
            twin = replace(identity, repeat=1 - identity.repeat)
            assert split_of(identity, SETTINGS, 7) == split_of(twin, SETTINGS, 7)


def test_the_split_of_a_name_never_changes_between_releases() -> None:
    names = ["0_0_20_500_0", "5_135_40_1000_1", "81_315_60_500_0", "3_hand_400_1500_3", "3_hand_400_1500_4"]
    found = [split_of(RecordingIdentity.parse(name), SETTINGS, 0) for name in names]
    assert found == ["train", "test", "test", "train", "test"]


def test_a_held_out_direction_and_speed_are_for_testing_only() -> None:
    settings = replace(SETTINGS, held_out_directions=(135,), held_out_speeds_mmps=(50,))
    for identity in machine_grid(5):
        held_out = identity.direction_degrees == 135 or identity.speed_mmps == 50
        expected = "test" if held_out else split_of(identity, SETTINGS, 7)
        assert split_of(identity, settings, 7) == expected
