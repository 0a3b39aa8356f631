"""Errors that the user can correct: the command line prints their message without a traceback."""

from __future__ import annotations


class InputError(Exception):
    """A file or a value that the user supplied is wrong. The message names it, what was expected, and a remedy."""
