"""A part of the C interface that the pictures need beyond `EngineLibrary`: a voice with its exposure guard."""

from __future__ import annotations

import sys
from ctypes import Structure, byref, c_double, c_float, c_int32, c_uint32, c_uint64, c_void_p
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "Training"))

from haptoflow_benchmark.engine_library import EngineLibrary
from haptoflow_training.native_library import NativeModel, options_of  # noqa: E402

RATE_HZ = 8000
BLOCK_FRAMES = 111
_QUALITY_STANDARD = 2


class _EngineOptions(Structure):
    _fields_ = [("struct_size", c_uint32), ("quality", c_int32), ("runtime", c_void_p), ("model", c_void_p),
                ("update_rate_hz", c_double), ("budget_share", c_double), ("full_scale_mps2", c_double),
                ("seed", c_uint64), ("batch_voices", c_uint32), ("without_worker", c_uint32),
                ("fixed_lead_ms", c_double), ("cancellation", c_void_p), ("probe_limit_ms", c_double)]


class _ContactState(Structure):
    _fields_ = [("struct_size", c_uint32), ("touching", c_uint32), ("touch_counter", c_uint32), ("label_count", c_uint32),
                ("labels", c_uint32 * 4), ("weights", c_float * 4), ("velocity_mps", c_float * 2),
                ("force_newtons", c_float), ("approach_speed_mps", c_float), ("effects", c_uint32),
                ("edge_counter", c_uint32), ("edge_height_metres", c_float), ("landing_counter", c_uint32),
                ("spatial_scale", c_float), ("tone_db_per_octave", c_float), ("has_place", c_uint32),
                ("surface_seed", c_uint32), ("place_metres", c_float * 3), ("first_axis", c_float * 3),
                ("second_axis", c_float * 3), ("variation", c_float)]


class _Exposure(Structure):
    _fields_ = [("struct_size", c_uint32), ("reason", c_int32), ("gain", c_double), ("short_term_mps2", c_double),
                ("daily_mps2", c_double), ("lowered_seconds", c_double)]


def exposure(
    engine: EngineLibrary,
    model_file: Path,
    *,
    label: str,
    force_newtons: float,
    speed_mps: float,
    actuator_gain: float,
    seconds: float,
) -> np.ndarray:
    """The exposure guard's reports during an endless stroke, ten rows a second. The engine has no thread of its own:
    this function steps it, faster than real time."""
    handle, voice = c_void_p(), c_uint64()
    with NativeModel(engine, model_file) as model:
        options = options_of(
            _EngineOptions, quality=_QUALITY_STANDARD, runtime=engine.runtime, model=model.handle, without_worker=1,
            fixed_lead_ms=8.0, update_rate_hz=RATE_HZ / BLOCK_FRAMES,
        )  # fmt: skip
        engine.call("haptoflow_engine_create", byref(options), byref(handle))
        engine.call("haptoflow_voice_create", handle, c_double(RATE_HZ), byref(voice))
        engine.call("haptoflow_voice_set_exposure_guard", voice, c_uint32(1), c_float(actuator_gain))
        state = options_of(_ContactState, touching=1, touch_counter=1, label_count=1, force_newtons=force_newtons)
        state.labels[0] = [each["name"] for each in engine.header(model.handle)["labels"]].index(label)
        state.weights[0], state.velocity_mps[0] = 1.0, speed_mps
        block = (c_float * BLOCK_FRAMES)()
        rows = []
        for index in range(int(seconds * RATE_HZ / BLOCK_FRAMES)):
            engine.call("haptoflow_voice_publish", voice, byref(state))
            engine.call("haptoflow_engine_step", handle)
            engine.call("haptoflow_voice_render", voice, block, c_uint32(BLOCK_FRAMES), c_uint32(1), c_int32(0), c_double(RATE_HZ))
            if index % 7 == 0:
                now = options_of(_Exposure)
                engine.call("haptoflow_voice_exposure", voice, byref(now))
                rows.append((index * BLOCK_FRAMES / RATE_HZ, now.gain, now.short_term_mps2))
        engine.call("haptoflow_voice_destroy", byref(voice))
        engine.call("haptoflow_engine_close", byref(handle))
    return np.array(rows, dtype=[(name, "f8") for name in ("seconds", "gain", "short_term_mps2")])
