"""Reports the contents of a data set folder: counts, clocks, durations, coverage, and every broken file."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.errors import InputError
from haptoflow_training.preprocessing.pipeline import preprocess_parts
from haptoflow_training.preprocessing.plausibility import implausible
from haptoflow_training.recordings.native_recording import SensorNoise
from haptoflow_training.recordings.cluster_dataset_files import DatasetFileError
from haptoflow_training.recordings.dataset import Dataset
from haptoflow_training.recordings.open_recordings import RecordingFile
from haptoflow_training.recordings.recording import Recording, RecordingIdentity

# What the frame that carries a sensor adds to one axis, seen by symmetry.
# A machine that passes over every surface evenly in all directions treats the two axes in the plane alike. Where one
# of them is stronger in the sum of all passes, the difference belongs to the apparatus, not to the materials.
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


_GRID = ("speed_mmps", "direction_degrees", "force_millinewtons", "repeat")
_UNITS = {"vibration": "g", "force": "N", "speed": "mm/s"}
_QUANTILES = (0.01, 0.5, 0.99)
_REPORT_VERSION = 1


def inspect_dataset(dataset: Dataset, recordings: Iterable[RecordingFile] | None = None) -> dict[str, Any]:
    """The report, as JSON. Reads every recording once, one at a time; `recordings` may wrap `dataset` to show progress.

    A broken file is reported as a problem, and so is an apparent wrong unit or glitch; InputError is raised only if nothing
    that reads Parquet is installed. Counts cover readable recordings; problems are in the order of the files.
    """
    readable: list[RecordingFile] = []
    durations: list[float] = []
    clocks: dict[str, list[tuple[float, float]]] = defaultdict(list)
    quantiles: dict[str, list[NDArray[np.float64]]] = defaultdict(list)
    noises: list[SensorNoise] = []
    powers = []
    notes = list(dataset.notes)
    problems = list(dataset.problems)
    for entry in dataset if recordings is None else recordings:
        try:
            recording = entry.load()
        except DatasetFileError as error:
            problems.append(error)
            continue
        notes += (note for note in recording.notes if note not in notes)
        for one in implausible(recording):
            problems.append(DatasetFileError(entry.path_of(one.sensor), f"{one.sensor} {one.found}", one.expected))
        if recording.has_sensor_noise:
            noises += _noise_of(recording)
        if (in_plane := plane_powers(recording)) is not None:
            powers.append(in_plane)
        readable.append(entry)
        durations.append(recording.duration_seconds)
        clocks["acceleration"].append(_clock(recording.acceleration_time_seconds))
        clocks["force"].append(_clock(recording.force_time_seconds))
        clocks["position"].append(_clock(recording.position_time_seconds))
        vibration = np.linalg.norm(recording.vibration_g, axis=1)
        for quantity, values in zip(_UNITS, (vibration, recording.force_newtons, recording.speeds_mmps), strict=True):
            quantiles[quantity].append(np.quantile(np.asarray(values, dtype=np.float64), _QUANTILES))
    problems.sort(key=lambda problem: str(problem.path))
    return {
        "version": _REPORT_VERSION,
        "root": str(dataset.root),
        "provenance": dataset.provenance,
        "recordings": len(readable),
        "unlabelled": len(dataset.unlabelled),
        "audio_files": dataset.audio_files,
        "counts": _counts(readable),
        "clocks": {
            sensor: dict(zip(("rate_hz", "irregularity"), np.median(found, axis=0).tolist(), strict=True))
            for sensor, found in clocks.items()
        },
        "ranges": {quantity: _range(_UNITS[quantity], np.array(found)) for quantity, found in quantiles.items()},
        "sensor_noise": _noise_report(noises),
        "apparatus": {"band_hz": list(BAND_HZ), "x_over_y_db": x_over_y_db(powers)},
        "duration_seconds": {
            "total": float(np.sum(durations)),
            **{
                name: float(of(durations)) if durations else 0.0
                for name, of in (("shortest", np.min), ("median", np.median), ("longest", np.max))
            },
        },
        "coverage": _coverage(readable),
        "notes": notes,
        "problems": [
            {"file": str(problem.path), "found": problem.found, "expected": problem.expected} for problem in problems
        ],
    }


def _noise_of(recording: Recording) -> list[SensorNoise]:
    """What training will remove; nothing for a recording that it will leave out."""
    try:
        return [preprocess_parts(recording)[0].noise]
    except InputError:
        return []


def _noise_report(noises: list[SensorNoise]) -> dict[str, Any]:
    """Recordings by where their noise was found; and the least, the median and the most of it."""
    found = [noise.rms_mps2 for noise in noises if noise.source != "none"]
    levels = np.quantile(found, (0.0, 0.5, 1.0)).tolist() if found else None
    return {"from": dict(Counter(noise.source for noise in noises)), "mps2": levels}


def _counts(readable: list[RecordingFile]) -> dict[str, dict[str, int]]:
    """The number of recordings by each part of a name, in ascending order."""
    identities = [entry.identity for entry in readable]
    machine = [identity for identity in identities if identity.protocol == "machine"]
    return {
        "protocol": _counted(identity.protocol for identity in identities),
        "material": dict(Counter(entry.label for entry in readable)),
        **{axis: _counted(getattr(identity, axis) for identity in machine) for axis in _GRID},
    }


def _coverage(readable: list[RecordingFile]) -> list[dict[str, Any]]:
    """For each material: recordings, and the occurring conditions of the machine grid over the possible ones.

    The grid is every direction x speed x force x repeat that any material of this folder has.
    """
    by_material: dict[str, list[RecordingIdentity]] = defaultdict(list)
    for entry in readable:
        by_material[entry.label].append(entry.identity)
    machine = [entry.identity for entry in readable if entry.identity.protocol == "machine"]
    grid = int(np.prod([len({getattr(identity, axis) for identity in machine}) for axis in _GRID]))
    return [
        {
            "material": material,
            "machine": sum(identity.protocol == "machine" for identity in identities),
            "machine_grid": grid,
            "hand": sum(identity.protocol == "hand" for identity in identities),
        }
        for material, identities in by_material.items()
    ]


def _range(unit: str, found: NDArray[np.float64]) -> dict[str, Any]:
    """Over the recordings: the lowest 1st percentile, the median of medians, the highest 99th percentile."""
    low, middle, high = float(found[:, 0].min()), float(np.median(found[:, 1])), float(found[:, 2].max())
    return {"unit": unit, "low": low, "middle": middle, "high": high}


def _clock(time: NDArray[np.float64]) -> tuple[float, float]:
    """Rows per second, and (95th - 5th percentile) of the steps over their median, 0 for an even clock."""
    low, middle, high = np.percentile(np.diff(time), [5, 50, 95])
    return (len(time) - 1) / float(time[-1] - time[0]), float((high - low) / middle)


def _counted(values: Iterable[Any]) -> dict[str, int]:
    return {str(value): count for value, count in sorted(Counter(values).items())}
