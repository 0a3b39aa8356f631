"""A user's own recording, read by the native library: one reader for the command line, Unity and training."""

from __future__ import annotations

import ctypes
import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.native_library import NativeError, native_library, options_of
from haptoflow_training.recordings.cluster_dataset_files import DatasetFileError

_EXPECTED = "; expected "


class _File(ctypes.Structure):
    _fields_ = [("name", ctypes.c_char_p), ("bytes", ctypes.c_char_p), ("byte_count", ctypes.c_uint64)]


class _Options(ctypes.Structure):
    _fields_ = [
        ("struct_size", ctypes.c_uint32),
        ("file_count", ctypes.c_uint32),
        ("path", ctypes.c_char_p),
        ("files", ctypes.POINTER(_File)),
        ("full_scale_mps2", ctypes.c_double),
        ("without_samples", ctypes.c_uint32),
        ("needs_motion_and_force", ctypes.c_uint32),
    ]


class _Track(ctypes.Structure):
    _fields_ = [
        ("seconds", ctypes.POINTER(ctypes.c_double)),
        ("values", ctypes.POINTER(ctypes.c_double)),
        ("count", ctypes.c_uint64),
        ("width", ctypes.c_uint64),
    ]


class _Info(ctypes.Structure):
    _fields_ = [
        ("struct_size", ctypes.c_uint32),
        ("axis_count", ctypes.c_uint32),
        ("sample_rate_hz", ctypes.c_double),
        ("sample_count", ctypes.c_uint64),
        ("acceleration_mps2", ctypes.POINTER(ctypes.c_float)),
        ("velocity_mps", ctypes.POINTER(ctypes.c_float)),
        ("force_newtons", ctypes.POINTER(ctypes.c_float)),
        ("constant_velocity_mps", ctypes.c_double * 2),
        ("constant_force_newtons", ctypes.c_double),
        ("acceleration", _Track),
        ("motion", _Track),
        ("force", _Track),
        ("motion_is_position", ctypes.c_uint32),
        ("reserved", ctypes.c_uint32),
        ("label", ctypes.c_char_p),
        ("licence", ctypes.c_char_p),
        ("source", ctypes.c_char_p),
        ("motion_path", ctypes.c_char_p),
        ("notes", ctypes.c_char_p),
        ("material_name", ctypes.c_char_p),
        ("provenance", ctypes.c_char_p),
    ]


@dataclass(frozen=True)
class Track:
    """Readings of one sensor at its own times. time_seconds: [n], increasing. values: [n, width] in SI units."""

    time_seconds: NDArray[np.float64]
    values: NDArray[np.float64]


@dataclass(frozen=True)
class EvenRecording:
    """Samples at one rate. acceleration_mps2: [n, 1 or 3], not finite in a gap. velocity_mps: [n, 2], force_newtons: [n];
    None where the constant holds for every sample."""

    rate_hz: float
    acceleration_mps2: NDArray[np.float32]
    velocity_mps: NDArray[np.float32] | None
    force_newtons: NDArray[np.float32] | None
    constant_velocity_mps: tuple[float, float] = (0.0, 0.0)
    constant_force_newtons: float = 0.0


@dataclass(frozen=True)
class NativeRecording:
    """A recording as the library reads it (haptoflow_recording_info in haptoflow.h).

    even: the form in which the library learns; None if only described. acceleration: m/s^2; None if only described.
    motion: velocities in m/s, or positions in m if has_positions. velocity_mps, force_newtons: constants. notes: one
    sentence each. material_name: what `haptoflow learn` calls the material.
    """

    label: str
    material_name: str
    licence: str
    source: str
    motion_path: Path | None
    notes: tuple[str, ...]
    even: EvenRecording | None
    acceleration: Track | None
    motion: Track | None
    has_positions: bool
    force: Track | None
    velocity_mps: tuple[float, float] | None
    force_newtons: float | None


