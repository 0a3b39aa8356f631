"""Reads the rows of a session's log and checks each field.

csv and pandas accept files that a crash or a spreadsheet has damaged; this reader reports them by row and column.
"""

from __future__ import annotations

import csv
import io
import json
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from haptoflow_training.studies.plans import CONDITIONS, MAIN, PRACTICE

LATENCY = "latency"
SIMILARITY = "similarity"
STUDIES = (LATENCY, SIMILARITY)
FORMAT = "haptoflow-study"
VERSION = 1
ANSWERS = ("yes", "no")
RATINGS = (1, 7)

Value = int | float | str | None
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")
_INTEGER = re.compile(r"[+-]?\d{1,18}")


@dataclass(frozen=True)
class Column:
    """words: the allowed words; otherwise a number from `lowest` to `highest`. An empty field is None."""

    name: str
    words: tuple[str, ...] = ()
    is_text: bool = False
    is_integer: bool = False
    lowest: float = 0.0
    highest: float = math.inf
    may_be_empty: bool = False

    def read(self, text: str) -> Value:
        """The value of a field. ValueError states what is wrong with it."""
        if text == "":
            if self.may_be_empty:
                return None
            raise ValueError("it is empty")
        if self.words:
            if text not in self.words:
                raise ValueError(f"'{text}' is not {' or '.join(self.words)}")
            return text
        return text if self.is_text else self._number(text)

    def _number(self, text: str) -> int | float:
        pattern, kind = (_INTEGER, "a whole number") if self.is_integer else (_NUMBER, "a number")
        if not pattern.fullmatch(text):
            raise ValueError(f"'{text}' is not {kind}")
        value: int | float = int(text) if self.is_integer else float(text)
        if not math.isfinite(value):
            raise ValueError(f"'{text}' is not {kind}")
        if not self.lowest <= value <= self.highest:
            allowed = f"{self.lowest:g} or more" if math.isinf(self.highest) else f"{self.lowest:g} to {self.highest:g}"
            raise ValueError(f"{text} is out of range; expected {allowed}")
        return value


_DELAYS = tuple(Column(name) for name in ("delay_ms", "system_delay_ms", "artificial_delay_ms", "delivered_delay_ms"))
_FIRST = (Column("trial", is_integer=True, lowest=1), Column("block", words=(PRACTICE, MAIN)))
_LAST = (
    Column("response_seconds"),
    Column("elapsed_seconds"),
    *(Column(name, may_be_empty=True) for name in ("contact_seconds", "path_mm", "mean_speed_mmps")),
    Column("mean_force_newtons", may_be_empty=True),
    Column("underruns", is_integer=True, may_be_empty=True),
    Column("attempt", is_integer=True, lowest=1),
)
COLUMNS: Mapping[str, tuple[Column, ...]] = {
    LATENCY: (
        *_FIRST,
        Column("condition", words=CONDITIONS),
        *_DELAYS,
        Column("starts", is_integer=True, may_be_empty=True),
        Column("stops", is_integer=True, may_be_empty=True),
        Column("answer", words=ANSWERS),
        *_LAST,
    ),
    SIMILARITY: (
        *_FIRST,
        Column("material", is_text=True),
        Column("method", is_text=True),
        *_DELAYS,
        *(Column(name, may_be_empty=True) for name in ("real_edges_seconds", "virtual_edges_seconds", "free_seconds")),
        Column("rating", is_integer=True, lowest=RATINGS[0], highest=RATINGS[1]),
        *_LAST,
    ),
}
# The columns that a plan's entry determines, beside trial and block.
PLANNED: Mapping[str, tuple[str, ...]] = {LATENCY: ("condition", "delay_ms"), SIMILARITY: ("material", "method")}


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


Row = Mapping[str, Value]
# Tolerance for sums of values that another program rounded to three decimals.
_DELAY_TOLERANCE_MS = 0.002


def read_rows(path: Path, columns: Sequence[Column], problems: list[Problem]) -> list[tuple[int, Row]] | None:
    """Valid rows with their numbers; None, with problems appended, if there is no table."""
    text = text_of(path, problems)
    if text is None:
        return None
    if text == "":
        problems.append(Problem(path, "empty; expected a header row"))
        return None
    if not text.endswith("\n"):
        what = "half-written, as by a crash; resume the session, which asks its trial again"
        problems.append(Problem(path, what, text.count("\n") + 1))
        text = text[: text.rfind("\n") + 1]
    lines = _lines(path, text, problems)
    header = next(lines, None)
    if header is None or not _is_header(path, header[1], columns, problems):
        return None
    by_name = {column.name: column for column in columns}
    rows = []
    for number, fields in lines:
        if len(fields) != len(header[1]):
            problems.append(Problem(path, f"{len(fields)} fields; expected {len(header[1])}", number))
            continue
        row = _read_row(path, number, dict(zip(header[1], fields, strict=True)), by_name, problems)
        if row is not None:
            rows.append((number, row))
    return rows


def _lines(path: Path, text: str, problems: list[Problem]) -> Iterator[tuple[int, list[str]]]:
    reader = csv.reader(io.StringIO(text, newline=""), strict=True)
    number = 1
    try:
        for fields in reader:
            yield number, fields
            number = reader.line_num + 1
    except csv.Error as error:
        problems.append(Problem(path, f"not CSV: {error}", number))


def _is_header(path: Path, header: Sequence[str], columns: Sequence[Column], problems: list[Problem]) -> bool:
    names = [column.name for column in columns]
    before = len(problems)
    if len(header) == 1 and (";" in header[0] or "\t" in header[0]):
        what = "not separated by commas, as after saving from a spreadsheet; use the study's own file"
        problems.append(Problem(path, what, 1))
        return False
    for name in names:
        if header.count(name) != 1:
            problems.append(Problem(path, "missing" if name not in header else "stands twice", 1, name))
    for name in header:
        if name not in names:
            problems.append(Problem(path, "not a column of this study", 1, shortened(name)))
    return len(problems) == before


def _read_row(
    path: Path, number: int, fields: Mapping[str, str], columns: Mapping[str, Column], problems: list[Problem]
) -> Row | None:
    row: dict[str, Value] = {}
    for name, column in columns.items():
        try:
            row[name] = column.read(fields[name])
        except ValueError as error:
            problems.append(Problem(path, str(error), number, name))
    if len(row) < len(columns):
        return None
    system, artificial, delivered = (
        float(row[name] or 0.0) for name in ("system_delay_ms", "artificial_delay_ms", "delivered_delay_ms")
    )
    if abs(delivered - system - artificial) > _DELAY_TOLERANCE_MS:
        what = f"{delivered:g} is not the sum of system and artificial delay, {system + artificial:g}"
        problems.append(Problem(path, what, number, "delivered_delay_ms"))
        return None
    return row
