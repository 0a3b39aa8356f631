"""Wave vectors of ribs and threads in recordings, found by the library (haptoflow_find_wave_vectors in haptoflow.h)."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from haptoflow_training.native_library import native_library

if TYPE_CHECKING:
    from haptoflow_training.recordings.material_recording import MaterialRecording

# In cycles per millimetre.
WaveVector = tuple[float, float]

_POINTER = ctypes.POINTER(ctypes.c_float)


def estimate_wave_vectors(recordings: Sequence[MaterialRecording]) -> tuple[WaveVector, ...]:
    """Up to two vectors, the clearest first, 0.4 to 8 mm apart; none if the recordings show no ribs or cannot show them.
    InputError if the library is missing."""
    # A sample that is not finite separates two recordings.
    gap, still = np.full(1, np.nan, np.float32), np.zeros((1, 2), np.float32)
    wave = np.concatenate([piece for each in recordings for piece in (each.vibration_mps2, gap)] or [gap])
    velocity = np.concatenate([piece for each in recordings for piece in (each.velocity_mps, still)] or [still])
    wave, velocity = (np.ascontiguousarray(values, dtype=np.float32) for values in (wave, velocity))
    found = (ctypes.c_double * 4)()
    native_library().call(
        "haptoflow_find_wave_vectors", wave.ctypes.data_as(_POINTER), velocity.ctypes.data_as(_POINTER),
        ctypes.c_uint64(len(wave)), found,
    )  # fmt: skip
    return tuple((x, y) for x, y in (found[:2], found[2:]) if x != 0.0 or y != 0.0)
