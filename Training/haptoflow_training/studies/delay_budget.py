"""The delay of each part of the path from hand movement to vibration, and what is left until people notice the
delay."""

from __future__ import annotations

import io
import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from haptoflow_training.errors import InputError
from haptoflow_training.model_stamp import model_line, picture_metadata, table
from haptoflow_training.studies.plans import TURN_OFF, TURN_ON
from haptoflow_training.studies.simulation import PAPER_CURVES
from haptoflow_training.whole_file import write_whole

PAPER_ARCHITECTURE = "the paper's architecture"


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
    """99th percentiles in ms. inference_ms: by quality, at the pace of use. onset_ms, stop_ms: from a published contact
    state to the sound."""

    words: str
    model_sha256: str
    rate_hz: float
    inference_ms: Mapping[str, float]
    onset_ms: Mapping[Block, float]
    stop_ms: Mapping[Block, float]


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
    inference = {name: float(one["paced"]["p99"]) for name, one in report["inference_ms"].items()}
    if "paper_architecture_ms" in report:
        inference[PAPER_ARCHITECTURE] = float(report["paper_architecture_ms"]["paced"]["p99"])
    return BenchFigures(
        f"{report['date']}, {machine['processor']}, {machine['cores']} cores",
        report["model"]["sha256"],
        float(report["sample_rate_hz"]),
        inference,
        _rows(report["onset_ms"]["rows"]),
        _rows(report["stop_ms"]["rows"]),
    )


def _rows(rows: Sequence[Mapping[str, Any]]) -> dict[Block, float]:
    return {Block(int(row["block_frames"]), int(row["burst_blocks"])): float(row["p99"]) for row in rows}


def _from_page(text: str) -> BenchFigures:
    """The tables that `npm run bench -- --publish` writes: columns are separated by two spaces or more."""
    date = re.search(r"^HaptoFlow .*, quality \w+, (\S+)$", text, re.MULTILINE)
    machine = re.search(r"^(.+, \d+ cores), .*load average", text, re.MULTILINE)
    model = re.search(r"^Model: SHA-256 `([0-9a-f]{64})`", text, re.MULTILINE)
    rate = re.search(r"^callback, \d+ frames at ([\d.]+) kHz, us$", text, re.MULTILINE)
    if not (date and machine and model and rate):
        raise ValueError("no published tables")
    rows = _table(text, "inference, one segment on one thread, ms")
    inference = {cells[0]: float(cells[-3]) for cells in rows}
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


def _blocks(rows: Sequence[Sequence[str]]) -> dict[Block, float]:
    found = {}
    for cells in rows:
        burst, _, frames = cells[0].rpartition(" x ")
        found[Block(int(frames), int(burst or 1))] = float(cells[3])
    return found


REFRESH_RATES_HZ = (72.0, 90.0, 120.0)
_MAIN_BLOCK = Block(256)
_PARTS = (("pose interval", "#4a73b5"), ("inference, p99", "#d1495b"), ("audio block", "#2f7d57"))
_NOT_MEASURED = "not measured here"
_TITLES = {TURN_ON: "Turn-On", TURN_OFF: "Turn-Off"}


@dataclass(frozen=True)
class Budget:
    """In ms. device_ms: from the audio callback to the hand; None if not measured."""

    pose_interval_ms: float
    inference_ms: float
    block_ms: float
    device_ms: float | None = None

    @property
    def known_ms(self) -> float:
        return self.pose_interval_ms + self.inference_ms + self.block_ms + (self.device_ms or 0.0)

    def left_ms(self, condition: str) -> float:
        """The rest until the paper's threshold; negative if it is exceeded."""
        return PAPER_CURVES[condition].x0 - self.known_ms


def budgets(bench: BenchFigures, refresh_hz: float, block: Block, device_ms: float | None) -> dict[str, Budget]:
    """The delay budget of each quality, by name, for the worst case: an event waits for a whole pose interval and a
    whole audio block."""
    return {
        quality: Budget(1000.0 / refresh_hz, inference_ms, block.milliseconds(bench.rate_hz), device_ms)
        for quality, inference_ms in bench.inference_ms.items()
    }


def page_words(bench: BenchFigures, chart: str, device_ms: float | None = None) -> str:
    """Markdown of the page's measured part, with `chart` as the picture's address."""
    main = budgets(bench, REFRESH_RATES_HZ[0], _MAIN_BLOCK, device_ms)
    return "\n\n".join(
        [
            model_line(bench.model_sha256),
            f"Inference and latencies: {bench.words}, as [benchmarks](benchmarks.md) publishes them.",
            _parts_table(main, device_ms),
            f"![Parts of the delay by quality, and the two thresholds of the paper]({chart})",
            "Other frame rates and blocks, quality `standard`, everything but the device:",
            _settings_table(bench, device_ms),
            "The same way measured inside the library, 99th percentile of events, with the frame in which they happen:",
            _measured_table(bench, device_ms),
        ]
    )


