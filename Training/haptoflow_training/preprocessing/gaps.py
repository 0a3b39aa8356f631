"""Splits a recording at the gaps of its accelerometer."""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.recordings.recording import Recording

# A cubic spline through the samples needs this many.
_MINIMUM_SAMPLES = 4


def parts_between_gaps(recording: Recording, longest_gap_seconds: float) -> list[Recording]:
    """The stretches between gaps longer than `longest_gap_seconds`, in order. Stretches with too few samples to
    interpolate are left out; a recording without a gap is returned unchanged."""
    time = np.asarray(recording.acceleration_time_seconds)
    gaps = np.flatnonzero(np.diff(time) > longest_gap_seconds) + 1
    if len(gaps) == 0:
        return [recording]
    parts = (_cut(recording, first, last) for first, last in zip([0, *gaps], [*gaps, len(time)], strict=True))
    return [part for part in parts if part is not None]


def _cut(recording: Recording, first: int, last: int) -> Recording | None:
    if last - first < _MINIMUM_SAMPLES:
        return None
    time = recording.acceleration_time_seconds[first:last]
    force = _around(recording.force_time_seconds, float(time[0]), float(time[-1]))
    position = _around(recording.position_time_seconds, float(time[0]), float(time[-1]))
    if min(force.stop - force.start, position.stop - position.start) < _MINIMUM_SAMPLES:
        return None
    return dataclasses.replace(
        recording,
        acceleration_time_seconds=time,
        acceleration_g=recording.acceleration_g[first:last],
        force_time_seconds=recording.force_time_seconds[force],
        force_newtons=recording.force_newtons[force],
        position_time_seconds=recording.position_time_seconds[position],
        position_mm=recording.position_mm[position],
        velocity_mps=None if recording.velocity_mps is None else recording.velocity_mps[position],
    )


def _around(time: NDArray[np.float64], start: float, stop: float) -> slice:
    """The samples of another sensor's clock from the last one before `start` to the first one after `stop`."""
    first = max(0, int(np.searchsorted(time, start, side="right")) - 1)
    last = min(len(time), int(np.searchsorted(time, stop, side="left")) + 1)
    return slice(first, last)
