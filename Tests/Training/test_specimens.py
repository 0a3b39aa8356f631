"""Several specimens of a label: different random surfaces, the same label; one is held out of training."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.recordings.recording import RecordingIdentity
from haptoflow_training.recordings.synthetic import (
    HELD_OUT_SPECIMEN,
    TRAINING_SPECIMENS,
    hand_conditions,
    load_materials,
    machine_conditions,
    record_condition,
    record_hand_condition,
    record_machine_condition,
    training_specimen,
)
from haptoflow_training.recordings.synthetic.contact import SIMULATION_RATE_HZ
from haptoflow_training.recordings.synthetic.features import impact_acceleration, rib_wander_turns, ruling_height
from haptoflow_training.recordings.synthetic.materials import Material, Ruling
from haptoflow_training.recordings.synthetic.surface import TipPath, random_height
from haptoflow_training.training.config import load_config

MATERIALS = {material.label: material for material in load_materials()}
CONFIGURATIONS = Path(__file__).parents[2] / "Training" / "configs"


def _path(speed_mmps: float = 200.0, seconds: float = 2.0, degrees: float = 20.0) -> TipPath:
    angle = np.radians(degrees)
    velocity = np.tile(speed_mmps * np.array([np.cos(angle), np.sin(angle)]), (int(seconds * SIMULATION_RATE_HZ), 1))
    return TipPath(np.cumsum(velocity, axis=0) / SIMULATION_RATE_HZ, velocity)


def _ribs(material: Material, ruling: Ruling, number: int, *, specimen: int) -> NDArray[np.float64]:
    wander = rib_wander_turns(material, ruling, number, _path(), specimen=specimen)
    return ruling_height(material, ruling, number, _path(), wander)


def test_another_specimen_has_another_random_surface_and_other_asperities() -> None:
    heights = [random_height(MATERIALS["stone"], _path(), specimen=each)[0] for each in (0, 1, HELD_OUT_SPECIMEN)]
    assert np.abs(np.corrcoef(np.diff(heights, axis=1))[np.triu_indices(3, 1)]).max() < 0.15
    impulses = [impact_acceleration(MATERIALS["stone"], _path(), SIMULATION_RATE_HZ, specimen=each) for each in (0, 4)]
    struck = [each != np.median(each) for each in impulses]
    assert np.mean(struck[0][struck[1]]) < 0.1


def test_specimens_have_their_ribs_at_the_same_places_but_for_the_jitter() -> None:
    for label in ("corduroy", "metal mesh", "jute"):
        material = MATERIALS[label]
        for number, ruling in enumerate(material.rulings):
            machined = replace(ruling, jitter=0.0)
            one, other = (_ribs(material, machined, number, specimen=each) for each in (0, 4))
            assert np.array_equal(one, other)
            one, other = (_ribs(material, ruling, number, specimen=each) for each in (0, 4))
            assert not np.array_equal(one, other)


def test_the_phase_of_ribs_is_the_wave_vector_times_the_recorded_position_on_every_specimen() -> None:
    """The first harmonic of the vibration has one phase relative to the position, wherever a stroke begins."""
    turns = []
    for seed, specimen in enumerate((0, 0, 3, 3, HELD_OUT_SPECIMEN, HELD_OUT_SPECIMEN)):
        recording = record_condition(
            MATERIALS["corduroy"],
            velocity_mps=(0.15, 0.0),
            force_newtons=1.0,
            duration_seconds=2.0,
            seed=seed,
            specimen=specimen,
            accelerometer_noise=False,
            motion_noise=False,
        )
        time = recording.acceleration_time_seconds
        settled = (time > 0.3) & (time < 1.9)
        across = np.interp(time, recording.position_time_seconds, recording.position_mm[:, 0]) / 2.5
        normal = recording.acceleration_g[settled, 2] - recording.acceleration_g[settled, 2].mean()
        line = np.mean(normal * np.exp(-2j * np.pi * across[settled]))
        turns.append(line / np.abs(line))
    assert np.abs(np.angle(np.array(turns) / np.mean(turns))).max() < 0.3, np.angle(turns)


def test_a_stroke_or_pass_on_a_chosen_specimen_follows_the_same_motion_over_another_surface() -> None:
    stroke = hand_conditions(MATERIALS["wood"], seed=1, recordings=3)[1]
    usual, chosen = (
        record_hand_condition(MATERIALS["wood"], stroke, seed=1, duration_seconds=2.0, specimen=each)
        for each in (None, HELD_OUT_SPECIMEN)
    )
    assert np.array_equal(usual.position_mm, chosen.position_mm)
    assert not np.array_equal(usual.acceleration_g, chosen.acceleration_g)
    passes = [
        record_machine_condition(MATERIALS["wood"], RecordingIdentity(0, 0, 60, 500, 0), seed=1, specimen=each)
        for each in (None, HELD_OUT_SPECIMEN)
    ]
    assert [each.specimen for each in passes] == [training_specimen(passes[0].identity), HELD_OUT_SPECIMEN]


def test_every_specimen_has_guided_and_free_strokes_slow_and_fast_ones_and_every_condition_of_a_pass() -> None:
    identities = hand_conditions(MATERIALS["wood"], seed=1, recordings=60)
    for share in (0.25, 0.5, 0.85):
        for guided in (True, False):
            met = {
                training_specimen(each)
                for each in identities
                if (int((each.repeat + 1) * share) > int(each.repeat * share)) == guided
            }
            assert met == set(TRAINING_SPECIMENS)
    for specimen in TRAINING_SPECIMENS:
        speeds = [each.speed_mmps for each in identities if training_specimen(each) == specimen]
        assert min(speeds) < 12 and max(speeds) > 400
    passes = machine_conditions(MATERIALS["wood"])
    data = load_config(CONFIGURATIONS / "default" / "standard.toml").data
    used = machine_conditions(
        MATERIALS["wood"],
        directions=data.machine_directions,
        speeds_mmps=data.machine_speeds_mmps,
        forces_millinewtons=data.machine_forces_millinewtons,
        repeats=data.machine_repeats,
    )
    for specimen in TRAINING_SPECIMENS:
        own = [each for each in passes if training_specimen(each) == specimen]
        assert len({each.direction_degrees for each in own}) == 8
        assert {each.speed_mmps for each in own} == {20, 30, 40, 50, 60}
        of_default = [each for each in used if training_specimen(each) == specimen]
        assert len({each.direction_degrees for each in of_default}) >= 5
        assert {each.speed_mmps for each in of_default} == {10, 20, 60}
        assert {each.force_millinewtons for each in of_default} == {500, 1000}
    for one, other in zip(passes[::2], passes[1::2], strict=True):
        assert one.repeat != other.repeat and training_specimen(one) != training_specimen(other)
