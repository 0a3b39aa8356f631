"""The native library from Python, with ONNX Runtime."""

from __future__ import annotations

import ctypes
import json
from ctypes import Structure, byref, c_double, c_uint32, c_uint64, c_void_p
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.errors import InputError
from haptoflow_training.native_library import (
    NativeError, NativeLibrary, built_library, installed_runtime, open_runtime, options_of
)

class EngineLibrary(NativeLibrary):
    """The loaded library with ONNX Runtime. Handles live until the process ends."""

    def __init__(self, library: Path, onnx_runtime: Path) -> None:
        super().__init__(library)
        self.runtime = open_runtime(self, onnx_runtime)

    def call(self, name: str, *arguments: Any) -> None:
        """As the base's; the message begins with the function's name."""
        try:
            super().call(name, *arguments)
        except NativeError as error:
            raise InputError(f"{name}: {error}") from error

    def version(self) -> str:
        """The library's own."""
        function = self._library.haptoflow_version
        function.restype = ctypes.c_char_p
        return str(function().decode())

    def header(self, model: ctypes.c_void_p) -> dict[str, Any]:
        text = ctypes.c_char_p()
        self.call("haptoflow_model_header", model, ctypes.byref(text))
        result: dict[str, Any] = json.loads(text.value or b"{}")
        return result


def default_engine(root: Path) -> EngineLibrary:
    """The library that `npm run build` makes in the repository at `root`, with the ONNX Runtime from npm."""
    return EngineLibrary(built_library(root), installed_runtime(root))


class _FeatureOptions(Structure):
    _fields_ = [("struct_size", c_uint32), ("sample_rate_hz", c_uint32), ("frame_seconds", c_double),
                ("minimum_frequency_hz", c_double), ("maximum_frequency_hz", c_double)]  # fmt: skip


_FRAME = np.dtype([("first_sample", "u8"), ("sample_count", "u4"), ("intensity", "f4"), ("centroid_hz", "f4"),
                   ("frequency_hz", "f4"), ("amplitude_mps2", "f4"), ("transient_offset_seconds", "f4"),
                   ("transient_mps2", "f4"), ("transient_hz", "f4")], align=True)  # fmt: skip
# The low-pass before the features; there is none at their own rate.
_LOW_PASS_SECONDS = 0.0015
_FEATURES_RATE_HZ = 2000


def wave_frames(
    engine: NativeLibrary,
    wave_mps2: NDArray[np.floating],
    rate_hz: int,
    frame_seconds: float,
    minimum_hz: float,
    maximum_hz: float,
) -> NDArray[np.void]:
    """Frames of a waveform [N] in m/s^2, with a column of seconds at which each begins; rate_hz: a multiple of 2000."""
    options = options_of(
        _FeatureOptions, sample_rate_hz=rate_hz, frame_seconds=frame_seconds, minimum_frequency_hz=minimum_hz,
        maximum_frequency_hz=maximum_hz,
    )  # fmt: skip
    features, count = c_void_p(), c_uint64()
    engine.call("haptoflow_wave_features_create", byref(options), byref(features))
    wave = np.ascontiguousarray(wave_mps2, dtype=np.float32)
    frames = np.zeros(int(len(wave) / (rate_hz * frame_seconds)) + 1, dtype=_FRAME)
    engine.call("haptoflow_wave_features_process", features, wave.ctypes.data_as(c_void_p), c_uint64(len(wave)),
                frames.ctypes.data_as(c_void_p), c_uint64(len(frames)), byref(count))  # fmt: skip
    engine.call("haptoflow_wave_features_close", byref(features))
    frames = frames[: count.value]
    assert _FRAME.names is not None
    result = np.zeros(len(frames), dtype=[*((name, "f8") for name in _FRAME.names), ("seconds", "f8")])
    for name in _FRAME.names:
        result[name] = frames[name]
    delay = _LOW_PASS_SECONDS if rate_hz > _FEATURES_RATE_HZ else 0.0
    result["seconds"] = frames["first_sample"] / _FEATURES_RATE_HZ - delay
    return result
