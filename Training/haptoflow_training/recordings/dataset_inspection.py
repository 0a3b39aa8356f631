"""Reports the contents of a data set folder: counts, clocks, durations, coverage, and every broken file."""

from __future__ import annotations

import dataclasses
from collections import Counter, defaultdict
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.preprocessing.plausibility import implausible
from haptoflow_training.recordings.cluster_dataset import DatasetProblem
from haptoflow_training.recordings.cluster_dataset_files import DatasetFileError
from haptoflow_training.recordings.open_recordings import Dataset, RecordingFile
from haptoflow_training.recordings.recording import Recording, RecordingIdentity

SENSORS = ("acceleration", "force", "position")
_UNITS = {"vibration": "g", "force": "N", "speed": "mm/s"}
_QUANTILES = (0.01, 0.5, 0.99)
_REPORT_VERSION = 1


@dataclass(frozen=True)
class ClockSummary:
    """One sensor's clock over all recordings. rate_hz: median of rows per second. irregularity: median
    over the recordings of (95th - 5th percentile) of the steps over their median, 0 for an even clock.
    """

    rate_hz: float
    irregularity: float


@dataclass(frozen=True)
class RangeSummary:
    """Range of one quantity over the recordings: the lowest 1st percentile, the median of medians, the highest 99th
    percentile."""

    unit: str
    low: float
    middle: float
    high: float


@dataclass(frozen=True)
class Inspection:
    """Counts cover readable recordings; problems are in the order of the files."""

    dataset: Dataset
    readable: tuple[RecordingFile, ...]
    durations_seconds: tuple[float, ...]
    clocks: dict[str, ClockSummary]
    ranges: dict[str, RangeSummary]
    problems: tuple[DatasetProblem, ...]

    def counts(self) -> dict[str, dict[str, int]]:
        """The number of recordings by each part of a name, in ascending order."""
        identities = [entry.identity for entry in self.readable]
        machine = [identity for identity in identities if identity.protocol == "machine"]
        return {
            "protocol": _counted(identity.protocol for identity in identities),
            "material": _counted_in_order(entry.label for entry in self.readable),
            "speed_mmps": _counted(identity.speed_mmps for identity in machine),
            "direction_degrees": _counted(identity.direction_degrees for identity in machine),
            "force_millinewtons": _counted(identity.force_millinewtons for identity in machine),
            "repeat": _counted(identity.repeat for identity in machine),
        }

    def coverage(self) -> list[dict[str, Any]]:
        """For each material: recordings, and the occurring conditions of the machine grid over the possible ones.

        The grid is every direction x speed x force x repeat that any material of this folder has.
        """
        grid = _grid_size(entry.identity for entry in self.readable)
        by_material: dict[str, list[RecordingIdentity]] = defaultdict(list)
        for entry in self.readable:
            by_material[entry.label].append(entry.identity)
        return [
            {
                "material": material,
                "machine": sum(identity.protocol == "machine" for identity in identities),
                "machine_grid": grid,
                "hand": sum(identity.protocol == "hand" for identity in identities),
            }
            for material, identities in by_material.items()
        ]

    def to_json(self) -> dict[str, Any]:
        durations = np.array(self.durations_seconds)
        return {
            "version": _REPORT_VERSION,
            "root": str(self.dataset.root),
            "provenance": self.dataset.provenance,
            "recordings": len(self.readable),
            "unlabelled": len(self.dataset.unlabelled),
            "audio_files": self.dataset.audio_files,
            "counts": self.counts(),
            "clocks": {
                sensor: {"rate_hz": clock.rate_hz, "irregularity": clock.irregularity}
                for sensor, clock in self.clocks.items()
            },
            "ranges": {quantity: dataclasses.asdict(found) for quantity, found in self.ranges.items()},
            "duration_seconds": {
                "total": float(durations.sum()),
                "shortest": float(durations.min()) if len(durations) else 0.0,
                "median": float(np.median(durations)) if len(durations) else 0.0,
                "longest": float(durations.max()) if len(durations) else 0.0,
            },
            "coverage": self.coverage(),
            "notes": list(self.dataset.notes),
            "problems": [
                {"file": str(problem.path), "found": problem.found, "expected": problem.expected}
                for problem in self.problems
            ],
        }


