"""One recording at a prescribed condition; used by the evaluation and by the protocols."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from haptoflow_training.recordings.recording import Recording, RecordingIdentity
from haptoflow_training.recordings.synthetic.carriers import Ride, path_from_velocity
from haptoflow_training.recordings.synthetic.contact import SIMULATION_RATE_HZ, tool_vibration
from haptoflow_training.recordings.synthetic.materials import Material
from haptoflow_training.recordings.synthetic.sensors import sense
from haptoflow_training.recordings.synthetic.specimens import HELD_OUT_SPECIMEN


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
    """The sensors' readings of one ride over one specimen of a material; noise as of `sense`."""
    texture = tool_vibration(material, ride.path, ride.force_newtons, specimen=specimen)
    return sense(
        identity,
        material.label,
        rng,
        rate_hz=SIMULATION_RATE_HZ,
        acceleration_mps2=texture.acceleration_mps2 + ride.carrier_mps2,
        force_newtons=ride.force_newtons,
        position_mm=ride.path.position_mm,
        wander_turns=texture.wander_turns,
        accelerometer_noise=accelerometer_noise,
        motion_noise=motion_noise,
        specimen=specimen,
    )


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
    `sense`. Deterministic by its arguments.
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
