"""A user's own recordings, one file each: CSV or Parquet table, or WAV, with a sidecar for constants; and a folder of them as a
data set."""

from __future__ import annotations

import ctypes
import json
import os
from collections.abc import Iterable
from contextlib import AbstractContextManager
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy import signal

from haptoflow_training.errors import InputError
from haptoflow_training.recordings.cluster_dataset_files import DatasetFileError, open_table
from haptoflow_training.recordings.dataset import UNKNOWN, Dataset
from haptoflow_training.recordings.dataset_layout import beside, ending_of, sidecar_of
from haptoflow_training.recordings.labels import LabelMap
from haptoflow_training.recordings.native_recording import NativeRecording, Track, opened_native, read_native
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
    return read_native(*_readable(path))


def open_own(path: Path) -> AbstractContextManager[ctypes.c_void_p]:
    """The library's handle of the recording; as `read_own`."""
    return opened_native(*_readable(path))


def described_file(path: Path, name: str) -> OwnRecordingFile:
    """The file under a name of its own; DatasetFileError if its sidecar or the names of its columns are wrong."""
    read = read_native(*_readable(path), samples=False)
    identity = RecordingIdentity(0, None, 0, 0, 0, name)
    licence, source = read.licence or UNKNOWN, read.source or UNKNOWN
    return OwnRecordingFile(path, identity, read.label, licence, source, read.motion_path, read.notes)


def _readable(path: Path) -> tuple[Path, dict[str, bytes]]:
    """The library reads text: a Parquet table becomes CSV here, and the files beside it go along."""
    if ending_of(path) != ".parquet":
        return path, {}
    table = path.with_suffix(".csv").name
    files = {table: _as_csv(path)}
    for other in (sidecar_of(path), beside(path, DEFAULTS_FILE)):
        if other.is_file():
            files[other.name] = other.read_bytes()
    for motion in _named_motions(list(files.values())[1:]):
        named = beside(path, motion)
        if named.is_file():
            files[motion] = _as_csv(named) if ending_of(named) == ".parquet" else named.read_bytes()
    return Path(table), files


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


def open_own_dataset(root: Path, labels: LabelMap | None = None) -> Dataset:
    """Index a folder with its subfolders, or one file; reads sidecars and headings, but no samples.

    Without `labels` a recording's label is the one in its sidecar. InputError if the path does not exist or holds no
    recording.
    """
    base = root.parent if root.is_file() else root
    broken: dict[Path, DatasetFileError] = {}
    described: list[OwnRecordingFile] = []
    for path in _files(root):
        try:
            described.append(described_file(path, _name(path.relative_to(base))))
        except DatasetFileError as error:
            broken[path] = error
    motions = {entry.motion_path.resolve() for entry in described if entry.motion_path is not None}
    complete: list[OwnRecordingFile] = []
    unlabelled: list[OwnRecordingFile] = []
    notes: list[str] = []
    for entry in described:
        if _is_motion(entry.path, motions):
            continue
        notes.extend(entry.notes)
        label = entry.label if labels is None else labels.label_of(-1, entry.label) if entry.label else None
        (complete if label else unlabelled).append(replace(entry, label=label or entry.label))
    problems = [error for path, error in broken.items() if not _is_motion(path, motions)]
    entries = [*complete, *unlabelled]
    provenance = {
        key: ", ".join(dict.fromkeys(getattr(entry, key) for entry in entries)) or UNKNOWN
        for key in ("source", "licence")
    }
    return Dataset(
        root, tuple(complete), tuple(unlabelled), tuple(problems), {**provenance, "synthetic": False},
        _left_out(root, unlabelled), tuple(notes), is_own=True,
    )  # fmt: skip


def _name(path: Path) -> str:
    """Also of bytes that are not UTF-8, which no report and no store could hold."""
    return os.fsencode(path.as_posix()).decode("utf-8", "backslashreplace")


def _is_motion(path: Path, named: set[Path]) -> bool:
    """Whether the file is the motion of another recording: by its name (NAME.motion.csv), or because a sidecar names
    it."""
    return path.stem.lower().endswith(_MOTION_MARK) or path.resolve() in named


def _left_out(root: Path, unlabelled: list[OwnRecordingFile]) -> str:
    if not unlabelled:
        return ""
    nameless = [entry.identity.name for entry in unlabelled if not entry.label]
    named = dict.fromkeys(entry.label for entry in unlabelled if entry.label)
    reasons = [f"no sidecar has a key 'label' for {', '.join(nameless)}"] if nameless else []
    reasons += [f"no label of the labels file names {', '.join(named)}"] if named else []
    return f"{root}: {len(unlabelled)} recordings are left out: {'; '.join(reasons)}"


def _files(root: Path) -> list[Path]:
    if root.is_file():
        if ending_of(root) not in OWN_ENDINGS:
            raise InputError(f"{root}: expected a recording that ends with {', '.join(OWN_ENDINGS)}")
        return [root]
    if not root.is_dir():
        raise InputError(
            f"{root}: does not exist; expected the folder that holds sensor_data, a folder of recordings, or one file"
        )
    found = [path for path in root.rglob("*") if ending_of(path) in OWN_ENDINGS and path.is_file()]
    visible = [path for path in found if not any(part.startswith(".") for part in path.relative_to(root).parts)]
    if not visible:
        raise InputError(
            f"{root}: no recording in it; expected files that end with {', '.join(OWN_ENDINGS)}, or the folder that "
            "holds sensor_data"
        )
    return sorted(visible)