def inspect_dataset(
    dataset: Dataset, recordings: Iterable[RecordingFile] | None = None
) -> Inspection:
    """Read every recording once, one at a time; `recordings` may wrap `dataset` to show progress.

    A broken file is reported as a problem, and so is an apparent wrong unit or glitch; InputError is raised only if no
    Parquet engine is installed.
    """
    readable: list[RecordingFile] = []
    durations: list[float] = []
    clocks: dict[str, list[tuple[float, float]]] = {sensor: [] for sensor in SENSORS}
    quantiles: dict[str, list[NDArray[np.float64]]] = {quantity: [] for quantity in _UNITS}
    problems = list(dataset.problems)
    for entry in dataset if recordings is None else recordings:
        try:
            recording = entry.load()
        except DatasetFileError as error:
            problems.append(DatasetProblem(error.path, error.found, error.expected))
            continue
        problems.extend(_implausible(entry, recording))
        readable.append(entry)
        durations.append(recording.duration_seconds)
        for sensor, time in _clocks(recording):
            clocks[sensor].append(_clock(time))
        for quantity, values in _quantities(recording):
            quantiles[quantity].append(np.quantile(values, _QUANTILES))
    summaries = {
        sensor: ClockSummary(*(float(value) for value in np.median(np.array(found), axis=0)))
        for sensor, found in clocks.items()
        if found
    }
    problems.sort(key=lambda problem: str(problem.path))
    ranges = {quantity: _range(quantity, np.array(found)) for quantity, found in quantiles.items() if found}
    return Inspection(dataset, tuple(readable), tuple(durations), summaries, ranges, tuple(problems))


def _quantities(recording: Recording) -> Iterable[tuple[str, NDArray[np.float64]]]:
    yield "vibration", np.linalg.norm(recording.vibration_g, axis=1)
    yield "force", np.asarray(recording.force_newtons, dtype=np.float64)
    yield "speed", recording.speeds_mmps


def _range(quantity: str, found: NDArray[np.float64]) -> RangeSummary:
    low, middle, high = float(found[:, 0].min()), float(np.median(found[:, 1])), float(found[:, 2].max())
    return RangeSummary(_UNITS[quantity], low, middle, high)


def _implausible(entry: RecordingFile, recording: Recording) -> Iterable[DatasetProblem]:
    for problem in implausible(recording):
        yield DatasetProblem(entry.path_of(problem.sensor), f"{problem.sensor} {problem.found}", problem.expected)


def _clocks(recording: Recording) -> Iterable[tuple[str, NDArray[np.float64]]]:
    times = (
        recording.acceleration_time_seconds, recording.force_time_seconds, recording.position_time_seconds
    )
    return zip(SENSORS, times, strict=True)


def _clock(time: NDArray[np.float64]) -> tuple[float, float]:
    steps = np.diff(time)
    low, middle, high = np.percentile(steps, [5, 50, 95])
    return (len(time) - 1) / float(time[-1] - time[0]), float((high - low) / middle)


def _counted(values: Iterable[Any]) -> dict[str, int]:
    return {str(value): count for value, count in sorted(Counter(values).items())}


def _counted_in_order(values: Iterable[str]) -> dict[str, int]:
    return dict(Counter(values))


def _grid_size(identities: Iterable[RecordingIdentity]) -> int:
    machine = [identity for identity in identities if identity.protocol == "machine"]
    axes = ("direction_degrees", "speed_mmps", "force_millinewtons", "repeat")
    sizes = [len({getattr(identity, axis) for identity in machine}) for axis in axes]
    return int(np.prod(sizes))
