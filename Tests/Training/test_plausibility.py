"""Wrong units, glitches and dead sensors are detected before training."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Callable

import numpy as np
import pytest
from dataset_samples import small_recording

from haptoflow_training.errors import InputError
from haptoflow_training.preprocessing.pipeline import preprocess_recording
from haptoflow_training.preprocessing.plausibility import implausible
from haptoflow_training.recordings.recording import Recording
from haptoflow_training.recordings.synthetic import (
    hand_conditions,
    load_materials,
    machine_conditions,
    record_condition_of,
)

HAND, MACHINE = "3_hand_400_1500_0", "0_90_40_500_0"


def changed(name: str, **changes: Callable[[np.ndarray], np.ndarray]) -> Recording:
    recording = small_recording(name, seconds=1.6)
    values = {field: change(np.array(getattr(recording, field))) for field, change in changes.items()}
    return dataclasses.replace(recording, **values)


def frozen(values: np.ndarray) -> np.ndarray:
    values[2000:4000] = values[2000]
    return values


def clipped(values: np.ndarray) -> np.ndarray:
    return np.clip(values, -1.03, -0.97)


def spiked(values: np.ndarray) -> np.ndarray:
    values[700] = 90.0
    return values


def jumping(values: np.ndarray) -> np.ndarray:
    values[80] += 300.0
    return values


BAD = {
    "m/s^2": (HAND, {"acceleration_g": lambda g: 9.80665 * g}, "looks like m/s^2"),
    "mg": (MACHINE, {"acceleration_g": lambda g: 1000.0 * g}, "looks like mg"),
    "frozen accelerometer": (HAND, {"acceleration_g": frozen}, "stays the same for 0.3"),
    "clipped accelerometer": (HAND, {"acceleration_g": clipped}, "is clipped"),
    "millinewtons": (MACHINE, {"force_newtons": lambda newtons: 1000.0 * newtons}, "500 where the name says 0.5"),
    "millinewtons of a hand": (HAND, {"force_newtons": lambda newtons: 1000.0 * newtons}, "expected newtons"),
    "grams": (MACHINE, {"force_newtons": lambda newtons: newtons / 0.00981}, "expected newtons"),
    "kilonewtons": (HAND, {"force_newtons": lambda newtons: 0.001 * newtons}, "kN"),
    "a spike of the force": (HAND, {"force_newtons": spiked}, "a spike of 90"),
    "metres": (MACHINE, {"position_mm": lambda mm: 0.001 * mm}, "expected millimetres"),
    "metres of a hand": (HAND, {"position_mm": lambda mm: 0.001 * mm}, "expected millimetres"),
    "micrometres": (MACHINE, {"position_mm": lambda mm: 1000.0 * mm}, "expected millimetres"),
    "a jump of the tracker": (HAND, {"position_mm": jumping}, "position jumps"),
}


@pytest.mark.parametrize("kind", BAD)
def test_an_implausible_recording_is_refused_with_name_and_expectation(kind: str) -> None:
    name, changes, words = BAD[kind]
    recording = changed(name, **changes)
    with pytest.raises(InputError, match=f"recording {name}: .*{re.escape(words)}"):
        preprocess_recording(recording)


@pytest.mark.parametrize("name", [HAND, MACHINE])
def test_an_ordinary_recording_has_nothing_wrong(name: str) -> None:
    assert list(implausible(small_recording(name, seconds=1.6))) == []


def test_a_high_passed_accelerometer_without_gravity_is_fine() -> None:
    recording = changed(HAND, acceleration_g=lambda g: g - g.mean(axis=0))
    assert list(implausible(recording)) == []


def test_no_synthetic_recording_is_refused_at_any_speed() -> None:
    for material in load_materials()[::9]:
        machine = machine_conditions(
            material, directions=(0, 45), speeds_mmps=(10, 60), forces_millinewtons=(200, 1000), repeats=1
        )
        for identity in machine[:: max(1, len(machine) // 3)]:
            assert list(implausible(record_condition_of(material, identity, seed=5))) == [], identity.name
        for identity in hand_conditions(material, seed=5, recordings=2):
            recording = record_condition_of(material, identity, seed=5, duration_seconds=3.0, guided_share=0.5)
            assert list(implausible(recording)) == [], identity.name
