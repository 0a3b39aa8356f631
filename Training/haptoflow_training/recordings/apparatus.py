"""What the frame that carries a sensor adds to one axis, seen by symmetry.

A machine that passes over every surface evenly in all directions treats the two axes in the plane alike. Where one of them
is stronger in the sum of all passes, the difference belongs to the apparatus, not to the materials.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from haptoflow_training.recordings.recording import Recording

# The strongest band of X in the Cluster data set, as others measured it.
BAND_HZ = (54.0, 85.0)
_QUARTER_DEGREES = 90
_LEAST_SHARE = 0.9


@dataclass(frozen=True)
class PlanePowers:
    """One machine pass: its direction, and the shares of X and Y in their power in the band."""

    direction_degrees: int
    x: float
    y: float


def plane_powers(recording: Recording) -> PlanePowers | None:
    """None for a recording by hand, of one axis, or without power in the band."""
    direction = recording.identity.direction_degrees
    if direction is None or np.shape(recording.acceleration_g)[1:] != (3,):
        return None
    time = recording.acceleration_time_seconds
    even = np.linspace(time[0], time[-1], len(time))
    axes = np.column_stack([np.interp(even, time, axis) for axis in recording.vibration_g.T[:2]])
    power = np.abs(np.fft.rfft(axes, axis=0)) ** 2
    hertz = np.fft.rfftfreq(len(even), float(even[1] - even[0]))
    x, y = power[(hertz >= BAND_HZ[0]) & (hertz <= BAND_HZ[1])].sum(axis=0)
    return PlanePowers(direction, float(x / (x + y)), float(y / (x + y))) if x + y > 0.0 else None


def x_over_y_db(passes: Iterable[PlanePowers]) -> float | None:
    """By how much X is stronger than Y in the band; None if some direction has fewer passes than the one across it."""
    found = list(passes)
    count = Counter(each.direction_degrees for each in found)
    is_even = all(count[(direction + _QUARTER_DEGREES) % 360] >= _LEAST_SHARE * own for direction, own in count.items())
    if not found or not is_even:
        return None
    return float(10.0 * np.log10(sum(each.x for each in found) / sum(each.y for each in found)))
