"""The native library from Python, with ONNX Runtime."""

from __future__ import annotations

import ctypes
import json
import sys
from pathlib import Path
from typing import Any

from haptoflow_training.errors import InputError
from haptoflow_training.native_library import NativeError, NativeLibrary, options_of


class _RuntimeOptions(ctypes.Structure):
    _fields_ = [
        ("struct_size", ctypes.c_uint32),
        ("ort_api_base", ctypes.c_void_p),
        ("library_path", ctypes.c_char_p),
    ]


class _ModelOptions(ctypes.Structure):
    _fields_ = [
        ("struct_size", ctypes.c_uint32),
        ("bytes", ctypes.c_void_p),
        ("byte_count", ctypes.c_uint64),
        ("path", ctypes.c_char_p),
    ]


class EngineLibrary(NativeLibrary):
    """The loaded library with ONNX Runtime. Handles live until the process ends."""

    def __init__(self, library: Path, onnx_runtime: Path) -> None:
        super().__init__(library)
        if not onnx_runtime.is_file():
            raise InputError(f"{onnx_runtime} does not exist: run `npm ci`")
        self._runtime = ctypes.c_void_p()
        options = options_of(_RuntimeOptions, library_path=str(onnx_runtime).encode())
        self.call("haptoflow_runtime_open", ctypes.byref(options), ctypes.byref(self._runtime))

    @property
    def runtime(self) -> ctypes.c_void_p:
        return self._runtime

    def call(self, name: str, *arguments: Any) -> None:
        """As the base's; the message begins with the function's name."""
        try:
            super().call(name, *arguments)
        except NativeError as error:
            raise InputError(f"{name}: {error}") from error

    def open_model(self, path: Path) -> ctypes.c_void_p:
        """A handle, to be closed with haptoflow_model_close."""
        model = ctypes.c_void_p()
        options = options_of(_ModelOptions, path=str(path).encode())
        self.call("haptoflow_model_open", ctypes.byref(options), ctypes.byref(model))
        return model

    def header(self, model: ctypes.c_void_p) -> dict[str, Any]:
        text = ctypes.c_char_p()
        self.call("haptoflow_model_header", model, ctypes.byref(text))
        result: dict[str, Any] = json.loads(text.value or b"{}")
        return result


def default_engine(root: Path) -> EngineLibrary:
    """The library that `npm run build` makes in the repository at `root`, with the ONNX Runtime from npm."""
    if sys.platform != "linux":
        raise InputError("evaluation runs the Linux library only; on Windows or macOS use a Linux machine or container")
    runtime = root / "node_modules" / "com.github.asus4.onnxruntime" / "Plugins" / "Linux" / "x64" / "libonnxruntime.so"
    return EngineLibrary(root / "build" / "native" / "libaudioplugin_haptoflow.so", runtime)
