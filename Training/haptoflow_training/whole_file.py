"""Files that are written completely or not at all, and TOML files."""

from __future__ import annotations

import contextlib
import errno
import json
import os
import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from haptoflow_training.errors import InputError

# Options of every command that name a file to write.
_OUTPUT_OPTIONS = ("out", "results", "export", "parity", "page", "chart")


def require_apart(options: Mapping[str, object]) -> None:
    """InputError if an output is the same file as another path of the command's options, by any spelling or link: the
    one rule for both programs, called before a command runs. Folders are left to the command."""
    paths = list(_paths_of(options))
    for option, output in paths:
        if option not in _OUTPUT_OPTIONS or output.is_dir():
            continue
        for other, path in paths:
            if other != option and _is_same_file(output, path):
                use = "writes, too" if other in _OUTPUT_OPTIONS else "reads"
                raise InputError(
                    f"--{option} {output}: is the same file as {path}, which the command {use}; name another file for "
                    f"--{option}"
                )


def _paths_of(options: Mapping[str, object]) -> Iterator[tuple[str, Path]]:
    for option, value in options.items():
        for path in value if isinstance(value, list) else [value]:
            if isinstance(path, Path):
                yield option, path


def _is_same_file(one: Path, other: Path) -> bool:
    try:
        return one.samefile(other)
    except OSError:
        return os.path.normcase(one.resolve()) == os.path.normcase(other.resolve())


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


def write_json(path: Path, content: Mapping[str, Any]) -> None:
    """Write indented JSON, as `write_text`."""
    write_text(path, json.dumps(content, indent=2, ensure_ascii=False) + "\n")


def write_text(path: Path, text: str) -> None:
    """Write UTF-8 atomically: an interrupted run leaves the old file complete."""
    write_whole(path, text.encode("utf-8"))


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


def read_toml(path: Path, expected: str) -> dict[str, Any]:
    """Reads a TOML file. Raises InputError, which says what was `expected`, if the file cannot be read or is not TOML."""
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror}); expected {expected}") from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise InputError(f"{path}: not valid TOML ({error}); expected {expected}") from error
