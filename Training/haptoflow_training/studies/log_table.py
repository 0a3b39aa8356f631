"""Reads the rows of a session's log and checks each field.

csv and pandas accept files that a crash or a spreadsheet has damaged; this reader reports them by row and column.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from haptoflow_training.studies.log_columns import Column, Value
from haptoflow_training.studies.problems import Problem, shortened, text_of

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
