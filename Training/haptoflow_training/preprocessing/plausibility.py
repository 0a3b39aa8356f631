"""Finds implausible recordings: wrong units, glitches, a dead sensor.

The library checks a user's own file, in the units that its columns name; here are recordings of a data set, in g and mm,
against the speed and the force that their names state.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.recordings.recording import Recording

# An accelerometer at rest measures 1 g, 9.81 m/s^2 or 1000 mg; less if its signal is high-passed.
_GRAVITY_IN_MPS2 = (6.0, 14.0)
_GRAVITY_IN_MG = (500.0, 2000.0)
# No stroke by hand or machine makes a stylus vibrate more strongly.
_MAXIMUM_RMS_G = 40.0
# A larger ratio between measured and nominal value means a wrong unit: no protocol misses its condition by that much.
_MAXIMUM_RATIO = 4.0
_MAXIMUM_FORCE_NEWTONS = 100.0
_WEAKEST_NEWTONS = 0.002
# A hand follows the speed in its recording's name only roughly, and below the second value it may rest.
_MAXIMUM_RATIO_OF_A_HAND = 30.0
_MINIMUM_COMPARED_SPEED_MMPS = 20.0
_MAXIMUM_SPEED_MPS = 10.0
# A sensor without load trembles around nothing.
_NOISE_NEWTONS = 0.02
_NOISE_SHARE = 0.1
_MAXIMUM_NEGATIVE_SHARE = 0.05
_SPIKE_NEWTONS = 20.0
_SPIKE_RATIO = 8.0
_CLIPPED_RUN = 4
_MAXIMUM_CLIPPED_SHARE = 0.02
_MAXIMUM_FROZEN_SECONDS = 0.2


class Implausibility(NamedTuple):
    """Why a recording is implausible. sensor: acceleration, force or position."""

    sensor: str
    found: str
    expected: str

    def __str__(self) -> str:
        return f"{self.sensor} {self.found}; expected {self.expected}"


def implausible(recording: Recording) -> Iterator[Implausibility]:
    """Everything implausible about a recording. All of its values must be finite."""
    yield from _acceleration(recording)
    yield from _force(recording)
    yield from _position(recording)


def _acceleration(recording: Recording) -> Iterator[Implausibility]:
    values = np.asarray(recording.acceleration_g, dtype=np.float64)
    rest = float(np.linalg.norm(values.mean(axis=0)))
    rms = float(np.sqrt(np.mean(np.sum(recording.vibration_g**2, axis=1))))
    if _GRAVITY_IN_MPS2[0] < rest < _GRAVITY_IN_MPS2[1]:
        found = f"rests at {rest:.1f}, which looks like m/s^2"
        yield Implausibility("acceleration", found, "g (1 at rest): divide by 9.80665")
    elif _GRAVITY_IN_MG[0] < rest < _GRAVITY_IN_MG[1]:
        found = f"rests at {rest:.0f}, which looks like mg"
        yield Implausibility("acceleration", found, "g (1 at rest): divide by 1000")
    elif rms > _MAXIMUM_RMS_G:
        yield Implausibility("acceleration", f"has an RMS of {rms:.0f}", f"g, at most {_MAXIMUM_RMS_G:.0f}")
    time = recording.acceleration_time_seconds
    frozen = _longest_run(np.all(np.diff(values, axis=0) == 0.0, axis=1), time)
    # A simulated sensor without noise is quite still at rest.
    if frozen > _MAXIMUM_FROZEN_SECONDS and recording.specimen is None:
        yield Implausibility("acceleration", f"stays the same for {frozen:.2f} s", "a sensor that is never quite still")
    clipped = max(_clipped_share(axis) for axis in values.T)
    if clipped > _MAXIMUM_CLIPPED_SHARE:
        found = f"is clipped for {100.0 * clipped:.0f} % of the time"
        yield Implausibility("acceleration", found, "a sensor of a larger range")


def _force(recording: Recording) -> Iterator[Implausibility]:
    measured = np.asarray(recording.force_newtons, dtype=np.float64)
    values = np.abs(measured)
    median, usual = float(np.median(values)), float(np.percentile(values, 95))
    nominal = recording.identity.force_millinewtons / 1000.0 if recording.identity.protocol == "machine" else 0.0
    ratio = median / nominal if nominal > 0.0 else 1.0
    if median > _MAXIMUM_FORCE_NEWTONS or ratio > _MAXIMUM_RATIO:
        named = f" where the name says {nominal:g} N" if nominal else ""
        expected = "newtons (a thousandth for mN, times 0.00981 for grams)"
        yield Implausibility("force", f"is {median:.4g}{named}", expected)
    elif usual < _WEAKEST_NEWTONS:
        yield Implausibility("force", f"is {usual:.2g} at most", "newtons (times 1000 for kN), and a tip that touches")
    negative = float(np.mean(measured < -max(_NOISE_NEWTONS, _NOISE_SHARE * usual)))
    if negative > _MAXIMUM_NEGATIVE_SHARE:
        found = f"is negative in {100.0 * negative:.0f} % of the samples, down to {measured.min():.2g} N"
        yield Implausibility(
            "force", found, "newtons that grow from 0 as the tip presses: turn the sign, or subtract what the sensor "
            "reads in the air",
        )  # fmt: skip
    strongest = float(values.max())
    if strongest > max(_SPIKE_NEWTONS, _SPIKE_RATIO * usual):
        yield Implausibility("force", f"has a spike of {strongest:.0f} where {usual:.1f} is usual", "no glitches")


def _position(recording: Recording) -> Iterator[Implausibility]:
    speeds_mmps = recording.speeds_mmps
    nominal = float(recording.identity.speed_mmps)
    largest = _MAXIMUM_RATIO if recording.identity.protocol == "machine" else _MAXIMUM_RATIO_OF_A_HAND
    moving = speeds_mmps[speeds_mmps > 0.2 * np.percentile(speeds_mmps, 95)]
    if nominal >= _MINIMUM_COMPARED_SPEED_MMPS and len(moving) > 0:
        median = float(np.median(moving))
        if not nominal / largest < median < nominal * largest:
            found = f"moves with {median:.3g} a second where the name says {nominal:g} mm/s"
            yield Implausibility("position", found, "millimetres")
            return
    fastest = float(speeds_mmps.max()) / 1000.0
    if fastest > _MAXIMUM_SPEED_MPS:
        expected = f"a tracker without jumps, at most {_MAXIMUM_SPEED_MPS:.0f} m/s"
        yield Implausibility("position", f"jumps with {fastest:.0f} m/s", expected)


def _runs(holds: NDArray[np.bool_]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """The start and the end of each run of true values."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], holds, [False]]).astype(np.int8)))
    return edges[::2], edges[1::2]


def _longest_run(holds: NDArray[np.bool_], time: NDArray[np.floating]) -> float:
    """The longest time, in seconds, for which consecutive steps hold."""
    starts, stops = _runs(holds)
    return float(np.max(np.asarray(time)[stops] - np.asarray(time)[starts], initial=0.0))


def _clipped_share(values: NDArray[np.float64]) -> float:
    """The share of samples at an end of the range, counting only runs of several; 0 for an axis that was not
    recorded."""
    if float(np.ptp(values)) == 0.0:
        return 0.0
    share = 0.0
    for end in (values.min(), values.max()):
        starts, stops = _runs(values == end)
        lengths = stops - starts
        share += float(lengths[lengths >= _CLIPPED_RUN].sum()) / len(values)
    return share
