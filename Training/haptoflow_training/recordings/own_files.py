"""A user's own recordings, one file each: CSV or Parquet table, or WAV, with a sidecar for constants."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy import signal

from haptoflow_training.recordings.cluster_dataset_files import open_table
from haptoflow_training.recordings.dataset import UNKNOWN
from haptoflow_training.recordings.dataset_layout import beside, ending_of, sidecar_of
from haptoflow_training.recordings.native_recording import NativeRecording, Track, read_native
from haptoflow_training.recordings.recording import STANDARD_GRAVITY_MPS2, Recording, RecordingIdentity

OWN_ENDINGS = (".csv", ".parquet", ".wav", ".w64")
DEFAULTS_FILE = "recordings.json"
_MOTION_MARK = ".motion"
# Above this rate a recording is filtered before it is resampled, to prevent aliasing.
_MAXIMUM_UNFILTERED_HZ = 8400.0
_KEPT_HZ = 2500.0
_CONSTANT_STEPS = 64


@dataclass(frozen=True)
class OwnRecordingFile:
    """One recording on disk, as its sidecar and the names of its columns describe it; `load` reads it. Can be passed
    to another process. identity: its name, without the conditions that published names contain. label: empty if not
    stated."""

    path: Path
    identity: RecordingIdentity
    label: str
    licence: str
    source: str
    motion_path: Path | None
    notes: tuple[str, ...]

    @property
    def paths(self) -> tuple[Path, ...]:
        """Every file that the recording is made from."""
        others = (sidecar_of(self.path), beside(self.path, DEFAULTS_FILE), self.motion_path)
        return (self.path, *(path for path in others if path is not None and path.is_file()))

    def path_of(self, sensor: str) -> Path:
        """The file of acceleration, force or position."""
        return self.path if sensor == "acceleration" or self.motion_path is None else self.motion_path

    def load(self) -> Recording:
        """Read the recording. DatasetFileError (an InputError) names file, column or key, what was found and what is
        expected."""
        return _recording(read_own(self.path), self.identity, self.label)


def read_own(path: Path) -> NativeRecording:
    """The recording as the library reads it; DatasetFileError as of `OwnRecordingFile.load`."""
    return _read(path, samples=True)


def described_file(path: Path, name: str) -> OwnRecordingFile:
    """The file under a name of its own; DatasetFileError if its sidecar or the names of its columns are wrong."""
    read = _read(path, samples=False)
    identity = RecordingIdentity(0, None, 0, 0, 0, name)
    licence, source = read.licence or UNKNOWN, read.source or UNKNOWN
    return OwnRecordingFile(path, identity, read.label, licence, source, read.motion_path, read.notes)


def is_motion_file(path: Path) -> bool:
    """Whether the file's name marks it as the motion of another recording (NAME.motion.csv)."""
    return path.stem.lower().endswith(_MOTION_MARK)


def _read(path: Path, *, samples: bool) -> NativeRecording:
    if ending_of(path) != ".parquet":
        return read_native(path, samples=samples, complete=samples)
    # The library reads text: a Parquet table becomes CSV here, and the files beside it go along.
    table = path.with_suffix(".csv").name
    files = {table: _as_csv(path)}
    for other in (sidecar_of(path), beside(path, DEFAULTS_FILE)):
        if other.is_file():
            files[other.name] = other.read_bytes()
    for motion in _named_motions(list(files.values())[1:]):
        named = beside(path, motion)
        if named.is_file():
            files[motion] = _as_csv(named) if ending_of(named) == ".parquet" else named.read_bytes()
    return read_native(Path(table), files, samples=samples, complete=samples)


def _as_csv(path: Path) -> bytes:
    return bytes(open_table(path, "a table of a recording").to_csv(index=False).encode())


def _named_motions(sidecars: Iterable[bytes]) -> list[str]:
    names = []
    for text in sidecars:
        try:
            motion = json.loads(text).get("motion")
        except (ValueError, AttributeError):
            continue
        names += [motion] if isinstance(motion, str) and Path(motion).name == motion else []
    return names


def _recording(read: NativeRecording, identity: RecordingIdentity, label: str) -> Recording:
    """Three sensors with clocks of their own; a single axis stays a single axis."""
    assert read.acceleration is not None
    span = (float(read.acceleration.time_seconds[0]), float(read.acceleration.time_seconds[-1]))
    velocity: NDArray[np.float64] | None = None
    if read.has_positions:
        assert read.motion is not None
        position_time, position_mm = read.motion.time_seconds, 1e3 * read.motion.values
    else:
        motion = read.motion or _constant(span, np.array(read.velocity_mps))
        position_time, velocity = motion.time_seconds, motion.values
        steps = 0.5 * (velocity[1:] + velocity[:-1]) * np.diff(position_time)[:, None]
        position_mm = 1e3 * np.concatenate([np.zeros((1, 2)), np.cumsum(steps, axis=0)])
    force = read.force or _constant(span, np.array([read.force_newtons]))
    time, values = _band_limited(read.acceleration)
    return Recording(
        identity, label, time, values / STANDARD_GRAVITY_MPS2, force.time_seconds, force.values[:, 0], position_time,
        position_mm, velocity_mps=velocity, has_sensor_noise=read.motion is not None, notes=read.notes,
    )  # fmt: skip


def _constant(span: tuple[float, float], values: NDArray[np.float64]) -> Track:
    return Track(np.linspace(*span, _CONSTANT_STEPS), np.tile(values, (_CONSTANT_STEPS, 1)))


def _band_limited(acceleration: Track) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Times and values; a recording at a high rate is low-passed and decimated."""
    time, values = acceleration.time_seconds, acceleration.values
    step = float(np.median(np.diff(time)))
    stride = int(1.0 / (step * 8000.0))
    if 1.0 / step <= _MAXIMUM_UNFILTERED_HZ or stride < 1 or len(time) < 64:
        return time, values
    sections = signal.butter(6, _KEPT_HZ, "lowpass", fs=1.0 / step, output="sos")
    filtered = signal.sosfiltfilt(sections, values, axis=0, padlen=min(len(values) - 1, round(30 * 0.0004 / step)))
    return time[::stride], filtered[::stride]
