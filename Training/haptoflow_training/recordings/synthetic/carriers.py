"""The carrier that moves the stylus: the printer frame in straight passes, or a hand; path, force and its own
vibration."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.signal import sosfilt

from haptoflow_training.recordings.synthetic.contact import SIMULATION_RATE_HZ, contact_from_acceleration
from haptoflow_training.recordings.synthetic.surface import TipPath
from haptoflow_training.hand_stroke import force_profile, random_planar_stroke, tremor

SCAN_CENTRE_MM = 45.0
PASS_LENGTH_MM = 90.0
REST_SECONDS = 0.35
_RAMP_SECONDS = 0.1
# A sample is never put back on exactly the same line: a repeat follows a neighbouring track.
_TRACK_SPREAD_MM = 8.0
_HAND_EXTENT_METRES = 0.3
_HAND_TREMOR_METRES = 3e-6
_FULL_STEP_MM = 0.2
_CHANGE_SECONDS = 0.06
MAXIMUM_SPEED_MMPS, HEAVIEST_NEWTONS = 1500.0, 5.0
# Hz and damping of the printer frame.
_FRAME_RESONANCE = (90.0, 0.25)


@dataclass(frozen=True)
class Ride:
    """A path with the force along it and the carrier's own acceleration [n, 3] in m/s^2, at
    SIMULATION_RATE_HZ.
    """

    path: TipPath
    force_newtons: NDArray[np.float64]
    carrier_mps2: NDArray[np.float64]


def path_from_velocity(start_mm: NDArray[np.float64], velocity_mmps: NDArray[np.float64]) -> TipPath:
    """Integrate a velocity [n, 2] on the simulation's clock (trapezoids: position is once differentiable)."""
    step = 0.5 * (velocity_mmps[1:] + velocity_mmps[:-1]) / SIMULATION_RATE_HZ
    position = np.concatenate([np.zeros((1, 2)), np.cumsum(step, axis=0)]) + start_mm
    return TipPath(position, velocity_mmps)


def machine_pass(
    rng: np.random.Generator, *, direction_degrees: float, speed_mmps: float, force_newtons: float
) -> Ride:
    """One straight pass through the scan area's centre, clockwise direction, rests and ramps at both ends."""
    moving = PASS_LENGTH_MM / speed_mmps + _RAMP_SECONDS
    count = int((moving + 2 * REST_SECONDS) * SIMULATION_RATE_HZ)
    time = np.arange(count) / SIMULATION_RATE_HZ
    since, left = time - REST_SECONDS, REST_SECONDS + moving - time
    ramp = np.clip(np.minimum(since, left) / _RAMP_SECONDS, 0.0, 1.0)
    speed = speed_mmps * (0.5 - 0.5 * np.cos(math.pi * ramp))
    angle = -math.radians(direction_degrees)
    direction = np.array([math.cos(angle), math.sin(angle)])
    sideways = np.array([-direction[1], direction[0]]) * rng.uniform(-_TRACK_SPREAD_MM, _TRACK_SPREAD_MM)
    start = SCAN_CENTRE_MM - 0.5 * PASS_LENGTH_MM * direction + sideways
    path = path_from_velocity(start, speed[:, None] * direction)
    drift = 0.02 * rng.standard_normal(8)
    held = force_newtons * (1.0 + np.interp(np.linspace(0.0, 7.0, count), np.arange(8), drift))
    return Ride(path, held, _frame_vibration(rng, path) + _inertia(path.velocity_mmps))


def hand_ride(
    rng: np.random.Generator, *, duration_seconds: float, median_speed_mmps: float, median_force_newtons: float
) -> Ride:
    """A free stroke with rests at both ends.

    The hand's own acceleration (up to tens of m/s^2 below 20 Hz) is left out, and its tremor is kept faint: a texture
    learnt from them would add them to the hand that feels it.
    """
    stroke_rate = 1000.0
    free = duration_seconds - 2.0 * REST_SECONDS
    stroke = random_planar_stroke(
        rng,
        duration_seconds=free,
        rate_hz=stroke_rate,
        median_speed_mps=1e-3 * median_speed_mmps,
        extent_metres=_HAND_EXTENT_METRES,
    )
    force = force_profile(
        rng,
        duration_seconds=free,
        rate_hz=stroke_rate,
        median_force_newtons=median_force_newtons,
        speed_mps=stroke.speed_mps,
    )
    count = int(duration_seconds * SIMULATION_RATE_HZ)
    time = np.arange(count) / SIMULATION_RATE_HZ - REST_SECONDS
    velocity = np.stack(
        [1e3 * np.interp(time, stroke.time_seconds, component) for component in stroke.velocity_mps.T], axis=1
    )
    path = path_from_velocity(rng.uniform(-500.0, 500.0, size=2), velocity)
    shaking = tremor(rng, count, SIMULATION_RATE_HZ, _HAND_TREMOR_METRES, 3)
    carrier = np.zeros((count, 3))
    carrier[1:-1] = np.diff(shaking, 2, axis=0) * SIMULATION_RATE_HZ**2
    return Ride(path, np.interp(time, stroke.time_seconds, force), carrier)


