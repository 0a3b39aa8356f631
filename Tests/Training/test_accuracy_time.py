"""From reference rows to accuracy-time.json, its page and its pictures."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
import pytest
from matplotlib import pyplot

from haptoflow_paper.report.cell_figures import BY_KEY
from haptoflow_paper.rows.reference_conditions import Condition, conditions
from haptoflow_paper.rows.reference_set import REFERENCE_ROWS, ReferencePair, reference_waves
from haptoflow_paper.report.accuracy_time import table, timed_rows, with_times
from haptoflow_paper.report.accuracy_time_chart import PANELS, chart_points, draw_chart, draw_panel, draw_spectra
from haptoflow_paper.report.accuracy_time_report import write_document
from haptoflow_paper.rows import accuracy
from haptoflow_paper.rows.row_plan import PlannedRow
from haptoflow_paper.rows.row_runner import weights_crc32
from haptoflow_paper.rows.row_summary import median_interval, summary, with_interval
from haptoflow_paper.rows.workplace import read_row
from haptoflow_training.model_stamp import SHIPPED_MODEL
from places import ROOT


def _pair(label: str, index: int, seed: int) -> ReferencePair:
    generator = np.random.default_rng(seed)
    smoothing = np.hanning(3 + 6 * index)
    waves = [
        (3.0 ** index * np.convolve(generator.standard_normal(40000), smoothing, mode="same")).astype(np.float32)
        for _ in range(3)
    ]
    motion = np.tile(np.array([0.2, 0.0, 1.0], dtype=np.float32), (40000, 1))
    condition = Condition(label, index, "constant", 0.2, 1.0, 0.0, 20.0, seed)
    # Another piece of the material is 2 dB louder.
    return ReferencePair(condition, *waves[:2], motion, other_specimen=np.float32(10.0**0.1) * waves[2])


@pytest.fixture(scope="module")
def pairs() -> list[ReferencePair]:
    return [_pair(label, index, 10 * index + number) for index, label in enumerate("ab") for number in range(3)]


def _figures(pairs: list[ReferencePair], name: str, gain: float = 1.0) -> dict[str, object]:
    waves = [np.float32(gain) * wave for wave in reference_waves(name, pairs, 1)]
    nothing = [np.zeros(0, dtype=np.float32)] * len(pairs)
    starts = [np.arange(0, len(wave), 28) for wave in waves]
    rows = accuracy.measure(pairs, accuracy.GeneratedSet(waves, nothing, starts))
    discrimination = accuracy.label_discrimination(accuracy.make_yardstick(pairs).classifier, pairs, waves)
    return {
        "discrimination": discrimination, "parameters": 0, "bytes": 0,
        "drift_db_per_min": None, "seed": 1, "conditions": rows,
    }  # fmt: skip


def test_the_reference_rows_have_the_figures_that_theory_predicts(pairs: list[ReferencePair]) -> None:
    found = {name: _figures(pairs, name) for name in REFERENCE_ROWS}
    draw, piece, mean, white, silence = (summary(found[name]["conditions"]) for name in REFERENCE_ROWS)
    assert abs(draw["level_error_db"]) < 0.3 and draw["gfc_recording"] > 0.99 and draw["lsd_db"] < 1.0  # type: ignore[index]
    assert piece["level_error_db"] == pytest.approx(2.0, abs=0.3)  # type: ignore[index]
    assert mean["lsd_db"] < 2.0 < white["lsd_db"]  # type: ignore[index]
    assert abs(white["level_error_db"]) < 0.3  # type: ignore[index]
    assert silence["rmse"] == pytest.approx(1.0, abs=0.01)  # type: ignore[index]
    assert draw["rmse"] == pytest.approx(np.sqrt(2.0), abs=0.05)  # type: ignore[index]
    assert found["independent-draw"]["discrimination"] == 1.0
    assert found["white-noise"]["discrimination"] < 1.0  # type: ignore[operator]


def _measured(pairs: list[ReferencePair]) -> dict[str, list[dict[str, Any]]]:
    draw, noise = _figures(pairs, "independent-draw"), _figures(pairs, "white-noise", 0.5)
    timed = {"discrimination": None, "parameters": 5, "bytes": 20, "drift_db_per_min": None, "conditions": []}
    return {"independent-draw": [draw], "standard": [draw, {**draw, "seed": 2}], "rival": [noise], "size": [timed]}


PLAN = [
    PlannedRow("standard", "ours", model="m"), PlannedRow("missing", "given-the-same", model="n"),
    PlannedRow("rival", "as-published", rival="The Rival", model="r"),
    PlannedRow("size", "as-published", model="s", time_only=True), PlannedRow("independent-draw", "reference"),
]  # fmt: skip
FIGURES = (
    "crest_error_db", "kurtosis_log_ratio", "envelope_kurtosis_log_ratio", "modulation_error_db", "told_apart_percent",
)  # fmt: skip


def test_the_table_keeps_the_plan_s_order_and_leaves_out_unmeasured_rows(pairs: list[ReferencePair]) -> None:
    result = table(PLAN, _measured(pairs))
    assert [row["name"] for row in result["rows"]] == ["standard", "rival", "size", "independent-draw"]
    assert [row["seeds"] for row in result["rows"]] == [2, 1, 1, 1] and "by_seed" not in result["rows"][1]
    assert result["not_measured"] == ["missing"] and timed_rows(result) == {"standard", "rival", "size"}


def test_every_row_has_spreads_of_the_temporal_figures_and_a_verdict(pairs: list[ReferencePair]) -> None:
    rows = {row["name"]: row for row in table(PLAN, _measured(pairs))["rows"]}
    for name in ("standard", "rival", "independent-draw"):
        for figure in FIGURES:
            values = rows[name][figure]
            assert set(values) == {"median", "p90", "worst"} and values["median"] <= values["p90"] <= values["worst"]
            low, high = rows[name][f"{figure}_interval"]
            assert low <= values["median"] <= high
        # Neither label has ribs: the keys are present, with no value.
        assert rows[name]["rib_modulation_error_db"] is None and rows[name]["rib_coherence"] is None
    assert rows["rival"]["verdict"]["lsd_db"] == "ahead" and rows["rival"]["verdict"]["gfc_recording"] == "ahead"
    assert set(rows["independent-draw"]["verdict"].values()) == {"even"} and "verdict" not in rows["standard"]
    assert set(rows["standard"]["by_label"]) == {"a", "b"} and len(rows["rival"]["worst_cells"]) == 3
    json.dumps(rows)


def test_the_page_covers_the_measured_rows_and_starts_with_who_is_ahead(
    pairs: list[ReferencePair], tmp_path: Path
) -> None:
    times = {"p50": 0.2, "p99": 0.3}
    run = {
        "date": "2026-11-23", "commit": "c" * 40, "machine": "m",
        "load_before": [0.1, 0.2, 0.3], "load_after": [1.0, 2.0, 3.0],
        "rows": {name: {"ms_per_segment": times, "ms_paced": times} for name in ("standard", "size")},
    }  # fmt: skip
    result = with_times({"model_sha256": "0" * 64, **table(PLAN, _measured(pairs))}, run)
    assert result["rows"][1]["ms_per_segment"] is None, "a row that the run does not hold has no time"
    images = tmp_path / "images"
    images.mkdir()
    draw_chart(result, images / "accuracy-time.png")
    draw_spectra(pairs, [pair.independent for pair in pairs], images / "label-spectra.png", "0" * 64)
    write_document(result, tmp_path / "document.md", images / "accuracy-time.png", images / "label-spectra.png")
    text = (tmp_path / "document.md").read_text(encoding="utf-8")
    top = "\n".join(text.splitlines()[:10])
    assert "**As published**, 1 rival, 9 comparisons" in top and "ahead in" in top and "behind in 0" in top
    assert "No rival wins in any figure." in top and "**Given the same**: no rival is measured yet." in top
    assert "| **standard** |" in text and "| size |" in text and "time only" in text and "| The Rival |" in text
    assert "images/accuracy-time.png" in text and "Not measured yet, so not judged: missing." in text
    assert "load averages before and after 0.10 / 0.20 / 0.30 and 1.00 / 2.00 / 3.00" in text
    assert all((images / name).stat().st_size > 5000 for name in ("accuracy-time.png", "label-spectra.png"))


@pytest.mark.parametrize("tier", ["sketch", "draft", "standard"])
def test_the_stored_row_of_each_shipped_tier_was_measured_with_the_shipped_weights(tier: str) -> None:
    row = json.loads((ROOT / "Training" / "haptoflow_paper" / "results" / "rows" / f"{tier}-1.json").read_text(encoding="utf-8"))
    assert row["made_from"]["graphs_crc32"] == weights_crc32(ROOT / SHIPPED_MODEL)


matplotlib.use("Agg")


SHIPPED = json.loads((ROOT / "Training" / "haptoflow_paper" / "results" / "accuracy-time.json").read_text(encoding="utf-8"))


@pytest.fixture
def axes() -> Iterator[Any]:
    figure, axes = pyplot.subplots()
    yield axes
    pyplot.close(figure)


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
