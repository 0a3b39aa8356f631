"""Tables from Parquet files: by pyarrow where it is installed, else by Node with the npm package hyparquet."""

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

from haptoflow_training.errors import InputError

if TYPE_CHECKING:
    import pandas

_ROOT = Path(__file__).resolve().parents[3]
SCRIPT = _ROOT / "scripts" / "parquet" / "serve.mjs"
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
    """A running `serve.mjs`, which explains the protocol."""

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