def guided_ride(
    rng: np.random.Generator, *, duration_seconds: float, median_speed_mmps: float, median_force_newtons: float
) -> Ride:
    """A hand that rests on a moving surface, such as a turntable: speed, direction and force are held for 0.5 to 1.5 s,
    then change, with speeds of 0.6 to 3.3 times `median_speed_mmps`.

    In free strokes the motion is never constant for 100 ms, so the pitch of ribs cannot be learnt from them. Fast ribs
    need even more: at 1 m/s, a drift of 3 % a second blurs ribs of 0.6 mm within 100 ms. Therefore every second hold is
    steady, half of these along one of the eight directions of the machine protocol.
    """
    count = int(duration_seconds * SIMULATION_RATE_HZ)
    time = np.arange(count) / SIMULATION_RATE_HZ
    changes = np.cumsum(rng.uniform(0.5, 1.5, size=int(duration_seconds / 0.5) + 2))
    hold = np.searchsorted(changes, time)
    holds = int(hold[-1]) + 1
    # Within a hold, everything still drifts a little, as on a turntable.
    within = time - np.concatenate([[0.0], changes])[hold]
    is_steady = rng.random(holds) < 0.5
    drift = np.where(is_steady, 0.05, 1.0)
    scanned = 0.25 * math.pi * rng.integers(0, 8, holds) + rng.normal(0.0, 0.03, holds)
    heading = np.where(is_steady & (rng.random(holds) < 0.5), scanned, rng.uniform(0.0, 2.0 * math.pi, holds))
    # More fast than slow: real pens spend nine tenths of their time above 60 mm/s, and high speeds have more pitches to
    # learn.
    log_speed = rng.uniform(-0.5, 1.2, holds)[hold] + (drift * rng.normal(0.0, 0.03, holds))[hold] * within
    angle = heading[hold] + (drift * rng.normal(0.0, 0.1, holds))[hold] * within
    press = np.exp(rng.normal(0.0, 0.3, holds))[hold]
    speed = np.minimum(median_speed_mmps * np.exp(log_speed), MAXIMUM_SPEED_MMPS)
    ramp = np.clip(np.minimum(time, duration_seconds - time) / REST_SECONDS - 1.0, 0.0, 1.0)
    moving = 0.5 - 0.5 * np.cos(math.pi * ramp)
    velocity = (speed * moving)[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    kernel = np.hanning(int(_CHANGE_SECONDS * SIMULATION_RATE_HZ) + 2)[1:-1]
    smooth = [
        np.convolve(np.pad(values, len(kernel) // 2, mode="edge"), kernel / kernel.sum(), mode="same")
        for values in (*velocity.T, np.minimum(median_force_newtons * press, HEAVIEST_NEWTONS))
    ]
    trim = slice(len(kernel) // 2, len(kernel) // 2 + count)
    path = path_from_velocity(rng.uniform(-500.0, 500.0, size=2), np.stack([smooth[0][trim], smooth[1][trim]], axis=1))
    return Ride(path, smooth[2][trim], np.zeros((count, 3)))


def _inertia(velocity_mmps: NDArray[np.float64]) -> NDArray[np.float64]:
    """The acceleration of the carrier itself in the plane, which the sensor measures too."""
    planar = np.gradient(velocity_mmps, 1.0 / SIMULATION_RATE_HZ, axis=0) * 1e-3
    return np.column_stack([planar, np.zeros(len(planar))])


def _frame_vibration(rng: np.random.Generator, path: TipPath) -> NDArray[np.float64]:
    """A printer frame: hum and fan noise at rest; full steps and belt rumble that grow with speed."""
    count = len(path.velocity_mmps)
    speed = np.hypot(*path.velocity_mmps.T)
    time = np.arange(count) / SIMULATION_RATE_HZ
    resonance = contact_from_acceleration(*_FRAME_RESONANCE, SIMULATION_RATE_HZ)
    fan = sosfilt(resonance, rng.standard_normal((count, 3)), axis=0)
    shares = np.array([1.0, 0.8, 0.6])
    level = 0.012 + 0.02 * speed / 60.0
    vibration = level[:, None] * shares * fan / np.std(fan)
    vibration += 0.008 * shares * np.sin(2 * math.pi * 100.0 * time + rng.uniform(0, 6.28))[:, None]
    for axis in range(2):
        own = np.abs(path.velocity_mmps[:, axis])
        steps = path.position_mm[:, axis] / _FULL_STEP_MM
        vibration[:, axis] += 0.03 * np.tanh(own / 30.0) * np.sin(2 * math.pi * steps + rng.uniform(0, 6.28))
    return vibration
