"""The native library from Python: loading it, and calling its C interface."""

from __future__ import annotations

import ctypes
import os
import sys
from functools import lru_cache
from pathlib import Path
from typing import Any

from haptoflow_training.errors import InputError

LIBRARY_VARIABLE = "HAPTOFLOW_LIBRARY"
_NAMES = {"win32": "audioplugin_haptoflow.dll", "darwin": "libaudioplugin_haptoflow.dylib"}
_BUILT = Path(__file__).resolve().parents[2] / "build" / "native"


class NativeError(InputError):
    """A function of the library failed; the message is the library's own."""


class NativeLibrary:
    """The loaded library, in any thread."""

    def __init__(self, path: Path) -> None:
        if not path.is_file():
            raise InputError(
                f"{path} does not exist: run `npm run build`, or set {LIBRARY_VARIABLE} to HaptoFlow's native library"
            )
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


@lru_cache(maxsize=1)
def native_library() -> NativeLibrary:
    """The library that `npm run build` makes, or the one that HAPTOFLOW_LIBRARY names. InputError with the remedy if it
    is missing."""
    named = os.environ.get(LIBRARY_VARIABLE)
    return NativeLibrary(Path(named) if named else _BUILT / _NAMES.get(sys.platform, "libaudioplugin_haptoflow.so"))
