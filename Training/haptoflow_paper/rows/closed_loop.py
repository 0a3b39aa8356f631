"""Renders a tier in closed loop. One that plays the skeleton's stream is rendered by the command line, or by a voice where
the label changes with time, which a scene cannot say; one that starts from noise continues its own segments."""

from __future__ import annotations

import ctypes
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.signal import resample_poly

from haptoflow_benchmark.engine_render import FULL_SCALE_MPS2, read_wav, run_engine, write_scene, write_stroke
from haptoflow_paper.rows.engine_generator import EngineGenerator
from haptoflow_training.native_library import options_of
from haptoflow_training.training.closed_loop import ClosedLoopRun, hop_positions, run_closed_loop
from haptoflow_training.waveform import SAMPLE_RATE_HZ

_Floats = NDArray[np.float32]

# A voice's output is brought down to the waveform's rate. What lies above 900 Hz is lost, so only figures that do not
# depend on it come from a voice.
_OVERSAMPLING = 4
_OUTPUT_RATE_HZ = _OVERSAMPLING * SAMPLE_RATE_HZ
# So large that no level reaches the limiter, which is no part of what is measured.
_FULL_SCALE_MPS2 = 1e5
_LEAD_SAMPLES = 16
# Of the voice's resampler, 1.2 ms.
_DELAY_FRAMES = 10
_QUALITIES = {"draft": 1, "standard": 2, "sketch": 4}
_TEXTURE = 1


class _EngineOptions(ctypes.Structure):
    _fields_ = [
        ("struct_size", ctypes.c_uint32),
        ("quality", ctypes.c_int32),
        ("runtime", ctypes.c_void_p),
        ("model", ctypes.c_void_p),
        ("update_rate_hz", ctypes.c_double),
        ("budget_share", ctypes.c_double),
        ("full_scale_mps2", ctypes.c_double),
        ("seed", ctypes.c_uint64),
        ("batch_voices", ctypes.c_uint32),
        ("without_worker", ctypes.c_uint32),
        ("fixed_lead_ms", ctypes.c_double),
        ("cancellation", ctypes.c_void_p),
        ("probe_limit_ms", ctypes.c_double),
    ]


class _ContactState(ctypes.Structure):
    _fields_ = [
        ("struct_size", ctypes.c_uint32),
        ("touching", ctypes.c_uint32),
        ("touch_counter", ctypes.c_uint32),
        ("label_count", ctypes.c_uint32),
        ("labels", ctypes.c_uint32 * 4),
        ("weights", ctypes.c_float * 4),
        ("velocity_mps", ctypes.c_float * 2),
        ("force_newtons", ctypes.c_float),
        ("approach_speed_mps", ctypes.c_float),
        ("effects", ctypes.c_uint32),
        ("edge_counter", ctypes.c_uint32),
        ("edge_height_metres", ctypes.c_float),
        ("landing_counter", ctypes.c_uint32),
        ("spatial_scale", ctypes.c_float),
        ("tone_db_per_octave", ctypes.c_float),
        ("has_place", ctypes.c_uint32),
        ("surface_seed", ctypes.c_uint32),
        ("place_metres", ctypes.c_float * 3),
        ("first_axis", ctypes.c_float * 3),
        ("second_axis", ctypes.c_float * 3),
        ("variation", ctypes.c_float),
        ("relief", ctypes.c_uint32),
        ("relief_place", ctypes.c_float * 2),
        ("relief_share", ctypes.c_float),
    ]


def closed_loop(
    generator: EngineGenerator, motions: _Floats, labels: NDArray[np.int64], *, update_rate_hz: float, seed: int
) -> ClosedLoopRun:
    """Renders n waveforms, one for each of `motions` [n, samples, 3]; labels: the model's label index of each, [n], or [n,
    hops] where a waveform changes its label. Each contact state is the mean motion of the hop before it, because a tracker
    knows no more."""
    if not generator.corrects_a_stream:
        return run_closed_loop(
            generator, generator.embeddings, motions, labels, generator.statistics, update_rate_hz=update_rate_hz, seed=seed
        )
    starts = hop_positions(motions.shape[1], update_rate_hz)
    by_hop = np.broadcast_to(labels if labels.ndim == 2 else labels[:, None], (len(motions), len(starts)))
    waves = []
    for row, (motion, told) in enumerate(zip(motions, by_hop, strict=True)):
        if np.all(told == told[0]):
            waves.append(_rendered(generator, motion, int(told[0]), update_rate_hz, seed=seed + row))
        else:
            waves.append(_played(generator, motion, told, starts, update_rate_hz, seed=seed + row))
    return ClosedLoopRun(np.stack(waves), starts + _LEAD_SAMPLES)


