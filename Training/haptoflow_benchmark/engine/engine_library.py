"""The native library from Python, with ONNX Runtime."""

from __future__ import annotations

import ctypes
import json
from pathlib import Path
from typing import Any

from haptoflow_training.errors import InputError
from haptoflow_training.native_library import (
    NativeError,
    NativeLibrary,
    built_library,
    installed_runtime,
    open_runtime,
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
