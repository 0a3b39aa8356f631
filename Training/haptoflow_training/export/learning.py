"""Learns a material from recordings with the library: what `haptoflow learn` does (haptoflow_learn_material)."""

from __future__ import annotations

import ctypes
import json
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any

import numpy as np

from haptoflow_training.native_library import NativeModel, native_library, native_runtime, options_of
from haptoflow_training.recordings.native_recording import MaterialRecording, as_native

DEFAULT_SECONDS_LIMIT = 20.0
# Samples left out between two recordings, so that the step from one to the next is not learnt.
_GAP_SAMPLES = 20
_Progress = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_double, ctypes.c_char_p)


class _Options(ctypes.Structure):
    _fields_ = [
        ("struct_size", ctypes.c_uint32),
        ("reserved", ctypes.c_uint32),
        ("recording", ctypes.c_void_p),
        ("speed_mps", ctypes.c_double),
        ("force_newtons", ctypes.c_double),
        ("runtime", ctypes.c_void_p),
        ("model", ctypes.c_void_p),
        ("tier", ctypes.c_char_p),
        ("name", ctypes.c_char_p),
        ("category", ctypes.c_char_p),
        ("description", ctypes.c_char_p),
        ("licence", ctypes.c_char_p),
        ("seed", ctypes.c_uint64),
        ("seconds_limit", ctypes.c_double),
        ("progress", _Progress),
        ("progress_context", ctypes.c_void_p),
        ("cancellation", ctypes.c_void_p),
        ("wave_vectors", ctypes.POINTER(ctypes.c_float)),
        ("label", ctypes.c_char_p),
    ]


def joined(recordings: Sequence[MaterialRecording], origin: str = "") -> AbstractContextManager[ctypes.c_void_p]:
    """The library's handle of recordings one after the other, with a gap between two. origin: as of `as_native`."""
    waves, motions = [], []
    for recording in recordings:
        if waves:
            waves.append(np.full(_GAP_SAMPLES, np.nan, dtype=np.float32))
            motions.append(np.repeat(motions[-1][-1:], _GAP_SAMPLES, axis=0))
        waves.append(recording.vibration_mps2)
        motions.append(recording.motion)
    motion = np.concatenate(motions)
    return as_native(np.concatenate(waves)[:, None], motion[:, :2], motion[:, 2], origin)


def learn_material(
    model: Path,
    recording: AbstractContextManager[ctypes.c_void_p],
    name: str,
    *,
    category: str = "",
    description: str = "",
    licence: str = "",
    seed: int = 1,
    seconds_limit: float = DEFAULT_SECONDS_LIMIT,
    wave_vectors_per_mm: Sequence[tuple[float, float]] | None = None,
    label: str | None = None,
    progress: Callable[[float, str], None] = lambda share, doing: None,
) -> tuple[str, dict[str, Any]]:
    """Learn a material of a recording (`joined`, `open_own`) on the model's default tier: the text of its file, and the
    report of haptoflow_learning_results. NativeError (an InputError) says why a recording is unusable.

    name: lower case, as a label's is. seconds_limit: of processor time; a fit that it does not end gives the same bytes on
    every run. wave_vectors_per_mm: None finds them, an empty sequence means that there are none. label: of the model, whose
    embedding and wave vectors the material keeps, in the recording's own frame; only level and tone are fitted. progress:
    receives the completed share and the step.
    """
    library = native_library()
    numbers = None
    if wave_vectors_per_mm is not None:
        numbers = (ctypes.c_float * 4)(*(number for vector in wave_vectors_per_mm for number in vector))
    with NativeModel(library, model) as opened, recording as samples:
        options = options_of(
            _Options,
            recording=samples,
            runtime=native_runtime(),
            model=opened.handle,
            name=name.encode(),
            category=category.encode(),
            description=description.encode(),
            licence=licence.encode(),
            seed=seed,
            seconds_limit=seconds_limit,
            progress=_Progress(lambda _, share, doing: progress(share, doing.decode())),
            wave_vectors=numbers,
            label=None if label is None else label.encode(),
        )
        learning = ctypes.c_void_p()
        library.call("haptoflow_learn_material", ctypes.byref(options), ctypes.byref(learning))
        try:
            text, report = ctypes.c_char_p(), ctypes.c_char_p()
            library.call("haptoflow_learning_results", learning, ctypes.byref(text), ctypes.byref(report))
            return (text.value or b"").decode(), json.loads(report.value or b"")
        finally:
            library.call("haptoflow_learning_close", ctypes.byref(learning))