def _parts_table(main: Mapping[str, Budget], device_ms: float | None) -> str:
    device = _NOT_MEASURED if device_ms is None else f"{device_ms:.1f}"
    together = "together, without device" if device_ms is None else "together"
    rows: Sequence[tuple[str, Sequence[str]]] = (
        ("pose interval, 72 Hz", [f"{one.pose_interval_ms:.1f}" for one in main.values()]),
        ("inference, p99 at the pace of use", [f"{one.inference_ms:.2f}" for one in main.values()]),
        ("audio block, 256 frames", [f"{one.block_ms:.1f}" for one in main.values()]),
        ("device: driver, converter, amplifier, actuator", [device for _ in main]),
        (f"**{together}**", [f"**{one.known_ms:.1f}**" for one in main.values()]),
        *(
            (f"left before {title}, {PAPER_CURVES[condition].x0} ms", [_left(one, condition) for one in main.values()])
            for condition, title in _TITLES.items()
        ),
    )
    return table(["ms", *main], ([words, *cells] for words, cells in rows))


def _left(budget: Budget, condition: str) -> str:
    left = budget.left_ms(condition)
    return f"{left:.1f}" if left >= 0.0 else f"**passed by {-left:.1f}**"


def _settings_table(bench: BenchFigures, device_ms: float | None) -> str:
    rates = [f"{rate:.0f} Hz, ms" for rate in REFRESH_RATES_HZ]
    rows = []
    for block in sorted(bench.onset_ms, key=lambda each: each.frames * each.burst):
        by_rate = [budgets(bench, rate, block, device_ms)["standard"] for rate in REFRESH_RATES_HZ]
        rows.append([str(block), *(f"{one.known_ms:.1f}" for one in by_rate), _left(by_rate[0], TURN_OFF)])
    return table(["block, frames", *rates, "left before Turn-Off at 72 Hz"], rows)


def _measured_table(bench: BenchFigures, device_ms: float | None) -> str:
    interval = 1000.0 / REFRESH_RATES_HZ[0]
    headings = ["block, frames"]
    for event, title in (("onset", "Turn-On"), ("stop", "Turn-Off")):
        headings += [f"{event}, ms", "with pose interval", f"left before {title}"]
    rows = []
    for block in sorted(bench.onset_ms, key=lambda each: each.frames * each.burst):
        cells = [str(block)]
        for measured_ms, condition in ((bench.onset_ms[block], TURN_ON), (bench.stop_ms[block], TURN_OFF)):
            budget = Budget(interval, 0.0, measured_ms, device_ms)
            cells += [f"{measured_ms:.1f}", f"{budget.known_ms:.1f}", _left(budget, condition)]
        rows.append(cells)
    return table(headings, rows)


def write_chart(path: Path, bench: BenchFigures, device_ms: float | None = None) -> None:
    """Draw a bar for each quality, its parts one after another, and the paper's thresholds; PNG."""
    from matplotlib.figure import Figure

    found = budgets(bench, REFRESH_RATES_HZ[0], _MAIN_BLOCK, device_ms)
    figure = Figure(figsize=(8.6, 1.9 + 0.55 * len(found)), layout="constrained")
    axis = figure.subplots()
    for place, budget in enumerate(found.values()):
        left = 0.0
        values = (budget.pose_interval_ms, budget.inference_ms, budget.block_ms)
        for value, (words, colour) in zip(values, _PARTS, strict=True):
            axis.barh(place, value, left=left, color=colour, label=words if place == 0 else None, height=0.6)
            left += value
        room = PAPER_CURVES[TURN_OFF].x0 - left
        words = "device: not measured here" if device_ms is None else "device"
        width = max(0.0, room if device_ms is None else device_ms)
        axis.barh(place, width, left=left, color="white", edgecolor="#999999", hatch="//", height=0.6,
                  label=words if place == 0 else None)  # fmt: skip
        if device_ms is None:
            axis.text(left + room / 2.0, place, f"{room:.0f} ms left for it", ha="center", va="center", fontsize=9,
                      bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.5})  # fmt: skip
    for condition, colour in ((TURN_OFF, "#222222"), (TURN_ON, "#8a5fb0")):
        threshold = PAPER_CURVES[condition].x0
        axis.axvline(threshold, color=colour, linestyle="--", linewidth=1.4)
        axis.annotate(f"{_TITLES[condition]}\n{threshold} ms", (threshold, -0.6), ha="center", va="bottom",
                      fontsize=9, color=colour, annotation_clip=False)  # fmt: skip
    axis.set_yticks(range(len(found)), list(found))
    axis.set_ylim(len(found) - 0.45, -0.55)
    axis.set_xlim(0.0, 140.0)
    axis.set_xlabel("ms from the hand's movement to the vibration's (72 Hz, blocks of 256 frames)")
    axis.legend(fontsize=8, ncols=4, loc="upper center", bbox_to_anchor=(0.5, -0.24))
    picture = io.BytesIO()
    figure.savefig(picture, format="png", dpi=110, bbox_inches="tight", metadata=picture_metadata(bench.model_sha256))
    write_whole(path, picture.getvalue())
