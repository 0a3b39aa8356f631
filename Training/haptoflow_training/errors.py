"""Errors that the user can correct: the command line prints their message without a traceback."""

from __future__ import annotations


def printable(text: str) -> str:
    """The text for a terminal, which obeys control characters: they, and bytes that are not UTF-8, as `\\x1b`. Lines
    remain."""
    return "".join(
        letter if letter.isprintable() or letter == "\n" else letter.encode("unicode_escape").decode("ascii")
        for letter in text
    )


class InputError(Exception):
    """A file or a value that the user supplied is wrong. The message names it, what was expected, and a remedy."""
