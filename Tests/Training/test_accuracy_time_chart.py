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
from haptoflow_paper.report.accuracy_time_chart import PANELS, chart_points, draw_panel
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


def test_each_point_inside_the_scale_has_a_bar_from_end_to_end_of_its_interval(axes: Any) -> None:
    draw_panel(axes, PANELS[1], ROWS)
    bars = [segment for collection in axes.collections for segment in collection.get_segments()]
    found = sorted((round(float(bar[0][1]), 6), round(float(bar[1][1]), 6)) for bar in bars)
    assert found == [(0.8, 1.2), (1.2, 1.6), (3.7, 4.1), (8.7, 9.1)]


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
