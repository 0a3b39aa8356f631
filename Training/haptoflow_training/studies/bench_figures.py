"""The benchmark figures of the delay budget, from bench.json or from the page that publishes it."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from haptoflow_training.errors import InputError

PAPER_ARCHITECTURE = "the paper's architecture"


@dataclass(frozen=True)
class Spread:
    """In ms: the median and the 99th percentile."""

    p50: float
    p99: float


@dataclass(frozen=True)
class Block:
    """How a sound card requests samples: `burst` blocks of `frames` at once."""

    frames: int
    burst: int = 1

    def milliseconds(self, rate_hz: float) -> float:
        return 1000.0 * self.frames * self.burst / rate_hz

    def __str__(self) -> str:
        return str(self.frames) if self.burst == 1 else f"{self.burst} x {self.frames}"


@dataclass(frozen=True)
class BenchFigures:
    """inference_ms: by quality, at the pace of use. onset_ms, stop_ms: from a published contact state to the sound."""

    words: str
    model_sha256: str
    rate_hz: float
    inference_ms: Mapping[str, Spread]
    onset_ms: Mapping[Block, Spread]
    stop_ms: Mapping[Block, Spread]


def read_bench(path: Path) -> BenchFigures:
    """Read the figures. InputError names the file and what is missing in it."""
    try:
        text = path.read_text(encoding="utf-8")
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror}); `npm run bench` writes out/bench.json") from error
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: not UTF-8 text") from error
    try:
        return _from_json(json.loads(text)) if path.suffix == ".json" else _from_page(text)
    except (ValueError, KeyError, TypeError, IndexError, AttributeError) as error:
        raise InputError(f"{path}: not a whole report of the benchmark ({error!r}); run `npm run bench`") from error


def _from_json(report: Mapping[str, Any]) -> BenchFigures:
    machine = report["machine"]
    inference = {name: _spread(one["paced"]) for name, one in report["inference_ms"].items()}
    if "paper_architecture_ms" in report:
        inference[PAPER_ARCHITECTURE] = _spread(report["paper_architecture_ms"]["paced"])
    return BenchFigures(
        f"{report['date']}, {machine['processor']}, {machine['cores']} cores",
        report["model"]["sha256"],
        float(report["sample_rate_hz"]),
        inference,
        _rows(report["onset_ms"]["rows"]),
        _rows(report["stop_ms"]["rows"]),
    )


def _spread(figures: Mapping[str, Any]) -> Spread:
    return Spread(float(figures["p50"]), float(figures["p99"]))


def _rows(rows: Sequence[Mapping[str, Any]]) -> dict[Block, Spread]:
    return {Block(int(row["block_frames"]), int(row["burst_blocks"])): _spread(row) for row in rows}


def _from_page(text: str) -> BenchFigures:
    """The tables that `npm run bench -- --publish` writes: columns are separated by two spaces or more."""
    date = re.search(r"^HaptoFlow .*, quality \w+, (\S+)$", text, re.MULTILINE)
    machine = re.search(r"^(.+, \d+ cores), .*load average", text, re.MULTILINE)
    model = re.search(r"^Model: SHA-256 `([0-9a-f]{64})`", text, re.MULTILINE)
    rate = re.search(r"^callback, \d+ frames at ([\d.]+) kHz, us$", text, re.MULTILINE)
    if not (date and machine and model and rate):
        raise ValueError("no published tables")
    rows = _table(text, "inference, one segment on one thread, ms")
    inference = {cells[0]: Spread(float(cells[-4]), float(cells[-3])) for cells in rows}
    return BenchFigures(
        f"{date[1]}, {machine[1]}",
        model[1],
        1000.0 * float(rate[1]),
        inference,
        _blocks(_table(text, "onset, ms")),
        _blocks(_table(text, "stop, ms")),
    )


def _table(text: str, title: str) -> list[list[str]]:
    """The rows below a title and a line of headings, up to the first line without figures."""
    lines = text.split(f"\n{title}\n")[1].split("\n")[1:]
    rows = []
    for line in lines:
        cells = re.split(r"\s{2,}", line.strip())
        if len(cells) < 4:
            break
        rows.append(cells)
    return rows


def _blocks(rows: Sequence[Sequence[str]]) -> dict[Block, Spread]:
    found = {}
    for cells in rows:
        burst, _, frames = cells[0].rpartition(" x ")
        found[Block(int(frames), int(burst or 1))] = Spread(float(cells[2]), float(cells[3]))
    return found
