"""Reads and checks one sensor file of the data set: time and values. Errors name the problem; nothing is guessed."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.errors import InputError
from haptoflow_training.recordings.dataset_layout import SensorKind, ending_of
from haptoflow_training.recordings.parquet_files import read_parquet

if TYPE_CHECKING:
    import pandas

TOLERATED_SHARE = 0.01
NANOSECONDS = "time_ns"


class DatasetFileError(InputError):
    """A file of the data set does not follow the layout."""

    def __init__(self, path: Path, found: str, expected: str) -> None:
        super().__init__(f"{path}: {found}; expected {expected}")
        self.path = path
        self.found = found
        self.expected = expected

    def __reduce__(self) -> tuple[type[DatasetFileError], tuple[Path, str, str]]:
        return DatasetFileError, (self.path, self.found, self.expected)


def read_table(path: Path) -> pandas.DataFrame:
    """CSV or Parquet by the file's ending."""
    import pandas

    if ending_of(path) == ".parquet":
        return read_parquet(path)
    return pandas.read_csv(path, encoding="utf-8-sig", skipinitialspace=True)


def open_table(path: Path, expected: str) -> pandas.DataFrame:
    """The table as read. DatasetFileError with the expected content if the file is empty, unreadable or not a table."""
    try:
        if path.stat().st_size == 0:
            raise DatasetFileError(path, "empty file", expected)
        return read_table(path)
    except InputError:
        raise
    except OSError as error:
        raise DatasetFileError(path, f"cannot be read ({error.strerror or error})", expected) from error
    except Exception as error:  # pandas and its Parquet engines raise many types for a damaged file
        raise DatasetFileError(path, f"not a table ({str(error).splitlines()[0]})", expected) from error


def read_sensor(path: Path, kind: SensorKind) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """(time [n] in seconds, strictly increasing; values [n] or [n, columns - 1]), all finite. A clock in whole
    nanoseconds, as the hub's release has it, is turned into seconds.

    DatasetFileError if the file is empty, has other columns, contains text, or its clock runs backwards. Up to 1 % of
    rows without a number are dropped, and so are repeated time stamps.
    """
    header = f"columns {','.join(kind.columns)}"
    table = open_table(path, header)
    table, found = _in_seconds(path, table, [str(column).strip() for column in table.columns])
    if not set(kind.columns) <= set(found):
        raise DatasetFileError(path, f"columns {','.join(found)}", header)
    table = table.set_axis(found, axis=1)[list(kind.columns)]
    try:
        numbers = table.to_numpy(dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise DatasetFileError(path, f"text among the numbers ({error})", "numbers only") from error
    if len(numbers) < 2:
        raise DatasetFileError(path, f"{len(numbers)} rows", "2 rows at least")
    broken = ~np.isfinite(numbers).all(axis=1)
    if broken.mean() > TOLERATED_SHARE:
        row = int(broken.argmax())
        column = kind.columns[int((~np.isfinite(numbers[row])).argmax())]
        raise DatasetFileError(path, f"no number in row {row + 2}, column {column}", "finite numbers only")
    numbers = rising_rows(path, numbers[~broken] if broken.any() else numbers)
    values = numbers[:, 1:]
    return numbers[:, 0].copy(), (values[:, 0] if values.shape[1] == 1 else values).copy()


def _in_seconds(path: Path, table: pandas.DataFrame, found: list[str]) -> tuple[pandas.DataFrame, list[str]]:
    """The table and its columns' names, with the column time in seconds in place of time_ns."""
    if NANOSECONDS not in found or "time" in found:
        return table, found
    at = found.index(NANOSECONDS)
    try:
        seconds = table.iloc[:, at].to_numpy() / 1e9
    except TypeError as error:
        raise DatasetFileError(path, f"{NANOSECONDS} is no number ({error})", "whole nanoseconds") from error
    names = [*found[:at], "time", *found[at + 1 :]]
    others = table.set_axis(names, axis=1).drop(columns="time")
    others.insert(at, "time", seconds)
    return others, names


def rising_rows(path: Path, numbers: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rows [n, 1 + columns] whose first column is their time, without repeated time stamps, of which 1 % are
    accepted. DatasetFileError if the clock runs backwards."""
    steps = np.diff(numbers[:, 0])
    if (steps < 0).any():
        row = int((steps < 0).argmax()) + 3
        raise DatasetFileError(path, f"time runs back at row {row}", "rising time stamps")
    repeated = np.concatenate([[False], steps == 0])
    if repeated.mean() > TOLERATED_SHARE or repeated.sum() > len(numbers) - 2:
        raise DatasetFileError(
            path, f"{int(repeated.sum())} of {len(numbers)} time stamps repeat", "rising time stamps"
        )
    return numbers[~repeated] if repeated.any() else numbers
