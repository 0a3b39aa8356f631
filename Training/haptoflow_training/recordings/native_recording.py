"""A user's own recording, read by the native library: one reader for the command line, Unity and training."""

from __future__ import annotations

import ctypes
import os
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.native_library import NativeError, native_library, options_of
from haptoflow_training.recordings.cluster_dataset_files import DatasetFileError
from haptoflow_training.waveform import SAMPLE_RATE_HZ

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
class NativeRecording:
    """A recording as the library reads it (haptoflow_recording_info in haptoflow.h).

    acceleration: m/s^2; None if only described.
    motion: velocities in m/s, or positions in m if has_positions. velocity_mps, force_newtons: constants. notes: one
    sentence each. material_name: what `haptoflow learn` calls the material.
    """

    label: str
    material_name: str
    licence: str
    source: str
    motion_path: Path | None
    notes: tuple[str, ...]
    acceleration: Track | None
    motion: Track | None
    has_positions: bool
    force: Track | None
    velocity_mps: tuple[float, float] | None
    force_newtons: float | None


def read_native(path: Path, files: Mapping[str, bytes] | None = None, *, samples: bool = True) -> NativeRecording:
    """Read a recording with the files beside it; `files` by name replace those on disk. samples: False for the sidecar
    and the column names only.

    DatasetFileError names file, line and column or key, what was found and what is expected.
    """
    with opened_native(path, files, samples=samples) as handle:
        info = options_of(_Info)
        native_library().call("haptoflow_recording_get_info", handle, ctypes.byref(info))
        return _copied(info)


@contextmanager
def opened_native(
    path: Path, files: Mapping[str, bytes] | None = None, *, samples: bool = True
) -> Iterator[ctypes.c_void_p]:
    """The library's handle of a recording; as `read_native`."""
    given = [_File(os.fsencode(name), content, len(content)) for name, content in (files or {}).items()]
    options = options_of(
        _Options,
        file_count=len(given),
        path=os.fsencode(path),
        files=(_File * len(given))(*given) if given else None,
        without_samples=not samples,
        needs_motion_and_force=samples,
    )
    try:
        handle = _handle("haptoflow_recording_read", options)
    except NativeError as error:
        raise _as_file_error(path, str(error)) from error
    with _closing(handle):
        yield handle


@contextmanager
def as_native(
    wave_mps2: NDArray[np.float32], velocity_mps: NDArray[np.float32], force_newtons: NDArray[np.float32], origin: str = ""
) -> Iterator[ctypes.c_void_p]:
    """A handle of the library for samples at 2 kHz, which it copies: wave_mps2 [n, 1 or 3], not finite in a gap;
    velocity_mps [n, 2]; force_newtons [n]. origin: what a material that is learnt from them says of its recordings."""
    floats = ctypes.POINTER(ctypes.c_float)
    arrays = [np.ascontiguousarray(each, np.float32) for each in (wave_mps2, velocity_mps, force_newtons)]
    acceleration, velocity, force = (each.ctypes.data_as(floats) for each in arrays)
    info = options_of(
        _Info,
        axis_count=wave_mps2.shape[1],
        sample_rate_hz=SAMPLE_RATE_HZ,
        sample_count=len(wave_mps2),
        acceleration_mps2=acceleration,
        velocity_mps=velocity,
        force_newtons=force,
        provenance=origin.encode(),
    )
    with _closing(handle := _handle("haptoflow_recording_create", info)):
        yield handle


def _handle(function: str, options: ctypes.Structure) -> ctypes.c_void_p:
    handle = ctypes.c_void_p()
    native_library().call(function, ctypes.byref(options), ctypes.byref(handle))
    return handle


@contextmanager
def _closing(handle: ctypes.c_void_p) -> Iterator[None]:
    try:
        yield
    finally:
        native_library().call("haptoflow_recording_close", ctypes.byref(handle))


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
        acceleration=_track(info.acceleration),
        motion=_track(info.motion),
        has_positions=bool(info.motion_is_position),
        force=_track(info.force),
        velocity_mps=velocity,
        force_newtons=force,
    )


NoiseSource = Literal["none", "rest", "quiet part"]

_SOURCES: tuple[NoiseSource, ...] = ("none", "rest", "quiet part")
_POINTER = ctypes.POINTER(ctypes.c_float)


@dataclass(frozen=True)
class SensorNoise:
    """What a sensor adds to a recording. source: the part of the recording in which the noise was measured. rms_mps2: its
    RMS; 0 where none was found."""

    source: NoiseSource
    rms_mps2: float


NO_NOISE = SensorNoise("none", 0.0)


class MaterialRecording(NamedTuple):
    """One stretch without gaps, filtered and trimmed as for training. vibration_mps2: [n] at 2 kHz, m/s^2. motion:
    [n, 3]: vx, vy in m/s, force in N."""

    vibration_mps2: NDArray[np.float32]
    motion: NDArray[np.float32]


def _with_gaps(stretches: Sequence[MaterialRecording]) -> tuple[NDArray[np.float32], ...]:
    """Wave, velocity and force of all stretches; a sample that is not finite follows each and separates it from the
    next."""
    gap, still = np.full(1, np.nan, np.float32), np.zeros((1, 3), np.float32)
    wave = np.concatenate([piece for each in stretches for piece in (each.vibration_mps2, gap)])
    motion = np.concatenate([piece for each in stretches for piece in (each.motion, still)])
    return tuple(np.ascontiguousarray(values, np.float32) for values in (wave, motion[:, :2], motion[:, 2]))


def remove_sensor_noise(
    stretches: Sequence[MaterialRecording],
) -> tuple[list[NDArray[np.float32]], SensorNoise]:
    """The waveforms of the stretches of one recording without noise, and the noise of all. InputError if there is
    nothing but noise, or if the library is missing."""
    wave, velocity, force = _with_gaps(stretches)
    source, rms_mps2 = ctypes.c_int32(), ctypes.c_double()
    native_library().call(
        "haptoflow_recording_remove_noise", wave.ctypes.data_as(_POINTER), velocity.ctypes.data_as(_POINTER),
        force.ctypes.data_as(_POINTER), ctypes.c_uint64(len(wave)), ctypes.byref(source), ctypes.byref(rms_mps2),
    )  # fmt: skip
    parts = np.split(wave, np.cumsum([len(each.vibration_mps2) + 1 for each in stretches[:-1]]))
    return [part[:-1] for part in parts], SensorNoise(_SOURCES[source.value], rms_mps2.value)


# In cycles per millimetre.
WaveVector = tuple[float, float]


def estimate_wave_vectors(recordings: Sequence[MaterialRecording]) -> tuple[WaveVector, ...]:
    """Up to two vectors, the clearest first, 0.4 to 8 mm apart; none if the recordings show no ribs or cannot show them.
    InputError if the library is missing."""
    if not recordings:
        return ()
    wave, velocity, _ = _with_gaps(recordings)
    found = (ctypes.c_double * 4)()
    native_library().call(
        "haptoflow_find_wave_vectors", wave.ctypes.data_as(_POINTER), velocity.ctypes.data_as(_POINTER),
        ctypes.c_uint64(len(wave)), found,
    )  # fmt: skip
    return tuple((x, y) for x, y in (found[:2], found[2:]) if x != 0.0 or y != 0.0)
