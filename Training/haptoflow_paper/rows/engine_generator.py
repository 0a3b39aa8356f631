"""Batches of segments from the native library, through its C interface."""

from __future__ import annotations

import ctypes
from pathlib import Path
from types import TracebackType

import numpy as np
from numpy.typing import NDArray

from haptoflow_benchmark.engine_library import EngineLibrary
from haptoflow_training.training.closed_loop import SurfaceStatistics
from haptoflow_training.native_library import NativeModel, options_of
from haptoflow_training.waveform import SEGMENT_SAMPLES

MAXIMUM_BATCH = 256
# Kinds of tiers that are solved in steps, so that another solver can be chosen.
SOLVED_KINDS = ("flow", "average-velocity")
SOLVERS = {"tier": 0, "euler": 1, "midpoint": 2, "heun": 3}

_Floats = NDArray[np.float32]
_pointer = ctypes.POINTER(ctypes.c_float)


class _GeneratorOptions(ctypes.Structure):
    _fields_ = [
        ("struct_size", ctypes.c_uint32),
        ("maximum_batch", ctypes.c_uint32),
        ("runtime", ctypes.c_void_p),
        ("model", ctypes.c_void_p),
        ("tier", ctypes.c_char_p),
        ("cancellation", ctypes.c_void_p),
        ("probe_limit_ms", ctypes.c_double),
    ]


class _Batch(ctypes.Structure):
    _fields_ = [
        ("struct_size", ctypes.c_uint32),
        ("count", ctypes.c_uint32),
        ("embeddings", _pointer),
        ("motions", _pointer),
        ("previous_mps2", _pointer),
        ("noise", _pointer),
        ("phases", _pointer),
        ("own_levels_mps2", _pointer),
        ("latent_noise", _pointer),
    ]


class EngineGenerator:
    """Generates batches of segments with one tier of a model file, through the C interface; close it after use."""

    pasts, noise_before = 1, 0

    def __init__(
        self,
        engine: EngineLibrary,
        model: Path,
        tier: str | None = None,
        solver: str = "tier",
        steps: int = 0,
        maximum_batch: int = MAXIMUM_BATCH,
    ) -> None:
        self.engine, self.file = engine, model
        self._handle = ctypes.c_void_p()
        self._model = NativeModel(engine, model)
        self.header = engine.header(self._model.handle)
        self.embeddings = self._read_embeddings()
        self.statistics = SurfaceStatistics.of_entries(self.header["labels"])
        self.tier = tier or str(self.header["default_tier"])
        options = options_of(
            _GeneratorOptions,
            runtime=engine.runtime,
            model=self._model.handle,
            tier=None if tier is None else tier.encode(),
            maximum_batch=maximum_batch,
        )
        engine.call("haptoflow_generator_create", ctypes.byref(options), ctypes.byref(self._handle))
        self.set_solver(solver, steps)

    def __enter__(self) -> EngineGenerator:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Free the generator; does nothing if it is closed already."""
        self.engine.call("haptoflow_generator_close", ctypes.byref(self._handle))
        self._model.close()

    @property
    def model(self) -> ctypes.c_void_p:
        """The open model's handle."""
        return self._model.handle

    @property
    def corrects_a_stream(self) -> bool:
        """Whether the tier plays the skeleton's stream, alone or with a network's corrections. Other tiers start from noise."""
        kinds = {entry["name"]: entry["kind"] for entry in self.header["tiers"]}
        return kinds[self.tier] in ("skeleton", "refine")

    def set_solver(self, solver: str, steps: int) -> None:
        """From the next batch on; solver: of SOLVERS, 1 to 16 steps, or "tier" with 0."""
        self.engine.call(
            "haptoflow_generator_set_solver", self._handle, ctypes.c_int32(SOLVERS[solver]), ctypes.c_int32(steps)
        )

    def _read_embeddings(self) -> _Floats:
        count = len(self.header["labels"])
        rows = np.empty((count, 64), dtype=np.float32)
        for index in range(count):
            row = rows[index].ctypes.data_as(_pointer)
            self.engine.call("haptoflow_model_embedding", self._model.handle, ctypes.c_uint32(index), row)
        return rows

    def generate(
        self,
        embeddings: _Floats,
        motions: _Floats,
        previous_mps2: _Floats,
        noise: _Floats,
        phases: _Floats | None = None,
        latent_noise: _Floats | None = None,
    ) -> _Floats:
        """Segments [n, 200] in m/s^2 from embeddings [n, 64], motions [n, 3], previous [n, 200] or [n, 1, 200] and
        noise [n, 200].

        phases: [n, 6] (models/label_embedding.py) at each segment's first sample; None for phases of zero, at the rates
        at which the motions cross the embeddings' wave vectors. latent_noise: for a latent tier [n, size of the
        latent]; None to derive it from `noise`.
        """
        given = [embeddings, motions, previous_mps2, noise, phases, None, latent_noise]
        arrays = [None if array is None else np.ascontiguousarray(array, dtype=np.float32) for array in given]
        count = len(embeddings)
        pointers = [None if array is None else array.ctypes.data_as(_pointer) for array in arrays]
        batch = _Batch(ctypes.sizeof(_Batch), count, *pointers)
        segments = np.empty((count, SEGMENT_SAMPLES), dtype=np.float32)
        self.engine.call(
            "haptoflow_generator_generate", self._handle, ctypes.byref(batch), segments.ctypes.data_as(_pointer)
        )
        return segments
