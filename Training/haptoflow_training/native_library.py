"""The native library from Python: loading it, and calling its C interface."""

from __future__ import annotations

import ctypes
import os
import sys
from functools import lru_cache
from pathlib import Path
from typing import Any

from haptoflow_training.errors import InputError

LIBRARY_VARIABLE, RUNTIME_VARIABLE = "HAPTOFLOW_LIBRARY", "HAPTOFLOW_ONNXRUNTIME"
_NAMES = {"win32": "audioplugin_haptoflow.dll", "darwin": "libaudioplugin_haptoflow.dylib"}
_RUNTIME_NAMES = {"win32": "Windows/x64/onnxruntime.dll", "darwin": "macOS/arm64/libonnxruntime.dylib"}
_ROOT = Path(__file__).resolve().parents[2]


class NativeError(InputError):
    """A function of the library failed; the message is the library's own."""


class NativeLibrary:
    """The loaded library, in any thread."""

    def __init__(self, path: Path) -> None:
        if not path.is_file():
            raise InputError(
                f"{path} does not exist: run `npm run build`, or set {LIBRARY_VARIABLE} to HaptoFlow's native library"
            )
        self.path = path
        self._library = ctypes.CDLL(str(path))
        self._library.haptoflow_last_message.restype = ctypes.c_char_p

    def call(self, name: str, *arguments: Any) -> None:
        """Call a function of the C interface; NativeError with the library's own message if it fails."""
        status = getattr(self._library, name)(*arguments)
        if status != 0:
            raise NativeError(self._library.haptoflow_last_message().decode("utf-8", "backslashreplace"))


def options_of(structure: type[ctypes.Structure], **values: Any) -> Any:
    """A structure of the C interface with its size field set."""
    return structure(struct_size=ctypes.sizeof(structure), **values)


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


class NativeModel:
    """A model file opened by the library. Use it in a `with` statement, or close it."""

    def __init__(self, library: NativeLibrary, path: Path) -> None:
        self._library = library
        self.handle = ctypes.c_void_p()
        options = options_of(_ModelOptions, path=os.fsencode(path))
        library.call("haptoflow_model_open", ctypes.byref(options), ctypes.byref(self.handle))

    def __enter__(self) -> NativeModel:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Free the model; does nothing if it is closed already."""
        self._library.call("haptoflow_model_close", ctypes.byref(self.handle))


def built_library(root: Path) -> Path:
    """Where `npm run build` puts the library of the repository at `root`."""
    return root / "build" / "native" / _NAMES.get(sys.platform, "libaudioplugin_haptoflow.so")


def installed_runtime(root: Path) -> Path:
    """Where `npm ci` puts ONNX Runtime in the repository at `root`."""
    plugins = root / "node_modules" / "com.github.asus4.onnxruntime" / "Plugins"
    return plugins / _RUNTIME_NAMES.get(sys.platform, "Linux/x64/libonnxruntime.so")


def open_runtime(library: NativeLibrary, onnx_runtime: Path) -> ctypes.c_void_p:
    """A handle of ONNX Runtime, which lives until the process ends."""
    if not onnx_runtime.is_file():
        remedy = f"run `npm ci`, or set {RUNTIME_VARIABLE} to ONNX Runtime's library"
        raise InputError(f"{onnx_runtime} does not exist: {remedy}")
    runtime = ctypes.c_void_p()
    options = options_of(_RuntimeOptions, library_path=os.fsencode(onnx_runtime))
    library.call("haptoflow_runtime_open", ctypes.byref(options), ctypes.byref(runtime))
    return runtime


@lru_cache(maxsize=1)
def native_runtime() -> ctypes.c_void_p:
    """ONNX Runtime as `npm ci` installs it, or the one that HAPTOFLOW_ONNXRUNTIME names. InputError with the remedy if it
    is missing."""
    named = os.environ.get(RUNTIME_VARIABLE)
    return open_runtime(native_library(), Path(named) if named else installed_runtime(_ROOT))


@lru_cache(maxsize=1)
def native_library() -> NativeLibrary:
    """The library that `npm run build` makes, or the one that HAPTOFLOW_LIBRARY names. InputError with the remedy if it
    is missing."""
    named = os.environ.get(LIBRARY_VARIABLE)
    return NativeLibrary(Path(named) if named else built_library(_ROOT))
