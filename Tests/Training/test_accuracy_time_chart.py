"""The chart of accuracy over time: linear axes, bars, a legend, and few names."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
import pytest

from haptoflow_paper.metrics.judged_figures import BY_KEY
from haptoflow_paper.report.accuracy_time_chart import PANELS, chart_lines, chart_points, draw_chart, draw_panel
from haptoflow_paper.rows.row_store import read_row
from haptoflow_paper.rows.row_summary import median_interval, with_interval

matplotlib.use("Agg")
from matplotlib import pyplot

ROOT = Path(__file__).parents[2]
SHIPPED = json.loads((ROOT / "Training" / "haptoflow_paper" / "results" / "accuracy-time.json").read_text(encoding="utf-8"))


def _row(
    name: str, family: str, milliseconds: float | None, lsd: float | None = None, block: str = "as-published"
) -> dict[str, Any]:
    told, intervals = None, {}
    if lsd is not None:
        told = {"median": 60.0 + lsd, "p90": 99.0, "worst": 100.0}
        intervals["lsd_db_interval"] = [lsd - 0.3, lsd + 0.1]
        intervals["told_apart_percent_interval"] = [58.0 + lsd, 61.0 + lsd]
    times = None if milliseconds is None else {"p50": milliseconds}
    return {
        "name": name, "family": family, "block": block, "ms_per_segment": times, "lsd_db": lsd, "told_apart_percent": told,
        **intervals,
    }  # fmt: skip


ROWS = [
    _row("standard", "HaptoFlow", 0.2, 1.1, "ours"),
    _row("plain-euler-1", "plain flow matching", 0.2, 9.0),
    _row("plain-euler-4", "plain flow matching", 0.6, 4.0),
    _row("transformer", "baselines", 0.5, 40.0),
    _row("ar-ribs", "baselines", 0.4, 1.5, "given-the-same"),
    _row("paper-codec-size", "baselines", 12.0),
    _row("one-step-deaf", "ablations", 0.3, 2.0, "ablation"),
    _row("independent-draw", "reference", None, 0.0, "reference"),
]


@pytest.fixture
def axes() -> Iterator[Any]:
    figure, axes = pyplot.subplots()
    yield axes
    pyplot.close(figure)


@pytest.mark.parametrize("panel", PANELS, ids=lambda panel: panel.key)
def test_errors_are_drawn_on_a_linear_axis(axes: Any, panel: Any) -> None:
    draw_panel(axes, panel, ROWS)
    assert axes.get_yscale() == "linear" and axes.get_ylim() == panel.limits


def test_ablations_and_references_are_not_drawn() -> None:
    assert {point.row for point in chart_points(ROWS, "told_apart_percent")} == {
        "standard", "plain-euler-1", "plain-euler-4", "transformer", "ar-ribs",
    }  # fmt: skip


def test_each_point_inside_the_scale_has_a_bar_from_end_to_end_of_its_interval(axes: Any) -> None:
    draw_panel(axes, PANELS[1], ROWS)
    bars = [segment for collection in axes.collections for segment in collection.get_segments()]
    found = sorted((round(float(bar[0][1]), 6), round(float(bar[1][1]), 6)) for bar in bars)
    assert found == [(0.8, 1.2), (1.2, 1.6), (3.7, 4.1), (8.7, 9.1)]


def test_values_beyond_the_scale_are_drawn_at_its_edge_and_written_out(axes: Any) -> None:
    draw_panel(axes, PANELS[1], ROWS)
    texts = {text.get_text(): text for text in axes.texts}
    assert texts["Transformer: 40 dB"].xy == (0.5, 16.0)
    assert not any("Transformer" in text and "40" not in text for text in texts)


def test_only_the_most_important_points_are_named(axes: Any) -> None:
    draw_panel(axes, PANELS[1], ROWS)
    assert {text.get_text() for text in axes.texts} == {
        "standard", "1 Euler step", "AR with ribs", "Transformer: 40 dB", "the paper's sizes: 12 ms (time only)",
        "another recording of the same material",
    }  # fmt: skip


def test_told_apart_is_drawn_as_its_median_and_a_table_without_times_has_no_points() -> None:
    points = {point.row: point for point in chart_points(ROWS, "told_apart_percent")}
    ours = points["standard"]
    assert (ours.value, ours.low, ours.high) == pytest.approx((61.1, 59.1, 62.1))
    assert chart_points([{**row, "ms_per_segment": None} for row in ROWS], "lsd_db") == []


def test_rivals_as_published_are_hollow_and_rivals_given_the_same_are_filled(axes: Any) -> None:
    draw_panel(axes, PANELS[1], ROWS)
    circles = [line for line in axes.lines if line.get_marker() == "o"]
    faces = {(line.get_xdata()[0], line.get_ydata()[0]): line.get_markerfacecolor() for line in circles}
    assert faces[(0.6, 4.0)] == "white" and faces[(0.4, 1.5)] == "#2f7d57"


def test_the_step_counts_of_one_network_are_joined_by_a_line_from_fast_to_slow() -> None:
    lines = chart_lines(chart_points(ROWS, "lsd_db"))
    assert [[point.row for point in line] for line in lines] == [["plain-euler-1", "plain-euler-4"]]


def test_the_legend_explains_every_colour_and_the_bars(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    kept: list[Any] = []
    monkeypatch.setattr(pyplot, "close", kept.append)
    draw_chart({"rows": ROWS, "model_sha256": "0" * 64}, tmp_path / "chart.png")
    legend = kept[0].legends[0]
    colours = {handle.get_color() for handle in legend.get_lines()}
    drawn = {line.get_color() for axis in kept[0].axes for line in axis.lines if line.get_marker() in ("o", "*")}
    words = " ".join(text.get_text() for text in legend.get_texts())
    assert drawn and drawn <= colours
    assert "95 % interval over recordings" in words and "beyond the scale" in words


@pytest.mark.parametrize("name", ["standard", "draft"])
def test_the_bars_are_bootstrap_intervals_over_the_stored_recordings_of_the_row(name: str) -> None:
    kept = read_row(ROOT / "Training" / "haptoflow_paper" / "results" / "rows" / f"{name}-1.json")["conditions"]
    assert len(kept) == next(row for row in SHIPPED["rows"] if row["name"] == name)["recordings"]
    for panel in PANELS:
        point = next(entry for entry in chart_points(SHIPPED["rows"], panel.key) if entry.row == name)
        if panel.key == "lsd_db":
            ends = with_interval(kept, panel.key)[1:]
        else:
            ends = median_interval(kept, BY_KEY[panel.key])
        assert (point.low, point.high) == pytest.approx(ends, abs=2e-3)


@pytest.mark.parametrize("panel", PANELS, ids=lambda panel: panel.key)
def test_no_two_names_in_the_shipped_picture_overlap(axes: Any, panel: Any) -> None:
    axes.figure.set_size_inches(6.0, 5.3)
    draw_panel(axes, panel, SHIPPED["rows"])
    axes.figure.canvas.draw()
    boxes = [text.get_window_extent() for text in axes.texts]
    covered = [
        (first.get_text(), second.get_text())
        for index, first in enumerate(axes.texts) for other, second in enumerate(axes.texts)
        if index < other and boxes[index].overlaps(boxes[other])
    ]  # fmt: skip
    # At least our tiers, the reference and the paper's time.
    assert len(boxes) >= 4 and np.all([box.width > 0 for box in boxes])
    assert covered == []
