"""Ends a program on SIGINT or SIGTERM by an exception, so that its files and worker processes are tidied up."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

_SIGNALS = (signal.SIGINT, signal.SIGTERM)
# The signal that came last, until a `stoppable` ends.
_asked: int | None = None
_is_deferred = False


class Stopped(BaseException):
    """A signal asked the program to end. number: of the signal. words: for the user, with how to go on."""

    def __init__(self, number: int, words: str = "") -> None:
        super().__init__(words or f"stopped by {signal.Signals(number).name}")
        self.number = number

    @property
    def exit_code(self) -> int:
        """128 and the signal's number, as shells report it."""
        return 128 + self.number


@contextmanager
def stoppable() -> Iterator[None]:
    """Within it, SIGINT and SIGTERM raise Stopped; a signal that is ignored stays ignored. Outside the main thread,
    which alone receives signals, nothing changes."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = {number: signal.getsignal(number) for number in _SIGNALS}
    chosen = [number for number in _SIGNALS if before[number] != signal.SIG_IGN]
    for number in chosen:
        signal.signal(number, _raise_stopped)
    try:
        yield
    finally:
        _remember(None)
        for number in chosen:
            signal.signal(number, before[number])


@contextmanager
def deferred() -> Iterator[None]:
    """Within it, a signal is only remembered; the code asks by `end_if_stopped`. For pools of processes, which an
    exception at any place breaks."""
    global _is_deferred
    before, _is_deferred = _is_deferred, True
    try:
        yield
    finally:
        _is_deferred = before


def end_if_stopped() -> None:
    """Raise Stopped if a signal came."""
    if _asked is not None:
        raise Stopped(_asked)


def _raise_stopped(number: int, frame: FrameType | None) -> None:
    _remember(number)
    if not _is_deferred:
        raise Stopped(number)


def _remember(number: int | None) -> None:
    global _asked
    _asked = number
