"""The columns of a study's log, version 1 (Documentation~/study-files.md), and their allowed values."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass

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