def read_native(
    path: Path, files: Mapping[str, bytes] | None = None, *, samples: bool = True, complete: bool = False
) -> NativeRecording:
    """Read a recording with the files beside it; `files` by name replace those on disk.

    samples: False for the sidecar and the column names only. complete: refuse a recording without motion or force.
    DatasetFileError names file, line and column or key, what was found and what is expected.
    """
    library = native_library()
    given = [_File(os.fsencode(name), content, len(content)) for name, content in (files or {}).items()]
    options = options_of(
        _Options,
        file_count=len(given),
        path=os.fsencode(path),
        files=(_File * len(given))(*given) if given else None,
        without_samples=not samples,
        needs_motion_and_force=complete,
    )
    handle = ctypes.c_void_p()
    try:
        library.call("haptoflow_recording_read", ctypes.byref(options), ctypes.byref(handle))
    except NativeError as error:
        raise _as_file_error(path, str(error)) from error
    try:
        info = options_of(_Info)
        library.call("haptoflow_recording_get_info", handle, ctypes.byref(info))
        return _copied(info)
    finally:
        library.call("haptoflow_recording_close", ctypes.byref(handle))


@contextmanager
def as_native(recording: EvenRecording, provenance: str = "") -> Iterator[ctypes.c_void_p]:
    """A handle of the library for samples, which it copies. provenance: of a material that is learnt from them."""
    floats = ctypes.POINTER(ctypes.c_float)
    given = [recording.acceleration_mps2, recording.velocity_mps, recording.force_newtons]
    arrays = [None if each is None else np.ascontiguousarray(each, np.float32) for each in given]
    acceleration, velocity, force = (None if each is None else each.ctypes.data_as(floats) for each in arrays)
    info = options_of(
        _Info,
        axis_count=recording.acceleration_mps2.shape[1],
        sample_rate_hz=recording.rate_hz,
        sample_count=len(recording.acceleration_mps2),
        acceleration_mps2=acceleration,
        velocity_mps=velocity,
        force_newtons=force,
        constant_velocity_mps=(ctypes.c_double * 2)(*recording.constant_velocity_mps),
        constant_force_newtons=recording.constant_force_newtons,
        provenance=provenance.encode(),
    )
    library = native_library()
    handle = ctypes.c_void_p()
    library.call("haptoflow_recording_create", ctypes.byref(info), ctypes.byref(handle))
    try:
        yield handle
    finally:
        library.call("haptoflow_recording_close", ctypes.byref(handle))


def _as_file_error(path: Path, message: str) -> DatasetFileError:
    """The library's sentence `PLACE: found; expected what`, in parts."""
    head, _, expected = message.partition(_EXPECTED)
    place, found = head.split(": ", 1) if ": " in head else (str(path), head)
    return DatasetFileError(Path(place), found, expected or "another file")


def _track(track: _Track) -> Track | None:
    if track.count == 0:
        return None
    seconds = np.ctypeslib.as_array(track.seconds, (track.count,)).copy()
    return Track(seconds, np.ctypeslib.as_array(track.values, (track.count, track.width)).copy())


def _even(info: _Info, velocity: tuple[float, float] | None, force: float | None) -> EvenRecording | None:
    if not info.acceleration_mps2:
        return None
    count = info.sample_count

    def values(pointer: Any, *shape: int) -> NDArray[np.float32]:
        return np.asarray(np.ctypeslib.as_array(pointer, shape).copy())

    return EvenRecording(
        info.sample_rate_hz,
        values(info.acceleration_mps2, count, info.axis_count),
        values(info.velocity_mps, count, 2) if info.velocity_mps else None,
        values(info.force_newtons, count) if info.force_newtons else None,
        constant_velocity_mps=velocity or (0.0, 0.0),
        constant_force_newtons=force or 0.0,
    )


def _text(content: bytes) -> str:
    """A sentence or a name: whatever bytes a file's name has, they can be printed."""
    return content.decode("utf-8", "backslashreplace")


def _copied(info: _Info) -> NativeRecording:
    x, y = info.constant_velocity_mps[:]
    velocity = None if np.isnan(x) else (x, y)
    force = None if np.isnan(info.constant_force_newtons) else info.constant_force_newtons
    motion_path = os.fsdecode(info.motion_path)
    return NativeRecording(
        label=_text(info.label),
        material_name=_text(info.material_name),
        licence=_text(info.licence),
        source=_text(info.source),
        motion_path=Path(motion_path) if motion_path else None,
        notes=tuple(_text(info.notes).split("\n")) if info.notes else (),
        even=_even(info, velocity, force),
        acceleration=_track(info.acceleration),
        motion=_track(info.motion),
        has_positions=bool(info.motion_is_position),
        force=_track(info.force),
        velocity_mps=velocity,
        force_newtons=force,
    )
