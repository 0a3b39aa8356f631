"""Problems of a study's files: what is wrong, and where."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

_MAXIMUM_SHOWN = 60


@dataclass(frozen=True)
class Problem:
    """row: as in a spreadsheet, with the header as row 1; 0 and an empty column if the problem has none."""

    file: Path
    what: str
    row: int = 0
    column: str = ""

    def __str__(self) -> str:
        places = [f"row {self.row}"] * (self.row > 0) + [f"column {self.column}"] * (self.column != "")
        return ": ".join(words for words in (str(self.file), ", ".join(places), self.what) if words)


def shown(value: object) -> str:
    """A value as JSON, truncated if it is long."""
    return shortened(json.dumps(value, ensure_ascii=False, default=str))


def shortened(text: str) -> str:
    return text if len(text) <= _MAXIMUM_SHOWN else f"{text[:_MAXIMUM_SHOWN]}..."


def ranges(numbers: Sequence[int]) -> str:
    """Numbers as ranges, for example "1, 4 to 7"."""
    runs: list[list[int]] = []
    for number in numbers:
        if runs and number == runs[-1][1] + 1:
            runs[-1][1] = number
        else:
            runs.append([number, number])
    return ", ".join(str(first) if first == last else f"{first} to {last}" for first, last in runs)


def text_of(path: Path, problems: list[Problem]) -> str | None:
    """The text of a UTF-8 file, with or without byte order mark; None, with a problem appended, if it cannot be
    read."""
    try:
        return path.read_bytes().decode("utf-8-sig")
    except FileNotFoundError:
        other = "sidecar" if path.suffix == ".json" else "log"
        problems.append(Problem(path, f"the {other} is missing; a session is a .csv and a .json of one name"))
    except OSError as error:
        problems.append(Problem(path, f"cannot be read ({error.strerror})"))
    except UnicodeDecodeError:
        problems.append(Problem(path, "not UTF-8 text"))
    return None


def participants_words(count: int) -> str:
    return f"{count} participant{'' if count == 1 else 's'}"
