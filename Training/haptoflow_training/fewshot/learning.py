"""Learns a material from recordings with the library: what `haptoflow learn` does (haptoflow_learn_material)."""

from __future__ import annotations

import ctypes
import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.native_library import NativeModel, native_library, native_runtime, options_of
from haptoflow_training.recordings.material_recording import MaterialRecording
from haptoflow_training.recordings.native_recording import EvenRecording
from haptoflow_training.waveform import SAMPLE_RATE_HZ

DEFAULT_SECONDS_LIMIT = 20.0
# Samples left out between two recordings, so that the step from one to the next is not learnt.
_GAP_SAMPLES = 20
_Progress = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_double, ctypes.c_char_p)
_FLOATS = ctypes.POINTER(ctypes.c_float)


class _Options(ctypes.Structure):
    _fields_ = [
        ("struct_size", ctypes.c_uint32),
        ("axis_count", ctypes.c_uint32),
        ("runtime", ctypes.c_void_p),
        ("model", ctypes.c_void_p),
        ("tier", ctypes.c_char_p),
        ("name", ctypes.c_char_p),
        ("category", ctypes.c_char_p),
        ("description", ctypes.c_char_p),
        ("licence", ctypes.c_char_p),
        ("acceleration_mps2", _FLOATS),
        ("sample_count", ctypes.c_uint64),
        ("sample_rate_hz", ctypes.c_double),
        ("velocity_mps", _FLOATS),
        ("constant_velocity_mps", ctypes.c_double * 2),
        ("force_newtons", _FLOATS),
        ("constant_force_newtons", ctypes.c_double),
        ("seed", ctypes.c_uint64),
        ("seconds_limit", ctypes.c_double),
        ("progress", _Progress),
        ("progress_context", ctypes.c_void_p),
        ("cancellation", ctypes.c_void_p),
        ("wave_vectors", _FLOATS),
        ("recordings", ctypes.c_char_p),
        ("label", ctypes.c_char_p),
    ]


@dataclass(frozen=True)
class MaterialWords:
    """Texts of the material file. name: lower case, as a label's is. recordings: what the provenance calls them."""

    name: str
    category: str = ""
    description: str = ""
    licence: str = ""
    recordings: str = ""


@dataclass(frozen=True)
class LearntMaterial:
    """text: of the material file. report: as haptoflow_learning_report has it."""

    text: str
    report: dict[str, Any]


def joined(recordings: Sequence[MaterialRecording]) -> EvenRecording:
    """Recordings at 2 kHz, one after the other, with a gap between two."""
    waves, motions, forces = [], [], []
    for recording in recordings:
        if waves:
            waves.append(np.full(_GAP_SAMPLES, np.nan, dtype=np.float32))
            motions.append(np.repeat(motions[-1][-1:], _GAP_SAMPLES, axis=0))
            forces.append(np.repeat(forces[-1][-1:], _GAP_SAMPLES))
        waves.append(recording.vibration_mps2)
        motions.append(recording.velocity_mps)
        forces.append(recording.force_newtons)
    return EvenRecording(
        float(SAMPLE_RATE_HZ), np.concatenate(waves)[:, None], np.concatenate(motions), np.concatenate(forces)
    )


def learn_material(
    model: Path,
    recording: EvenRecording,
    words: MaterialWords,
    *,
    seed: int = 1,
    seconds_limit: float = DEFAULT_SECONDS_LIMIT,
    wave_vectors_per_mm: Sequence[tuple[float, float]] | None = None,
    label: str | None = None,
    progress: Callable[[float, str], None] = lambda share, doing: None,
) -> LearntMaterial:
    """Learn a material on the model's default tier. NativeError (an InputError) says why a recording is unusable.

    seconds_limit: of processor time; a fit that it does not end gives the same bytes on every run. wave_vectors_per_mm:
    None finds them, an empty sequence means that there are none. label: of the model, whose embedding and wave vectors the
    material keeps, in the recording's own frame; only level and tone are fitted. progress: receives the completed share and the step.
    """
    library = native_library()
    kept: list[NDArray[np.float32]] = []

    def pointer(values: NDArray[np.floating] | None) -> Any:
        if values is None:
            return None
        kept.append(np.ascontiguousarray(values, dtype=np.float32))
        return kept[-1].ctypes.data_as(_FLOATS)

    numbers = None
    if wave_vectors_per_mm is not None:
        numbers = np.zeros(4)
        numbers[: 2 * len(wave_vectors_per_mm)] = np.array(wave_vectors_per_mm).reshape(-1)
    with NativeModel(library, model) as opened:
        options = options_of(
            _Options,
            axis_count=recording.acceleration_mps2.shape[1],
            runtime=native_runtime(),
            model=opened.handle,
            name=words.name.encode(),
            category=words.category.encode(),
            description=words.description.encode(),
            licence=words.licence.encode(),
            acceleration_mps2=pointer(recording.acceleration_mps2),
            sample_count=len(recording.acceleration_mps2),
            sample_rate_hz=recording.rate_hz,
            velocity_mps=pointer(recording.velocity_mps),
            constant_velocity_mps=(ctypes.c_double * 2)(*recording.constant_velocity_mps),
            force_newtons=pointer(recording.force_newtons),
            constant_force_newtons=recording.constant_force_newtons,
            seed=seed,
            seconds_limit=seconds_limit,
            progress=_Progress(lambda _, share, doing: progress(share, doing.decode())),
            wave_vectors=pointer(numbers),
            recordings=words.recordings.encode(),
            label=None if label is None else label.encode(),
        )
        learning = ctypes.c_void_p()
        library.call("haptoflow_learn_material", ctypes.byref(options), ctypes.byref(learning))
        try:
            texts = []
            for function in ("haptoflow_learning_material", "haptoflow_learning_report"):
                text = ctypes.c_char_p()
                library.call(function, learning, ctypes.byref(text))
                texts.append((text.value or b"").decode())
            return LearntMaterial(texts[0], json.loads(texts[1]))
        finally:
            library.call("haptoflow_learning_close", ctypes.byref(learning))
