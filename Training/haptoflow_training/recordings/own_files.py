"""A user's own recordings, one file each: CSV or Parquet table, or WAV, with a sidecar for constants."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy import signal

from haptoflow_training.recordings.cluster_dataset_files import DatasetFileError
from haptoflow_training.recordings.file_names import beside, ending_of, sidecar_of
from haptoflow_training.recordings.own_sidecar import (
    DEFAULTS_FILE, MAXIMUM_RATE_HZ, MINIMUM_RATE_HZ, Sidecar, read_sidecar,
)  # fmt: skip
from haptoflow_training.recordings.own_table import (
    FORCE_FORMS,
    POSITION_FORMS,
    VELOCITY_FORMS,
    OwnTable,
    Series,
    is_position,
    misread_units,
    names_of,
    read_own_table,
    velocity_of,
)
from haptoflow_training.recordings.own_wav import read_own_wav
from haptoflow_training.recordings.recording import STANDARD_GRAVITY_MPS2, Recording, RecordingIdentity

TABLE_ENDINGS = (".csv", ".parquet")
OWN_ENDINGS = (*TABLE_ENDINGS, ".wav")
_MOTION_MARK = ".motion"
# Above this rate a recording is filtered before it is resampled, to prevent aliasing.
_MAXIMUM_UNFILTERED_HZ = 8400.0
_KEPT_HZ = 2500.0
_CONSTANT_STEPS = 64


@dataclass(frozen=True)
class OwnRecordingFile:
    """One recording on disk; `load` reads it. Can be passed to another process."""

    path: Path
    identity: RecordingIdentity
    label: str

    @cached_property
    def sidecar(self) -> Sidecar:
        return read_sidecar(self.path)

    @property
    def paths(self) -> tuple[Path, ...]:
        """Every file that the recording is made from."""
        others = (sidecar_of(self.path), beside(self.path, DEFAULTS_FILE), self.sidecar.motion)
        return (self.path, *(path for path in others if path is not None and path.is_file()))

    def path_of(self, sensor: str) -> Path:
        """The file of acceleration, force or position."""
        motion = self.sidecar.motion
        return self.path if sensor == "acceleration" or motion is None else motion

    def load(self) -> Recording:
        """Read the recording. DatasetFileError (an InputError) names file, column or key, what was found and what is
        expected."""
        return read_own_recording(self.path, self.identity, self.label)


def own_identity(name: str) -> RecordingIdentity:
    """The identity of an own file: its name, without the conditions that published names contain."""
    return RecordingIdentity(0, None, 0, 0, 0, name)


def is_motion_file(path: Path) -> bool:
    """Whether the file's name marks it as the motion of another recording (NAME.motion.csv)."""
    return path.stem.lower().endswith(_MOTION_MARK)


def read_own_recording(path: Path, identity: RecordingIdentity, label: str) -> Recording:
    """Read one recording with its sidecar and motion file; a single axis stays a single axis.

    DatasetFileError names file, column or key, what was found and what is expected.
    """
    sidecar = read_sidecar(path)
    tables: list[OwnTable] = []
    if ending_of(path) == ".wav":
        acceleration = read_own_wav(path, sidecar)
    else:
        table = read_own_table(path, sidecar.rate_hz)
        tables.append(table)
        assert table.acceleration is not None
        acceleration = table.acceleration
        _require_rate(path, acceleration)
    if sidecar.motion is not None:
        tables.append(read_own_table(sidecar.motion, None, with_acceleration=False))
    for table in tables:
        for problem in misread_units(table):
            raise problem
    span = (float(acceleration.time_seconds[0]), float(acceleration.time_seconds[-1]))
    motion = _one(path, [table.motion for table in tables], "motion")
    force = _one(path, [table.force for table in tables], "force")
    position_time, position_mm, velocity = _motion(path, sidecar, motion, span)
    force_time, force_newtons = _force(path, sidecar, force, span)
    time, values = _band_limited(acceleration)
    return Recording(
        identity, label, time, values / STANDARD_GRAVITY_MPS2, force_time, force_newtons, position_time, position_mm,
        velocity_mps=velocity,
    )  # fmt: skip


