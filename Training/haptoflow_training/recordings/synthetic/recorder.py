"""One recording at a prescribed condition; used by the evaluation and by the protocols."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.ndimage import map_coordinates, spline_filter1d
from scipy.signal import sosfilt

from haptoflow_training.recordings.recording import STANDARD_GRAVITY_MPS2, Recording, RecordingIdentity, Wander
from haptoflow_training.recordings.synthetic.carriers import (
    Ride, guided_ride, hand_ride, machine_pass, path_from_velocity
)
from haptoflow_training.recordings.synthetic.contact import SIMULATION_RATE_HZ, peak, tool_vibration
from haptoflow_training.recordings.synthetic.materials import Material
from haptoflow_training.recordings.synthetic.surface import HELD_OUT_SPECIMEN, training_specimen

_FULL_SCALE_G = 16.0
_STEP_G = 1e-3
_NOISE_G_PER_ROOT_HZ = 75e-6
_MINIMUM_STEP_SECONDS, _MAXIMUM_STEP_SECONDS = 130e-6, 210e-6
_MOUNT_RESONANCE = (1400.0, 4.0, 2.0)
_LOAD_CELL_HZ, _LOAD_CELL_UPDATES_HZ, _LOAD_CELL_STEP_NEWTONS = 6000.0, 80.0, 0.01
_LOAD_CELL_ACCURACY_NEWTONS = 0.05
_POSITION_HZ, _POSITION_STEP_MM = 100.0, 0.01
# Every so many samples of the simulation: fast ribs jitter too quickly for the position's clock.
_WANDER_EVERY = 4


def record_ride(
    material: Material,
    identity: RecordingIdentity,
    ride: Ride,
    rng: np.random.Generator,
    *,
    specimen: int,
    accelerometer_noise: bool = True,
    motion_noise: bool = True,
) -> Recording:
    """The sensors' readings of one ride over one specimen of a material.

    Without `accelerometer_noise`, the acceleration has neither noise nor quantisation; without `motion_noise`, force and
    position have neither, nor offsets. Clocks and ranges stay, and so does everything about the other sensors. Wander
    is no sensor's and stays exact.
    """
    rate_hz, force_newtons = SIMULATION_RATE_HZ, ride.force_newtons
    texture = tool_vibration(material, ride.path, force_newtons, specimen=specimen)
    duration = len(force_newtons) / rate_hz
    stamps = _irregular_stamps(rng, duration - 2.0 / rate_hz)
    mounted = sosfilt(peak(*_MOUNT_RESONANCE, rate_hz), texture.acceleration_mps2 + ride.carrier_mps2, axis=0)
    sensed = np.empty((len(stamps), 3))
    cells = (stamps * rate_hz)[None, :]
    for axis in range(3):
        coefficients = spline_filter1d(mounted[:, axis] / STANDARD_GRAVITY_MPS2, mode="nearest")
        sensed[:, axis] = map_coordinates(coefficients, cells, order=3, mode="nearest", prefilter=False)
    sensed[:, 2] -= 1.0
    # Drawn before the accelerometer's noise, so that the force is the same without it.
    force_time, force = _load_cell(rng, rate_hz, force_newtons, motion_noise)
    if accelerometer_noise:
        bandwidth_hz = 0.5 * len(stamps) / duration
        sensed += _NOISE_G_PER_ROOT_HZ * math.sqrt(bandwidth_hz) * rng.standard_normal(sensed.shape)
    sensed = soft_limit(sensed, _FULL_SCALE_G)
    if accelerometer_noise:
        sensed = np.round(sensed / _STEP_G) * _STEP_G

    position_time = np.arange(int(duration * _POSITION_HZ)) / _POSITION_HZ
    last = len(ride.path.position_mm) - 1
    position = ride.path.position_mm[np.minimum(np.round(position_time * rate_hz).astype(int), last)]
    if motion_noise:
        position = np.round(position / _POSITION_STEP_MM) * _POSITION_STEP_MM
    wander = Wander(np.arange(0, len(force_newtons), _WANDER_EVERY) / rate_hz, texture.wander_turns[::_WANDER_EVERY])
    return Recording(
        identity, material.label, stamps, sensed, force_time, force, position_time, position, specimen, wander=wander
    )  # fmt: skip


def soft_limit(values: NDArray[np.float64], limit: float) -> NDArray[np.float64]:
    """Values that approach +-limit smoothly; up to 0.6 of it they change by less than 1 %."""
    ratio = (values / limit) ** 2
    return values / (1.0 + ratio**4) ** 0.125


def _irregular_stamps(rng: np.random.Generator, duration_seconds: float) -> NDArray[np.float64]:
    count = int(duration_seconds / _MINIMUM_STEP_SECONDS) + 1
    spread = rng.beta(1.2, 2.5, size=count)
    steps = _MINIMUM_STEP_SECONDS + (_MAXIMUM_STEP_SECONDS - _MINIMUM_STEP_SECONDS) * spread
    stamps = np.round(np.concatenate([[0.0], np.cumsum(steps)]), 6)
    return stamps[: np.searchsorted(stamps, duration_seconds)]


def _load_cell(
    rng: np.random.Generator, rate_hz: float, force_newtons: NDArray[np.float64], noise: bool
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    count = int(len(force_newtons) / rate_hz * _LOAD_CELL_HZ)
    time = np.arange(count) / _LOAD_CELL_HZ
    if not noise:
        return time, np.interp(time, np.arange(len(force_newtons)) / rate_hz, force_newtons)
    update = np.floor(time * _LOAD_CELL_UPDATES_HZ).astype(int)
    at = (np.arange(update[-1] + 1) / _LOAD_CELL_UPDATES_HZ * rate_hz).astype(int)
    at = np.minimum(at, len(force_newtons) - 1)
    error = rng.uniform(-0.03, 0.03) + np.clip(0.006 * rng.standard_normal(len(at)), -0.02, 0.02)
    held = force_newtons[at] + np.clip(error, -_LOAD_CELL_ACCURACY_NEWTONS, _LOAD_CELL_ACCURACY_NEWTONS)
    return time, (np.round(held / _LOAD_CELL_STEP_NEWTONS) * _LOAD_CELL_STEP_NEWTONS)[update]


def record_condition(
    material: Material,
    *,
    velocity_mps: tuple[ArrayLike, ArrayLike],
    force_newtons: ArrayLike,
    duration_seconds: float,
    seed: int,
    specimen: int = HELD_OUT_SPECIMEN,
    accelerometer_noise: bool = True,
    motion_noise: bool = True,
) -> Recording:
    """A recording along a prescribed trajectory, without carrier noise: the reference of an evaluation.

    velocity_mps: (vx, vy), each a number or an array spread evenly over the duration, m/s, up to 1.5 in magnitude.
    force_newtons: a number or such an array, 0-5 N. seed: of the place on the surface and the sensor noise. specimen:
    the piece of the material, 0 or more; by default the typical one, which no training protocol records. Noise as of
    `record_ride`. Deterministic by its arguments.
    """
    count = int(round(duration_seconds * SIMULATION_RATE_HZ))
    velocity_mmps = 1e3 * np.stack([_spread(component, count) for component in velocity_mps], axis=1)
    force = _spread(force_newtons, count)
    if not (np.all(np.isfinite(velocity_mmps)) and np.all(np.isfinite(force)) and np.all(force >= 0.0)):
        raise ValueError("velocity and force must be finite, force zero or more")
    if specimen < 0:
        raise ValueError(f"specimen is {specimen}; expected 0 or more")
    speed = int(round(float(np.median(np.hypot(*velocity_mmps.T)))))
    press = int(round(1e3 * float(np.median(force))))
    identity = RecordingIdentity(material.texture_id, None, speed, press, seed)
    rng = np.random.default_rng([seed, material.texture_id, 5])
    path = path_from_velocity(rng.uniform(-500.0, 500.0, size=2), velocity_mmps)
    ride = Ride(path, force, np.zeros((count, 3)))
    return record_ride(
        material, identity, ride, rng, specimen=specimen, accelerometer_noise=accelerometer_noise,
        motion_noise=motion_noise,
    )  # fmt: skip


def _spread(values: ArrayLike, count: int) -> NDArray[np.float64]:
    array = np.atleast_1d(np.asarray(values, dtype=np.float64))
    if array.ndim != 1:
        raise ValueError("a trajectory component must be a number or one-dimensional")
    return np.interp(np.linspace(0.0, 1.0, count), np.linspace(0.0, 1.0, len(array)), array)


MACHINE_DIRECTIONS_DEGREES = tuple(range(0, 360, 45))
MACHINE_SPEEDS_MMPS = (20, 30, 40, 50, 60)
MACHINE_FORCES_MILLINEWTONS = (500, 1000)
MACHINE_REPEATS = 2
MINIMUM_HAND_SPEED_MMPS, MAXIMUM_HAND_SPEED_MMPS = 6.0, 900.0
LIGHTEST_HAND_NEWTONS, HEAVIEST_HAND_NEWTONS = 0.15, 3.5


def machine_conditions(
    material: Material,
    *,
    directions: Sequence[int] = MACHINE_DIRECTIONS_DEGREES,
    speeds_mmps: Sequence[int] = MACHINE_SPEEDS_MMPS,
    forces_millinewtons: Sequence[int] = MACHINE_FORCES_MILLINEWTONS,
    repeats: int = MACHINE_REPEATS,
) -> list[RecordingIdentity]:
    """The identities of one material's machine recordings."""
    return [
        RecordingIdentity(material.texture_id, direction, speed, force, repeat)
        for direction in directions
        for speed in speeds_mmps
        for force in forces_millinewtons
        for repeat in range(repeats)
    ]


