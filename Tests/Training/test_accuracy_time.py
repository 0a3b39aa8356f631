"""From reference rows to accuracy-time.json, its document and its pictures."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from haptoflow_training.evaluation import accuracy
from haptoflow_training.evaluation.accuracy_time import merged, table
from haptoflow_training.evaluation.accuracy_time_report import draw_chart, draw_spectra, write_document
from haptoflow_training.evaluation.reference_rows import REFERENCE_ROWS, reference_waves
from haptoflow_training.evaluation.reference_set import Condition, ReferencePair, conditions
from haptoflow_training.evaluation.row_plan import PlannedRow
from haptoflow_training.evaluation.timing import Milliseconds
from haptoflow_training.recordings.synthetic import load_materials


def _pair(label: str, index: int, seed: int) -> ReferencePair:
    generator = np.random.default_rng(seed)
    smoothing = np.hanning(3 + 6 * index)
    waves = [
        (3.0 ** index * np.convolve(generator.standard_normal(40000), smoothing, mode="same")).astype(np.float32)
        for _ in range(2)
    ]
    motion = np.tile(np.array([0.2, 0.0, 1.0], dtype=np.float32), (40000, 1))
    return ReferencePair(Condition(label, index, "constant", 0.2, 1.0, 0.0, 0.0, seed), *waves, motion)


@pytest.fixture(scope="module")
def pairs() -> list[ReferencePair]:
    return [_pair(label, index, 10 * index + number) for index, label in enumerate("ab") for number in range(3)]


def _figures(pairs: list[ReferencePair], name: str) -> dict[str, object]:
    waves = reference_waves(name, pairs, 1)
    nothing = [np.zeros(0, dtype=np.float32)] * len(pairs)
    starts = [np.arange(0, len(wave), 28) for wave in waves]
    rows = accuracy.measure(pairs, accuracy.GeneratedSet(waves, nothing, starts))
    discrimination = accuracy.label_discrimination(accuracy.make_yardstick(pairs), waves)
    return {
        "summary": accuracy.summary(rows), "discrimination": discrimination, "parameters": 0, "bytes": 0,
        "drift_db_per_min": None,
    }  # fmt: skip


def test_the_reference_rows_stand_where_theory_puts_them(pairs: list[ReferencePair]) -> None:
    found = {name: _figures(pairs, name) for name in REFERENCE_ROWS}
    draw, mean, white, silence = (found[name]["summary"] for name in REFERENCE_ROWS)
    assert abs(draw["level_error_db"]) < 0.3 and draw["gfc_recording"] > 0.99 and draw["lsd_db"] < 1.0  # type: ignore[index]
    assert mean["lsd_db"] < 2.0 < white["lsd_db"]  # type: ignore[index]
    assert abs(white["level_error_db"]) < 0.3  # type: ignore[index]
    assert silence["rmse"] == pytest.approx(1.0, abs=0.01)  # type: ignore[index]
    assert draw["rmse"] == pytest.approx(np.sqrt(2.0), abs=0.05)  # type: ignore[index]
    assert found["independent-draw"]["discrimination"] == 1.0
    assert found["white-noise"]["discrimination"] < 1.0  # type: ignore[operator]


def test_the_table_keeps_the_plan_s_order_and_leaves_out_what_was_not_measured(
    pairs: list[ReferencePair], tmp_path: Path
) -> None:
    plan = [PlannedRow("standard", "HaptoFlow", model="m"), PlannedRow("missing", "baselines", model="n")]
    plan += [PlannedRow("size", "baselines", model="s", time_only=True), PlannedRow("independent-draw", "reference")]
    figures = _figures(pairs, "independent-draw")
    timed = {"summary": {}, "discrimination": None, "parameters": 5, "bytes": 20, "drift_db_per_min": None}
    measured = {"independent-draw": [figures], "standard": [figures, figures], "size": [timed]}
    times = {"standard": Milliseconds(0.2, 0.3), "size": Milliseconds(20.0, 30.0)}
    result = table(plan, measured, times, times)
    assert [row["name"] for row in result["rows"]] == ["standard", "size", "independent-draw"]
    assert result["rows"][0]["seeds"] == 2 and len(result["rows"][0]["lsd_db_seeds"]) == 2
    assert result["rows"][2]["ms_per_segment"] is None

    images = tmp_path / "images"
    images.mkdir()
    draw_chart(result, images / "accuracy-time.png")
    draw_spectra(pairs, [pair.independent for pair in pairs], images / "label-spectra.png")
    write_document(result, tmp_path / "document.md", images, True, True)
    text = (tmp_path / "document.md").read_text(encoding="utf-8")
    assert "| **standard** |" in text and "| size |" in text and "time only" in text
    assert "images/accuracy-time.png" in text and "| missing" not in text
    assert result["not_measured"] == ["missing"] and "Not measured yet, so not judged: missing." in text
    assert all((images / name).stat().st_size > 5000 for name in ("accuracy-time.png", "label-spectra.png"))


def test_rows_measured_later_join_the_table_in_the_plan_s_order() -> None:
    plan = [PlannedRow("a", "f", model="m"), PlannedRow("b", "f", model="m"), PlannedRow("c", "f", model="m")]
    old = {"machine": "then", "rows": [{"name": "b", "lsd_db": 1.0}, {"name": "c", "lsd_db": 2.0}]}
    new = {"machine": "now", "rows": [{"name": "b", "lsd_db": 3.0}]}
    assert merged(old, new, plan) == {
        "machine": "now", "not_measured": ["a"],
        "rows": [{"name": "b", "lsd_db": 3.0}, {"name": "c", "lsd_db": 2.0}],
    }  # fmt: skip


def test_conditions_hold_a_speed_and_a_force_that_training_leaves_out_and_judge_fundamentals_only_in_the_band() -> None:
    chosen = conditions(load_materials())
    assert any(0.25 <= entry.speed_mps < 0.3 for entry in chosen)
    assert any(1.2 <= entry.force_newtons < 1.5 for entry in chosen)
    fundamentals = [entry.expected_fundamental_hz for entry in chosen if entry.expected_fundamental_hz]
    assert fundamentals and min(fundamentals) > 20.0 and max(fundamentals) < 800.0
    assert {entry.label for entry in chosen if entry.expected_fundamental_hz} == {
        material.label for material in load_materials() if material.rulings
    }