def _one(path: Path, found: Iterable[Series | None], what: str) -> Series | None:
    present = [series for series in found if series is not None]
    if len(present) > 1:
        raise DatasetFileError(path, f"{what} in the table and in the motion file", f"{what} in one of them")
    return present[0] if present else None


def _require_rate(path: Path, acceleration: Series) -> None:
    rate_hz = 1.0 / float(np.median(np.diff(acceleration.time_seconds)))
    if not 0.99 * MINIMUM_RATE_HZ <= rate_hz <= 1.01 * MAXIMUM_RATE_HZ:
        expected = "1000 to 192000 (time_s is in seconds)"
        raise DatasetFileError(path, f"{rate_hz:.4g} samples a second by time_s", expected)


def _motion(
    path: Path, sidecar: Sidecar, motion: Series | None, span: tuple[float, float]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64] | None]:
    """Times, positions in mm, and the velocities in m/s if they were recorded."""
    if motion is None:
        if sidecar.velocity_mps is None:
            expected = (
                f"motion: columns {names_of(VELOCITY_FORMS + POSITION_FORMS)}; or the key speed_mps, velocity_mps or "
                f"motion in {sidecar.path.name}"
            )
            raise DatasetFileError(path, "no motion in its columns or beside it", expected)
        time = np.linspace(*span, _CONSTANT_STEPS)
        velocity = np.tile(np.array(sidecar.velocity_mps), (_CONSTANT_STEPS, 1))
    elif is_position(motion):
        time, position = _read_anew(motion)
        return time, 1e3 * position, None
    else:
        time, velocity = motion.time_seconds, velocity_of(motion)
    steps = 0.5 * (velocity[1:] + velocity[:-1]) * np.diff(time)[:, None]
    return time, 1e3 * np.concatenate([np.zeros((1, 2)), np.cumsum(steps, axis=0)]), velocity


def _read_anew(motion: Series) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Positions at the tracker's readings: rows that repeat the older reading are left out, because they would look
    like rest and jumps."""
    time, values = motion.time_seconds, motion.values
    changes = np.concatenate([[0], np.flatnonzero(np.any(np.diff(values, axis=0) != 0.0, axis=1)) + 1])
    period = int(np.median(np.diff(changes))) if len(changes) > 8 else 1
    if period < 2:
        return time, values
    # A resting tip is read too: a longer stretch without a change keeps a row for each expected reading.
    kept: list[int] = []
    for first, last in zip(changes, [*changes[1:], len(time)], strict=True):
        kept.extend(range(int(first), int(last) - period + 1, period) if last - first >= 2 * period else [int(first)])
    return time[kept], values[kept]


def _force(
    path: Path, sidecar: Sidecar, force: Series | None, span: tuple[float, float]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    if force is not None:
        return force.time_seconds, force.values[:, 0]
    if sidecar.force_newtons is None:
        expected = f"force: a column {names_of(FORCE_FORMS)}; or the key force_newtons in {sidecar.path.name}"
        raise DatasetFileError(path, "no force in its columns or beside it", expected)
    return np.linspace(*span, _CONSTANT_STEPS), np.full(_CONSTANT_STEPS, sidecar.force_newtons)


def _band_limited(acceleration: Series) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Times and values; a recording at a high rate is low-passed and decimated."""
    time, values = acceleration.time_seconds, acceleration.values
    step = float(np.median(np.diff(time)))
    stride = int(1.0 / (step * 8000.0))
    if 1.0 / step <= _MAXIMUM_UNFILTERED_HZ or stride < 1 or len(time) < 64:
        return time, values
    sections = signal.butter(6, _KEPT_HZ, "lowpass", fs=1.0 / step, output="sos")
    filtered = signal.sosfiltfilt(sections, values, axis=0, padlen=min(len(values) - 1, round(30 * 0.0004 / step)))
    return time[::stride], filtered[::stride]


__all__ = ["OWN_ENDINGS", "OwnRecordingFile", "is_motion_file", "own_identity", "read_own_recording"]