def _rendered(generator: EngineGenerator, motion: _Floats, label: int, update_rate_hz: float, *, seed: int) -> _Floats:
    """The waveform of a stroke, as the engine generates it from the tip's places, [samples]."""
    with tempfile.TemporaryDirectory() as name:
        scene, stroke, wav, waveform = (Path(name) / file for file in ("scene.json", "stroke.csv", "out.wav", "wave.wav"))
        label_name = str(generator.header["labels"][label]["name"])
        write_scene(scene, label_name, update_rate_hz, name=f"plane {seed}")
        write_stroke(stroke, motion)
        words = ["render", scene, "--stroke", stroke, "-o", wav, "--waveform", waveform, "--model", generator.file]
        words += ["--quality", generator.tier, "--seed", seed, "--rate", _OUTPUT_RATE_HZ, "--quiet"]
        words += ["--lead-ms", 1e3 * _LEAD_SAMPLES / SAMPLE_RATE_HZ]
        run_engine([str(generator.engine.path.parent / "haptoflow"), *map(str, words)])
        made = read_wav(waveform)[: len(motion)] * np.float32(FULL_SCALE_MPS2)
    return np.pad(made, (0, len(motion) - len(made)))


@contextmanager
def _engine(generator: EngineGenerator, update_rate_hz: float, seed: int) -> Iterator[ctypes.c_void_p]:
    options = options_of(
        _EngineOptions, quality=_QUALITIES[generator.tier], runtime=generator.engine.runtime, model=generator.model,
        update_rate_hz=update_rate_hz, full_scale_mps2=_FULL_SCALE_MPS2, seed=seed, without_worker=1,
        fixed_lead_ms=1e3 * _LEAD_SAMPLES / SAMPLE_RATE_HZ,
    )  # fmt: skip
    engine = ctypes.c_void_p()
    generator.engine.call("haptoflow_engine_create", ctypes.byref(options), ctypes.byref(engine))
    try:
        yield engine
    finally:
        generator.engine.call("haptoflow_engine_close", ctypes.byref(engine))


def _played(
    generator: EngineGenerator, motion: _Floats, labels: Sequence[int], starts: NDArray[np.int64],
    update_rate_hz: float, *, seed: int,
) -> _Floats:  # fmt: skip
    """What a voice plays of one touch, from its first sample on, [samples]; labels: one for each of `starts`."""
    call = generator.engine.call
    output = np.zeros(_OVERSAMPLING * len(motion) + _DELAY_FRAMES, dtype=np.float32)
    place_metres = np.cumsum(motion[:, :2].astype(np.float64), axis=0) / SAMPLE_RATE_HZ
    state = options_of(
        _ContactState, touching=1, touch_counter=1, label_count=1, effects=_TEXTURE, has_place=1, surface_seed=seed
    )
    state.weights[0], state.first_axis[0], state.second_axis[1] = 1.0, 1.0, 1.0
    with _engine(generator, update_rate_hz, seed) as engine:
        # Closing the engine destroys its voice.
        voice = ctypes.c_uint64()
        call("haptoflow_voice_create", engine, ctypes.c_double(_OUTPUT_RATE_HZ), ctypes.byref(voice))
        before = 0
        for start, block, label in zip(starts, np.split(output, _OVERSAMPLING * starts[1:]), labels, strict=True):
            known = motion[before:start] if start > before else motion[:1]
            state.labels[0] = label
            state.velocity_mps[:] = known[:, :2].mean(axis=0)
            state.force_newtons = known[:, 2].mean()
            state.place_metres[:2] = place_metres[start - 1] if start else (0.0, 0.0)
            call("haptoflow_voice_publish", voice, ctypes.byref(state))
            call("haptoflow_engine_step", engine)
            call(
                "haptoflow_voice_render", voice, block.ctypes.data_as(ctypes.c_void_p), ctypes.c_uint32(len(block)),
                ctypes.c_uint32(1), ctypes.c_int32(0), ctypes.c_double(_OUTPUT_RATE_HZ),
            )  # fmt: skip
            before = start
    return (_FULL_SCALE_MPS2 * resample_poly(output[_DELAY_FRAMES:], 1, _OVERSAMPLING)).astype(np.float32)
