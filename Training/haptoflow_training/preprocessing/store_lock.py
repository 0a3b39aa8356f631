"""Lets one program at a time prepare a store; the others wait until it is there."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from haptoflow_training.errors import InputError

try:
    import fcntl
except ImportError:  # Windows: two programs must not prepare one store at a time.
    fcntl = None  # type: ignore[assignment]


@contextmanager
def store_lock(out: Path) -> Iterator[None]:
    """Hold the lock file beside the store `out`; waits, and says so, while another program holds it.

    The lock ends with the program that holds it, however that ends; worker processes do not inherit it. It must not
    be taken twice by one program.
    """
    if fcntl is None:
        yield
        return
    path = Path(out).absolute()
    path = path.with_name(path.name + ".lock")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        descriptor = _locked(path)
    except OSError as error:
        raise InputError(f"{path}: cannot be written ({error.strerror}); choose another folder") from error
    try:
        yield
    finally:
        # Removed while it is locked: whoever waits for it notices, and makes a new one.
        path.unlink(missing_ok=True)
        os.close(descriptor)


def _locked(path: Path) -> int:
    while True:
        descriptor = os.open(path, os.O_RDWR | os.O_CREAT, 0o666)
        try:
            _lock(descriptor, path)
            if path.exists() and os.path.samestat(os.fstat(descriptor), path.stat()):
                return descriptor
        except BaseException:
            os.close(descriptor)
            raise
        os.close(descriptor)


def _lock(descriptor: int, path: Path) -> None:
    try:
        fcntl.lockf(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        print(f"waiting: another program prepares {path.with_suffix('')}", file=sys.stderr)
        fcntl.lockf(descriptor, fcntl.LOCK_EX)
    except PermissionError:
        # Some systems report a held lock so.
        fcntl.lockf(descriptor, fcntl.LOCK_EX)
