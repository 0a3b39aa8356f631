"""The two protocols: the published data set's machine design, and free hand strokes.

Every recording is seeded by (seed, its identity), so order, subset and parallelism have no effect. The identity also
determines which training specimen is recorded.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from haptoflow_training.recordings.recording import Recording, RecordingIdentity
from haptoflow_training.recordings.synthetic.carriers import Ride, guided_ride, hand_ride, machine_pass
from haptoflow_training.recordings.synthetic.materials import Material
from haptoflow_training.recordings.synthetic.recorder import record_ride
from haptoflow_training.recordings.synthetic.specimens import training_specimen

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


def record_machine_condition(
    material: Material,
    identity: RecordingIdentity,
    *,
    seed: int,
    specimen: int | None = None,
    accelerometer_noise: bool = True,
) -> Recording:
    """One machine pass. specimen: None selects the one that the training protocol records under this identity."""
    rng = _generator(seed, identity)
    ride = machine_ride(identity, rng)
    chosen = training_specimen(identity) if specimen is None else specimen
    return record_ride(material, identity, ride, rng, specimen=chosen, accelerometer_noise=accelerometer_noise)


def machine_ride(identity: RecordingIdentity, rng: np.random.Generator) -> Ride:
    """The machine pass with the direction, speed and force in `identity`; ValueError if that is a hand recording."""
    if identity.direction_degrees is None:
        raise ValueError(f"{identity.name} is not a machine recording")
    return machine_pass(
        rng,
        direction_degrees=float(identity.direction_degrees),
        speed_mmps=float(identity.speed_mmps),
        force_newtons=1e-3 * identity.force_millinewtons,
    )


def record_hand_condition(
    material: Material,
    identity: RecordingIdentity,
    *,
    seed: int,
    duration_seconds: float = 8.0,
    guided_share: float = 0.0,
    specimen: int | None = None,
    accelerometer_noise: bool = True,
) -> Recording:
    """One hand stroke: free, or guided for a `guided_share` of all, spread evenly over the repeats.

    specimen: None selects the one that the training protocol records under this identity.
    """
    rng = _generator(seed, identity)
    guided = int((identity.repeat + 1) * guided_share) > int(identity.repeat * guided_share)
    ride = (guided_ride if guided else hand_ride)(
        rng,
        duration_seconds=duration_seconds,
        median_speed_mmps=float(identity.speed_mmps),
        median_force_newtons=1e-3 * identity.force_millinewtons,
    )
    chosen = training_specimen(identity) if specimen is None else specimen
    return record_ride(material, identity, ride, rng, specimen=chosen, accelerometer_noise=accelerometer_noise)


def record_condition_of(
    material: Material,
    identity: RecordingIdentity,
    *,
    seed: int,
    duration_seconds: float = 8.0,
    guided_share: float = 0.0,
    accelerometer_noise: bool = True,
) -> Recording:
    """The training protocols' recording of an identity; duration_seconds and guided_share: of a hand recording."""
    if identity.protocol == "machine":
        return record_machine_condition(material, identity, seed=seed, accelerometer_noise=accelerometer_noise)
    return record_hand_condition(
        material, identity, seed=seed, duration_seconds=duration_seconds, guided_share=guided_share,
        accelerometer_noise=accelerometer_noise,
    )  # fmt: skip


def _generator(seed: int, identity: RecordingIdentity) -> np.random.Generator:
    direction = 360 if identity.direction_degrees is None else identity.direction_degrees
    return np.random.default_rng(
        [seed, identity.texture_id, direction, identity.speed_mmps, identity.force_millinewtons, identity.repeat]
    )
