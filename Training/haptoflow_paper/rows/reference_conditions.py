"""The grid of conditions on which every row is measured: motions, labels and durations.

0.275 m/s, 1.35 N and the direction of 225 degrees lie inside the held-out bands of training. Directions are
counter-clockwise from the surface's first axis, as the velocities (vx, vy) themselves.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from haptoflow_paper.report.temporal_metrics import rib_rates_hz
from haptoflow_training.recordings.synthetic import Material, hand_conditions
from haptoflow_training.recordings.synthetic.carriers import hand_ride

# Speeds in m/s with the duration of a recording in seconds. At low speed, few asperities are struck a second.
_SECONDS_AT = {0.01: 24.0, 0.03: 24.0, 0.08: 20.0, 0.15: 16.0, 0.275: 16.0, 0.5: 12.0, 1.0: 12.0, 1.5: 12.0}
CONSTANT_SPEEDS_MPS = tuple(_SECONDS_AT)
# A kurtosis of 40 comes from a dozen impacts a minute, so rare impacts need long recordings.
_IMPACT_FACTOR, _MAXIMUM_RARE_IMPACT_SPEED_MPS = 2.5, 0.15
_FORCES_NEWTONS = (0.2, 0.6, 1.35, 3.0)
_CORNERS = ((0.03, 3.0), (0.15, 0.2), (0.5, 3.0))
_DIRECTIONS_DEGREES = (0.0, 225.0, 110.0, 315.0)
CROSSINGS_DEGREES = (15.0, 30.0, 45.0, 60.0)
_CROSSED_SPEEDS_MPS = (0.03, 0.15, 0.5)
_REVERSAL_SPEEDS_MPS = (0.08, 0.4)
_NAP_SPEEDS_MPS = (0.08, 0.3)
_STOP_SPEED_MPS = _CHANGE_SPEED_MPS = 0.15
_SECONDS = 12.0
_HAND_SECONDS = 16.0
_REVERSAL_PERIOD_SECONDS, _TURN_SECONDS = 2.0, 0.1
_SLIDE_SECONDS, _REST_SECONDS, _RAMP_SECONDS = 1.0, 0.5, 0.08
CHANGE_SECONDS = 0.5
# The index distance to the other label of a change, which belongs to another category.
_CHANGE_STEP = 7
_MOTION_RATE_HZ = 2000
_HAND_SEED = 4003
_SEED = 9000

STEADY_KINDS = ("constant", "oblique", "nap")


@dataclass(frozen=True)
class Condition:
    """kind: `constant`, `oblique` (ribs crossed at crossing_degrees), `nap` (along or against it), `reversal` (a
    straight stroke that turns back every second), `stop` (slides of a second, rests of half a second), `varying` (a
    free hand), or `change` (label and other_label alternate every half second). speed_mps and force_newtons: 0 for a
    hand. rib_rates_hz: the rate of ribs of each family whose rate a waveform can show, the dominant family first."""

    label: str
    label_index: int
    kind: str
    speed_mps: float
    force_newtons: float
    direction_degrees: float
    seconds: float
    seed: int
    crossing_degrees: float = 0.0
    rib_rates_hz: tuple[float, ...] = ()
    other_label: str = ""
    other_index: int = -1

    @property
    def is_steady(self) -> bool:
        """Whether speed, direction and force are constant, so that all variation comes from the surface."""
        return self.kind in STEADY_KINDS


def conditions(materials: tuple[Material, ...]) -> list[Condition]:
    """The conditions of every label; ruled labels and those with a nap have additional ones."""
    return [entry for index, material in enumerate(materials) for entry in _of_label(materials, index, material)]


def _of_label(materials: tuple[Material, ...], index: int, material: Material) -> Iterator[Condition]:
    seed = _SEED
    for kind, speed, force, direction, crossing, seconds in _steady(index, material):
        rates = rib_rates_hz(material, speed, direction)
        yield Condition(material.label, index, kind, speed, force, direction, seconds, seed, crossing, rates)
        seed += 1
    across = material.dominant_ruling.direction_degrees if material.dominant_ruling else 110.0
    for speed in _REVERSAL_SPEEDS_MPS:
        yield Condition(
            material.label, index, "reversal", speed, 1.0, across, _long_enough(material, speed, _SECONDS), seed
        )
        seed += 1
    yield Condition(material.label, index, "stop", _STOP_SPEED_MPS, 1.0, across, _SECONDS, seed)
    yield Condition(material.label, index, "varying", 0.0, 0.0, 0.0, _HAND_SECONDS, seed + 1)
    other = (index + _CHANGE_STEP) % len(materials)
    if other != index:
        yield Condition(
            material.label, index, "change", _CHANGE_SPEED_MPS, 1.0, across, _SECONDS, seed + 2,
            other_label=materials[other].label, other_index=other,
        )  # fmt: skip


def _steady(index: int, material: Material) -> Iterator[tuple[str, float, float, float, float, float]]:
    """(kind, speed, force, direction, crossing, seconds) of the steady conditions."""
    ruling = material.dominant_ruling
    across = ruling.direction_degrees if ruling else 0.0
    for number, (speed, seconds) in enumerate(_SECONDS_AT.items()):
        force = _FORCES_NEWTONS[(index + number) % len(_FORCES_NEWTONS)]
        turned = _DIRECTIONS_DEGREES[(index // 2 + number) % len(_DIRECTIONS_DEGREES)]
        direction = across if ruling else turned
        yield "constant", speed, force, direction, 0.0, _long_enough(material, speed, seconds)
    for speed, force in _CORNERS:
        yield "constant", speed, force, across, 0.0, _long_enough(material, speed, _SECONDS)
    for crossing in CROSSINGS_DEGREES if ruling else ():
        for speed in _CROSSED_SPEEDS_MPS:
            # Crossed at 45 degrees from behind, the direction is the held-out one.
            behind = 180.0 if crossing == 45.0 else 0.0
            yield "oblique", speed, 1.0, (across + crossing + behind) % 360.0, crossing, _SECONDS
    for speed in _NAP_SPEEDS_MPS if material.nap else ():
        for behind in (0.0, 180.0):
            yield "nap", speed, 1.0, (material.grain_degrees + behind) % 360.0, 0.0, _SECONDS


def _long_enough(material: Material, speed_mps: float, seconds: float) -> float:
    has_rare_impacts = material.impact_density > 0.0 and speed_mps <= _MAXIMUM_RARE_IMPACT_SPEED_MPS
    return seconds * (_IMPACT_FACTOR if has_rare_impacts else 1.0)


def motion_of(condition: Condition, material: Material, lead_seconds: float) -> NDArray[np.float64]:
    """The motion [n, 3] (vx, vy in m/s, force in N) at 2 kHz, with `lead_seconds` added before and after."""
    count = round(_MOTION_RATE_HZ * (condition.seconds + 2.0 * lead_seconds))
    time = np.arange(count) / _MOTION_RATE_HZ - lead_seconds
    if condition.kind == "varying":
        return _hand_motion(material, condition, count)
    along = condition.speed_mps * _speed_profile(condition.kind, time)
    angle = math.radians(condition.direction_degrees)
    force = np.full(count, condition.force_newtons)
    return np.stack([along * math.cos(angle), along * math.sin(angle), force], axis=1)


def _speed_profile(kind: str, time: NDArray[np.float64]) -> NDArray[np.float64]:
    if kind == "reversal":
        # tanh reaches 0.96 of its height half a turn after the middle.
        swing = np.sin(2.0 * np.pi * (time / _REVERSAL_PERIOD_SECONDS + 0.25))
        return np.tanh(swing * 4.0 * _REVERSAL_PERIOD_SECONDS / (2.0 * np.pi * _TURN_SECONDS))
    if kind == "stop":
        within = np.mod(time, _SLIDE_SECONDS + _REST_SECONDS)
        ramp = np.clip(np.minimum(within, _SLIDE_SECONDS - within) / _RAMP_SECONDS, 0.0, 1.0)
        return 0.5 - 0.5 * np.cos(np.pi * ramp)
    return np.ones(len(time))


def _hand_motion(material: Material, condition: Condition, count: int) -> NDArray[np.float64]:
    identity = hand_conditions(material, seed=_HAND_SEED, recordings=1)[0]
    ride = hand_ride(
        np.random.default_rng([_HAND_SEED, material.texture_id]),
        duration_seconds=count / _MOTION_RATE_HZ,
        median_speed_mmps=float(identity.speed_mmps),
        median_force_newtons=1e-3 * identity.force_millinewtons,
    )
    given = np.column_stack([1e-3 * ride.path.velocity_mmps, np.maximum(ride.force_newtons, 0.0)])
    places = np.linspace(0.0, len(given) - 1.0, count)
    return np.stack([np.interp(places, np.arange(len(given)), column) for column in given.T], axis=1)


def is_on_other_label(samples: int) -> NDArray[np.bool_]:
    """For a `change`: where the other label is under the tip, [samples]."""
    return np.arange(samples) // round(CHANGE_SECONDS * _MOTION_RATE_HZ) % 2 == 1
