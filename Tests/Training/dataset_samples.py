"""Small recordings for the data set tests."""

from __future__ import annotations

import numpy as np

from haptoflow_training.recordings.recording import Recording, RecordingIdentity


def small_recording(
    name: str = "0_90_40_500_0", label: str = "wood", seconds: float = 1.6, seed: int = 0, *, quiet_rests: bool = True
) -> Recording:
    """Tones on three axes while it moves, gravity on Z, 1 mg steps, an irregular clock; rest, a straight pass, rest.
    Without quiet_rests the tones go on at rest, as in the files of Golden/parquet."""
    identity = RecordingIdentity.parse(name)
    generator = np.random.default_rng([seed, *name.encode()])
    count = int(seconds * 6000)
    steps = generator.integers(130, 211, size=count) * 1e-6
    time = np.round(np.cumsum(steps), 6)
    time = time[time < seconds]
    hertz = generator.uniform(30, 400, size=(12, 3))
    phase = generator.uniform(0, 2 * np.pi, size=(12, 3))
    acceleration = 0.02 * np.sin(2 * np.pi * hertz[None] * time[:, None, None] + phase[None]).sum(axis=1)
    if quiet_rests:
        rests = (time < 0.2) | (time > seconds - 0.2)
        acceleration[rests] = 0.001 * generator.standard_normal((int(rests.sum()), 3))
    acceleration[:, 2] -= 1.0
    force_time = np.arange(int(seconds * 1000)) / 1000.0
    force = identity.force_millinewtons / 1000.0 + 0.01 * generator.integers(-1, 2, size=len(force_time))
    position_time = np.arange(int(seconds * 100)) / 100.0
    distance = identity.speed_mmps * np.clip(position_time - 0.2, 0.0, seconds - 0.4)
    angle = np.deg2rad(identity.direction_degrees or 0)
    position = np.round(np.outer(distance, [np.cos(angle), np.sin(angle)]), 2)
    return Recording(
        identity, label, time, np.round(acceleration, 3), force_time, np.round(force, 2), position_time, position
    )
