"""Reads and checks one sensor file of the data set: time and values. Errors name the problem; nothing is guessed."""

from __future__ import annotations

import atexit
import importlib.util
import json
import os
import shutil
import subprocess
from functools import lru_cache
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.errors import InputError
from haptoflow_training.recordings.dataset_layout import SensorKind, ending_of

if TYPE_CHECKING:
    import pandas

_ROOT = Path(__file__).resolve().parents[3]
SCRIPT = _ROOT / "scripts" / "published" / "parquet_server.mjs"
_REMEDY = f"run `npm ci` in {_ROOT} (with Node 18.15 or newer), or `pip install pyarrow`"
_LENGTH_BYTES = 8


def read_parquet(path: Path) -> pandas.DataFrame:
    """The top-level columns in the file's order and precision (int64 stays int64 unless values are missing).

    Without pyarrow, a column that is no number (text, a group, a list, a date) says in every row what it is.
    InputError if neither reader is installed; ValueError if the file is damaged; OSError if it cannot be read.
    """
    import pandas

    if _has_pyarrow():
        return pandas.read_parquet(path, engine="pyarrow")
    return _NodeReader.of_this_process(path).read(path)


@lru_cache
def _has_pyarrow() -> bool:
    return importlib.util.find_spec("pyarrow") is not None


class _NodeReader:
    """A running `parquet_server.mjs`, which explains the protocol."""

    _running: _NodeReader | None = None

    def __init__(self, path: Path) -> None:
        node = shutil.which("node")
        if node is None or not SCRIPT.is_file():
            raise InputError(f"{path}: a Parquet file, and neither pyarrow nor Node is installed; {_REMEDY}")
        self._process = subprocess.Popen([node, str(SCRIPT)], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self._process_id = os.getpid()
        assert self._process.stdin is not None and self._process.stdout is not None
        self._input: IO[bytes] = self._process.stdin
        self._output: IO[bytes] = self._process.stdout
        if "ready" not in self._header():
            self.close()
            raise InputError(f"{path}: a Parquet file, and neither pyarrow nor hyparquet is installed; {_REMEDY}")

    @classmethod
    def of_this_process(cls, path: Path) -> _NodeReader:
        """The reader of this process: a fork must not share its parent's pipes. path: what to name in an error."""
        running = cls._running
        if running is None or running._process_id != os.getpid() or running._process.poll() is not None:
            cls._running = running = cls(path)
            atexit.register(running.close)
        return running

    def read(self, path: Path) -> pandas.DataFrame:
        """The table of one file; errors as of `read_parquet`."""
        import pandas

        content = path.read_bytes()
        try:
            self._input.write(len(content).to_bytes(_LENGTH_BYTES, "little"))
            self._input.write(content)
            self._input.flush()
            header = self._header()
            if "problem" in header:
                raise ValueError(header["problem"])
            columns = [(column["name"], self._values(column, header["rows"])) for column in header["columns"]]
        except (BrokenPipeError, EOFError) as error:
            self.close()
            raise ValueError("Node ended while it read the file") from error
        # By position first, since names may occur twice.
        table = pandas.DataFrame(dict(enumerate(values for _, values in columns)), index=range(header["rows"]))
        return table.set_axis([name for name, _ in columns], axis=1)

    def _header(self) -> dict[str, Any]:
        text = self._exactly(int.from_bytes(self._exactly(_LENGTH_BYTES), "little"))
        header: dict[str, Any] = json.loads(text)
        return header

    def _values(self, column: dict[str, Any], rows: int) -> Any:
        if "kind" in column:
            return [column["kind"]] * rows
        return np.frombuffer(self._exactly(column["bytes"]), dtype=column["dtype"])

    def _exactly(self, count: int) -> bytes:
        content = self._output.read(count)
        if len(content) < count:
            raise EOFError
        return content

    def close(self) -> None:
        """End Node; does nothing in a fork, whose parent needs it."""
        if self._process_id != os.getpid():
            return
        for pipe in (self._input, self._output):
            try:
                pipe.close()
            except BrokenPipeError:
                pass
        self._process.wait()


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
