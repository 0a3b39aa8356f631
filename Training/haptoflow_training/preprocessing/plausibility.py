"""What cannot be a recording of a stylus on a surface: wrong units, glitches, a dead sensor."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.recordings.recording import Recording

# A sensor at rest feels 1 g. In m/s^2 that is 9.81, in mg 1000; tilted or high-passed, it is less.
_GRAVITY_IN_MPS2 = (6.0, 14.0)
_GRAVITY_IN_MG = (500.0, 2000.0)
# Far above what any stroke of a hand or machine leaves in an accelerometer at a stylus.
_HIGHEST_RMS_G = 40.0
# Named and measured values further apart than this differ by a unit, not by a bad day.
_LARGEST_RATIO = 4.0
_STRONGEST_NEWTONS = 100.0
_WEAKEST_NEWTONS = 0.002
# A hand's name says only about how fast it was, and one that is asked to rest has no speed to compare.
_LARGEST_RATIO_OF_A_HAND = 30.0
_SLOWEST_COMPARED_MMPS = 20.0
_FASTEST_MPS = 10.0
_SPIKE_NEWTONS = 20.0
_SPIKE_RATIO = 8.0
_CLIPPED_RUN = 4
_LARGEST_CLIPPED_SHARE = 0.02
_LONGEST_FROZEN_SECONDS = 0.2


def implausible(recording: Recording) -> Iterator[str]:
    """Each thing that is wrong, as `found; expected`. All values must be finite."""
    yield from _acceleration(recording)
    yield from _force(recording)
    yield from _position(recording)


def _acceleration(recording: Recording) -> Iterator[str]:
    values = np.asarray(recording.acceleration_g, dtype=np.float64)
    rest = float(np.linalg.norm(values.mean(axis=0)))
    rms = float(np.sqrt(np.mean(np.sum((values - values.mean(axis=0)) ** 2, axis=1))))
    if _GRAVITY_IN_MPS2[0] < rest < _GRAVITY_IN_MPS2[1]:
        yield f"acceleration rests at {rest:.1f}, which looks like m/s^2; expected g (1 at rest): divide by 9.80665"
    elif _GRAVITY_IN_MG[0] < rest < _GRAVITY_IN_MG[1]:
        yield f"acceleration rests at {rest:.0f}, which looks like mg; expected g (1 at rest): divide by 1000"
    elif rms > _HIGHEST_RMS_G:
        yield f"acceleration has an RMS of {rms:.0f}; expected g, at most {_HIGHEST_RMS_G:.0f}"
    time = recording.acceleration_time_seconds
    frozen = _longest_run(np.all(np.diff(values, axis=0) == 0.0, axis=1), time)
    if frozen > _LONGEST_FROZEN_SECONDS:
        yield f"acceleration stays the same for {frozen:.2f} s; expected a sensor that is never quite still"
    clipped = max(_clipped_share(axis) for axis in values.T)
    if clipped > _LARGEST_CLIPPED_SHARE:
        yield f"acceleration is clipped for {100.0 * clipped:.0f} % of the time; expected a sensor of a larger range"


def _force(recording: Recording) -> Iterator[str]:
    values = np.abs(np.asarray(recording.force_newtons, dtype=np.float64))
    median, usual = float(np.median(values)), float(np.percentile(values, 95))
    nominal = recording.identity.force_millinewtons / 1000.0 if recording.identity.protocol == "machine" else 0.0
    ratio = median / nominal if nominal > 0.0 else 1.0
    if median > _STRONGEST_NEWTONS or ratio > _LARGEST_RATIO:
        named = f" where the name says {nominal:g} N" if nominal else ""
        yield f"force is {median:.4g}{named}; expected newtons (a thousandth for mN, times 0.00981 for grams)"
    elif usual < _WEAKEST_NEWTONS:
        yield f"force is {usual:.2g} at most; expected newtons (times 1000 for kN), and a tip that touches"
    strongest = float(values.max())
    if strongest > max(_SPIKE_NEWTONS, _SPIKE_RATIO * usual):
        yield f"force has a spike of {strongest:.0f} where {usual:.1f} is usual; expected no glitches"


def _position(recording: Recording) -> Iterator[str]:
    time = np.asarray(recording.position_time_seconds, dtype=np.float64)
    values = np.asarray(recording.position_mm, dtype=np.float64)
    steps_mm = np.linalg.norm(np.diff(values, axis=0), axis=1)
    speeds_mmps = steps_mm / np.maximum(np.diff(time), 1e-6)
    nominal = float(recording.identity.speed_mmps)
    largest = _LARGEST_RATIO if recording.identity.protocol == "machine" else _LARGEST_RATIO_OF_A_HAND
    moving = speeds_mmps[speeds_mmps > 0.2 * np.percentile(speeds_mmps, 95)]
    if nominal >= _SLOWEST_COMPARED_MMPS and len(moving) > 0:
        median = float(np.median(moving))
        if not nominal / largest < median < nominal * largest:
            yield f"position moves with {median:.3g} a second where the name says {nominal:g} mm/s; expected millimetres"
            return
    fastest = float(speeds_mmps.max()) / 1000.0
    if fastest > _FASTEST_MPS:
        yield f"position jumps with {fastest:.0f} m/s; expected a tracker without jumps, at most {_FASTEST_MPS:.0f} m/s"


def _longest_run(holds: NDArray[np.bool_], time: NDArray[np.floating]) -> float:
    """Seconds for which consecutive steps hold."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], holds, [False]]).astype(np.int8)))
    if len(edges) == 0:
        return 0.0
    starts, stops = edges[::2], edges[1::2]
    return float(np.max(np.asarray(time)[stops] - np.asarray(time)[starts]))


def _clipped_share(values: NDArray[np.float64]) -> float:
    """The share of samples that stand at an end of the range in runs of several; 0 for an axis that nobody recorded."""
    share = 0.0
    if float(np.ptp(values)) == 0.0:
        return share
    for end in (values.min(), values.max()):
        at_end = np.concatenate([[False], values == end, [False]]).astype(np.int8)
        edges = np.flatnonzero(np.diff(at_end))
        lengths = edges[1::2] - edges[::2]
        share += float(lengths[lengths >= _CLIPPED_RUN].sum()) / len(values)
    return share
