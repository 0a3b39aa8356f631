"""Velocity, position and force at the samples of the waveform, from sensors with their own clocks."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy import signal
from scipy.interpolate import CubicSpline

from haptoflow_training.preprocessing.filters import zero_phase_low_pass
from haptoflow_training.recordings.recording import Wander


def velocity_mps(
    time_seconds: NDArray[np.float64],
    position_mm: NDArray[np.floating],
    grid_seconds: NDArray[np.float64],
    window_seconds: float,
) -> NDArray[np.float64]:
    """Positions [k, 2] in mm at `time_seconds` to velocities [n, 2] in m/s at `grid_seconds` (constant beyond the
    ends).

    The slope of a cubic fitted to a window of samples (Savitzky-Golay): constant speed and constant acceleration pass
    without bias, position steps of 0.1 mm are averaged. Beyond the ends the stylus rests.
    """
    uniform, positions = _uniform(time_seconds, position_mm)
    step = float(uniform[1] - uniform[0])
    count = len(uniform)
    window = max(5, 2 * round(window_seconds / step / 2) + 1)
    resting = np.pad(positions, ((window // 2, window // 2), (0, 0)), mode="edge")
    slopes = signal.savgol_filter(resting, window, 3, deriv=1, delta=step, axis=0)[
        window // 2 : -(window // 2)
    ]
    clamped = np.clip(grid_seconds, uniform[0], uniform[-1])
    if count < 4:
        return np.column_stack([np.interp(clamped, uniform, axis) for axis in slopes.T]) / 1000.0
    return CubicSpline(uniform, slopes, axis=0)(clamped) / 1000.0


def smooth_velocity_mps(
    time_seconds: NDArray[np.float64],
    velocity: NDArray[np.floating],
    grid_seconds: NDArray[np.float64],
    window_seconds: float,
) -> NDArray[np.float64]:
    """Velocities [k, 2] in m/s at `time_seconds` to [n, 2] at `grid_seconds` (constant beyond the ends), smoothed by
    a cubic over a window of samples, like velocities derived from positions."""
    uniform, values = _uniform(time_seconds, velocity)
    window = 2 * round(window_seconds / float(uniform[1] - uniform[0]) / 2) + 1
    if 5 <= window <= len(uniform):
        values = signal.savgol_filter(values, window, 3, axis=0, mode="interp")
    clamped = np.clip(grid_seconds, uniform[0], uniform[-1])
    return np.column_stack([np.interp(clamped, uniform, axis) for axis in values.T])


def position_mm_on_grid(
    time_seconds: NDArray[np.float64], position_mm: NDArray[np.floating], grid_seconds: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Positions [k, 2] in mm at `time_seconds` to [n, 2] in mm at `grid_seconds` (constant beyond the ends), by a
    cubic spline."""
    uniform, positions = _uniform(time_seconds, position_mm)
    clamped = np.clip(grid_seconds, uniform[0], uniform[-1])
    return np.asarray(CubicSpline(uniform, positions, axis=0)(clamped))


def wander_turns_on_grid(wander: Wander | None, grid_seconds: NDArray[np.float64]) -> NDArray[np.float64]:
    """The phases of `wander` at [n, 3] `grid_seconds` (constant beyond the ends), by a cubic spline; zero if unknown."""
    if wander is None:
        return np.zeros((len(grid_seconds), 3))
    clamped = np.clip(grid_seconds, wander.time_seconds[0], wander.time_seconds[-1])
    return np.asarray(CubicSpline(wander.time_seconds, wander.turns, axis=0)(clamped))


def _uniform(
    time_seconds: NDArray[np.float64], position_mm: NDArray[np.floating]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Times [m] at the readings' median distance, and the positions [m, 2] in mm at them."""
    step = float(np.median(np.diff(time_seconds)))
    count = max(2, 1 + round((time_seconds[-1] - time_seconds[0]) / step))
    uniform = np.linspace(time_seconds[0], time_seconds[-1], count)
    return uniform, np.column_stack([np.interp(uniform, time_seconds, axis) for axis in np.asarray(position_mm).T])


def force_newtons(
    time_seconds: NDArray[np.float64],
    force: NDArray[np.floating],
    grid_seconds: NDArray[np.float64],
    low_pass_hz: float,
) -> NDArray[np.float64]:
    """Forces [m] in N at `time_seconds` to [n] at `grid_seconds`, never negative.

    A load cell holds its value between conversions and picks up vibration of the frame; a zero-phase 2nd-order low-pass
    removes both without delaying the force of a tap.
    """
    on_grid = np.interp(grid_seconds, time_seconds, force)
    rate_hz = 1.0 / float(grid_seconds[1] - grid_seconds[0])
    return np.maximum(zero_phase_low_pass(on_grid, low_pass_hz, rate_hz, order=2), 0.0)
