"""The accelerometer's noise in recordings, found and removed by the library (haptoflow_recording_remove_noise)."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.native_library import native_library

NoiseSource = Literal["none", "rest", "quiet part"]

_SOURCES: tuple[NoiseSource, ...] = ("none", "rest", "quiet part")
_POINTER = ctypes.POINTER(ctypes.c_float)


@dataclass(frozen=True)
class SensorNoise:
    """source: where the noise was found. rms_mps2: its level, 0 for none."""

    source: NoiseSource
    rms_mps2: float


NO_NOISE = SensorNoise("none", 0.0)


def remove_sensor_noise(
    waveforms_mps2: Sequence[NDArray[np.float32]], motions: Sequence[NDArray[np.float32]]
) -> tuple[list[NDArray[np.float32]], SensorNoise]:
    """The stretches of one recording without noise, and the noise of all. waveforms_mps2: each [n] at 2 kHz. motions: each
    [n, 3]: vx, vy in m/s, force in N. InputError if there is nothing but noise, or if the library is missing."""
    # A sample that is not finite separates two stretches.
    gap, still = np.full(1, np.nan, np.float32), np.zeros((1, 3), np.float32)
    wave = np.concatenate([piece for each in waveforms_mps2 for piece in (each, gap)])
    motion = np.concatenate([piece for each in motions for piece in (each, still)])
    velocity, force = (np.ascontiguousarray(values, np.float32) for values in (motion[:, :2], motion[:, 2]))
    source, rms_mps2 = ctypes.c_int32(), ctypes.c_double()
    native_library().call(
        "haptoflow_recording_remove_noise", wave.ctypes.data_as(_POINTER), velocity.ctypes.data_as(_POINTER),
        force.ctypes.data_as(_POINTER), ctypes.c_uint64(len(wave)), ctypes.byref(source), ctypes.byref(rms_mps2),
    )  # fmt: skip
    ends = np.cumsum([len(each) + 1 for each in waveforms_mps2])
    stretches = [wave[end - 1 - len(each) : end - 1] for each, end in zip(waveforms_mps2, ends, strict=True)]
    return stretches, SensorNoise(_SOURCES[source.value], rms_mps2.value)
