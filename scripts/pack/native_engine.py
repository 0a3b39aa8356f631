"""The C interface of the built library, as far as the pictures need it: a voice that slides, and features of a wave."""

from __future__ import annotations

import ctypes
import json
from ctypes import Structure, byref, c_char_p, c_double, c_float, c_int32, c_uint32, c_uint64, c_void_p, sizeof
from pathlib import Path
from types import TracebackType

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
LIBRARY = ROOT / "build/native/libaudioplugin_haptoflow.so"
MODEL = ROOT / "Packages/com.haptoflow.runtime/Runtime/Models/default.haptoflow"
ONNX_RUNTIME = ROOT / "node_modules/com.github.asus4.onnxruntime/Plugins/Linux/x64/libonnxruntime.so"
RATE_HZ = 8000
BLOCK_FRAMES = 111


class _RuntimeOptions(Structure):
    _fields_ = [("struct_size", c_uint32), ("ort_api_base", c_void_p), ("library_path", c_char_p), ("log", c_void_p),
                ("log_context", c_void_p)]


class _ModelOptions(Structure):
    _fields_ = [("struct_size", c_uint32), ("bytes", c_void_p), ("byte_count", c_uint64), ("path", c_char_p)]


class _EngineOptions(Structure):
    _fields_ = [("struct_size", c_uint32), ("quality", c_int32), ("runtime", c_void_p), ("model", c_void_p),
                ("update_rate_hz", c_double), ("budget_share", c_double), ("full_scale_mps2", c_double),
                ("seed", c_uint64), ("batch_voices", c_uint32), ("without_worker", c_uint32),
                ("fixed_lead_ms", c_double), ("cancellation", c_void_p), ("probe_limit_ms", c_double)]


class _ContactState(Structure):
    _fields_ = [("struct_size", c_uint32), ("touching", c_uint32), ("touch_counter", c_uint32), ("label_count", c_uint32),
                ("labels", c_uint32 * 4), ("weights", c_float * 4), ("velocity_mps", c_float * 2),
                ("force_newtons", c_float), ("approach_speed_mps", c_float), ("effects", c_uint32),
                ("edge_counter", c_uint32), ("edge_height_metres", c_float), ("landing_counter", c_uint32)]


class _Exposure(Structure):
    _fields_ = [("struct_size", c_uint32), ("reason", c_int32), ("gain", c_double), ("short_term_mps2", c_double),
                ("daily_mps2", c_double), ("lowered_seconds", c_double)]


class _FeatureOptions(Structure):
    _fields_ = [("struct_size", c_uint32), ("sample_rate_hz", c_uint32), ("frame_seconds", c_double),
                ("minimum_frequency_hz", c_double), ("maximum_frequency_hz", c_double)]


_FRAME = np.dtype([("first_sample", "u8"), ("sample_count", "u4"), ("intensity", "f4"), ("centroid_hz", "f4"),
                   ("frequency_hz", "f4"), ("amplitude_mps2", "f4"), ("transient_offset_seconds", "f4"),
                   ("transient_mps2", "f4"), ("transient_hz", "f4")], align=True)


def _call(name: str, *arguments: object) -> None:
    library = ctypes.CDLL(str(LIBRARY))
    library.haptoflow_last_message.restype = c_char_p
    if getattr(library, f"haptoflow_{name}")(*arguments) != 0:
        raise SystemExit(f"haptoflow_{name}: {library.haptoflow_last_message().decode()}")


def _made(structure: Structure) -> Structure:
    structure.struct_size = sizeof(structure)
    return structure


def wave_frames(
    wave_mps2: np.ndarray, rate_hz: int, frame_seconds: float, minimum_hz: float, maximum_hz: float
) -> np.ndarray:
    """Frames of a wave [N] in m/s^2, with a column of seconds at which each begins; rate_hz: a multiple of 2000."""
    options = _made(_FeatureOptions(0, rate_hz, frame_seconds, minimum_hz, maximum_hz))
    features, count = c_void_p(), c_uint64()
    _call("wave_features_create", byref(options), byref(features))
    wave = np.ascontiguousarray(wave_mps2, dtype=np.float32)
    frames = np.zeros(int(len(wave) / (rate_hz * frame_seconds)) + 1, dtype=_FRAME)
    _call("wave_features_process", features, wave.ctypes.data_as(c_void_p), c_uint64(len(wave)),
          frames.ctypes.data_as(c_void_p), c_uint64(len(frames)), byref(count))
    _call("wave_features_close", byref(features))
    frames = frames[: count.value]
    # The low-pass in front of the features delays by 1.5 ms.
    seconds = frames["first_sample"] / 2000.0 - 0.0015
    result = np.zeros(len(frames), dtype=[*[(name, "f8") for name in _FRAME.names], ("seconds", "f8")])
    for name in _FRAME.names:
        result[name] = frames[name]
    result["seconds"] = seconds
    return result


class NativeEngine:
    """An engine without worker, so that an hour passes in a minute."""

    def __init__(self) -> None:
        self._runtime, self._model, self._engine = c_void_p(), c_void_p(), c_void_p()

    def __enter__(self) -> NativeEngine:
        runtime = _RuntimeOptions(library_path=str(ONNX_RUNTIME).encode())
        _call("runtime_open", byref(_made(runtime)), byref(self._runtime))
        _call("model_open", byref(_made(_ModelOptions(path=str(MODEL).encode()))), byref(self._model))
        options = _EngineOptions(quality=2, runtime=self._runtime, model=self._model, without_worker=1,
                                 fixed_lead_ms=8.0, update_rate_hz=RATE_HZ / BLOCK_FRAMES)
        _call("engine_create", byref(_made(options)), byref(self._engine))
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        for name, handle in (("engine", self._engine), ("model", self._model), ("runtime", self._runtime)):
            _call(f"{name}_close", byref(handle))

    def exposure(
        self, label: str, force_newtons: float, speed_mps: float, actuator_gain: float, seconds: float
    ) -> np.ndarray:
        """A stroke without end through the exposure guard, ten rows a second."""
        voice = c_uint64()
        _call("voice_create", self._engine, c_double(RATE_HZ), byref(voice))
        _call("voice_set_exposure_guard", voice, c_uint32(1), c_float(actuator_gain))
        state = _made(_ContactState(touching=1, touch_counter=1, label_count=1))
        state.labels[0] = self._label(label)
        state.weights[0], state.velocity_mps[0], state.force_newtons = 1.0, speed_mps, force_newtons
        block = (c_float * BLOCK_FRAMES)()
        rows = []
        for index in range(int(seconds * RATE_HZ / BLOCK_FRAMES)):
            _call("voice_publish", voice, byref(state))
            _call("engine_step", self._engine)
            _call("voice_render", voice, block, c_uint32(BLOCK_FRAMES), c_uint32(1), c_int32(0), c_double(RATE_HZ))
            if index % 7 == 0:
                exposure = _made(_Exposure())
                _call("voice_exposure", voice, byref(exposure))
                rows.append((index * BLOCK_FRAMES / RATE_HZ, exposure.gain, exposure.short_term_mps2,
                             exposure.daily_mps2, exposure.reason))
        _call("voice_destroy", byref(voice))
        names = ("seconds", "gain", "short_term_mps2", "daily_mps2", "reason")
        return np.array(rows, dtype=[(name, "f8") for name in names])

    def _label(self, name: str) -> int:
        header = c_char_p()
        _call("model_header", self._model, byref(header))
        labels = [label["name"] for label in json.loads(header.value or b"{}")["labels"]]
        return labels.index(name)