def hand_conditions(material: Material, *, seed: int, recordings: int) -> list[RecordingIdentity]:
    """The identities of one material's hand recordings: speeds and forces spread evenly on a log scale.

    Speeds are stratified over `recordings`, so a shorter list is not the beginning of a longer one.
    """
    rng = np.random.default_rng([seed, material.texture_id, 2])
    order = rng.permutation(recordings)
    identities = []
    for repeat in range(recordings):
        share = (repeat + rng.random()) / recordings
        press = (order[repeat] + rng.random()) / recordings
        speed = MINIMUM_HAND_SPEED_MMPS * (MAXIMUM_HAND_SPEED_MMPS / MINIMUM_HAND_SPEED_MMPS) ** share
        force = LIGHTEST_HAND_NEWTONS * (HEAVIEST_HAND_NEWTONS / LIGHTEST_HAND_NEWTONS) ** press
        identities.append(RecordingIdentity(material.texture_id, None, round(speed), round(1e3 * force), repeat))
    return identities


def record_condition_of(
    material: Material,
    identity: RecordingIdentity,
    *,
    seed: int,
    duration_seconds: float = 8.0,
    guided_share: float = 0.0,
    specimen: int | None = None,
    accelerometer_noise: bool = True,
) -> Recording:
    """The recording of an identity: a machine pass, or a hand stroke of `duration_seconds`, free, or guided for a
    `guided_share` of all, spread evenly over the repeats.

    specimen: None selects the one that the training protocol records under this identity.
    """
    rng = _generator(seed, identity)
    force_newtons = 1e-3 * identity.force_millinewtons
    if identity.direction_degrees is not None:
        ride = machine_pass(
            rng,
            direction_degrees=float(identity.direction_degrees),
            speed_mmps=float(identity.speed_mmps),
            force_newtons=force_newtons,
        )
    else:
        guided = int((identity.repeat + 1) * guided_share) > int(identity.repeat * guided_share)
        ride = (guided_ride if guided else hand_ride)(
            rng,
            duration_seconds=duration_seconds,
            median_speed_mmps=float(identity.speed_mmps),
            median_force_newtons=force_newtons,
        )
    chosen = training_specimen(identity) if specimen is None else specimen
    return record_ride(material, identity, ride, rng, specimen=chosen, accelerometer_noise=accelerometer_noise)


def _generator(seed: int, identity: RecordingIdentity) -> np.random.Generator:
    direction = 360 if identity.direction_degrees is None else identity.direction_degrees
    return np.random.default_rng(
        [seed, identity.texture_id, direction, identity.speed_mmps, identity.force_millinewtons, identity.repeat]
    )
