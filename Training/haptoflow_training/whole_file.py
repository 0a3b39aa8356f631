"""Files that are written completely or not at all."""

from __future__ import annotations

import contextlib
import errno
import os
from pathlib import Path

from haptoflow_training.errors import InputError


def write_whole(path: Path, content: bytes) -> None:
    """Write atomically; creates the folder. A full disk leaves the old file unchanged; InputError names the cause."""
    temporary = path.with_suffix(path.suffix + ".part")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        temporary.write_bytes(content)
        os.replace(temporary, path)
    except OSError as error:
        # If the folder is a file, there is nothing to remove, and the first error is the one to report.
        with contextlib.suppress(OSError):
            temporary.unlink(missing_ok=True)
        raise InputError(f"{path}: cannot be written ({error.strerror})") from error


def check_writable(path: Path) -> None:
    """InputError if `write_whole` could not write this file; called before minutes of work. Leaves nothing behind
    but the file's folder."""
    temporary = path.with_suffix(path.suffix + ".part")
    try:
        if path.is_dir():
            raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
        path.parent.mkdir(parents=True, exist_ok=True)
        temporary.write_bytes(b"")
        temporary.unlink()
    except OSError as error:
        raise InputError(f"{path}: cannot be written ({error.strerror})") from error
