"""Reads JSON tables and checks every value; messages name the file, the key and the expected value."""

from __future__ import annotations

from typing import Any, Literal, overload

from haptoflow_training.errors import InputError


class Checked:
    """A table of a JSON document. `where` names the file, `path` the table inside it."""

    def __init__(self, where: str, values: Any, path: str = "") -> None:
        self._where, self._path = where, path
        self._values = values if isinstance(values, dict) else {}

    def __contains__(self, key: str) -> bool:
        return self._values.get(key) is not None

    def failure(self, key: str, expected: str, remark: str = "") -> InputError:
        found = "is missing" if key not in self._values else "is not valid"
        tail = f"; {remark}" if remark else ""
        return InputError(f"{self._where}: '{self._name(key)}' {found}: expected {expected}{tail}")

    def text(self, key: str, default: str | None = None) -> str:
        value = self._values.get(key, default)
        if not isinstance(value, str):
            raise self.failure(key, "a text")
        return value

    def boolean(self, key: str) -> bool:
        value = self._values.get(key)
        if not isinstance(value, bool):
            raise self.failure(key, "true or false")
        return value

    def integer(self, key: str) -> int:
        value = self._values.get(key)
        if isinstance(value, bool) or not isinstance(value, int):
            raise self.failure(key, "a whole number")
        return value

    @overload
    def number(self, key: str, low: float, high: float, *, default: float | None = None) -> float: ...
    @overload
    def number(self, key: str, low: float, high: float, *, optional: Literal[True]) -> float | None: ...
    def number(
        self, key: str, low: float, high: float, *, default: float | None = None, optional: bool = False
    ) -> float | None:
        value = self._values.get(key)
        if value is None and (optional or (default is not None and key not in self._values)):
            return default
        if not _is_number(value, low, high):
            raise self.failure(key, f"a number from {low:g} to {high:g}")
        return float(value)

    def numbers(self, key: str, least: int, most: int, low: float = -1e6, high: float = 1e6) -> list[float]:
        values = self._values.get(key)
        count = str(least) if least == most else f"{least} to {most}"
        if not isinstance(values, list) or not least <= len(values) <= most:
            raise self.failure(key, f"a list of {count} numbers")
        if not all(_is_number(value, low, high) for value in values):
            raise self.failure(key, f"{count} numbers from {low:g} to {high:g}")
        return [float(value) for value in values]

    def rising(
        self, key: str, least: int, most: int, low: float, high: float, *, may_repeat: bool = False
    ) -> list[float]:
        values = self.numbers(key, least, most, low, high)
        pairs = zip(values[:-1], values[1:], strict=True)
        if not all(one < other or (may_repeat and one == other) for one, other in pairs):
            raise self.failure(key, "numbers that rise")
        return values

    def number_rows(self, key: str, rows: int, columns: int, low: float, high: float) -> list[list[float]]:
        values = self._values.get(key)
        if not isinstance(values, list) or len(values) != rows:
            raise self.failure(key, f"{rows} rows, one for each speed")
        for row in values:
            if not isinstance(row, list) or len(row) != columns:
                raise self.failure(key, f"{columns} numbers in each row, one for each frequency")
            if not all(_is_number(value, low, high) for value in row):
                raise self.failure(key, f"numbers from {low:g} to {high:g}")
        return [[float(value) for value in row] for row in values]

    @overload
    def table(self, key: str) -> Checked: ...
    @overload
    def table(self, key: str, *, optional: Literal[True]) -> Checked | None: ...
    def table(self, key: str, *, optional: bool = False) -> Checked | None:
        value = self._values.get(key)
        if value is None and optional:
            return None
        if not isinstance(value, dict):
            raise self.failure(key, "a table")
        return Checked(self._where, value, self._name(key))

    def rows(self, key: str, least: int, most: int) -> list[Checked]:
        values = self._values.get(key)
        if not isinstance(values, list) or not least <= len(values) <= most:
            raise self.failure(key, f"a list of {least} to {most} tables")
        if not all(isinstance(value, dict) for value in values):
            raise self.failure(key, "a list of tables")
        return [Checked(self._where, value, f"{self._name(key)}[{index}]") for index, value in enumerate(values)]

    def _name(self, key: str) -> str:
        return f"{self._path}.{key}" if self._path else key


def _is_number(value: Any, low: float, high: float) -> bool:
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return False
    # Anything that is not a number fails; integers of any length can be compared.
    return low <= value <= high
