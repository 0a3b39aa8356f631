"""From reference rows to accuracy-time.json, its document and its pictures."""

from __future__ import annotations

import json
import zlib
from pathlib import Path

import numpy as np
import pytest

from haptoflow_training.evaluation import accuracy
from haptoflow_training.evaluation.accuracy_time import merged, table, with_earlier_times
from haptoflow_training.evaluation.accuracy_time_chart import draw_chart
from haptoflow_training.evaluation.accuracy_time_report import draw_spectra, write_document
from haptoflow_training.evaluation.model_stamp import SHIPPED_MODEL
from haptoflow_training.evaluation.reference_rows import REFERENCE_ROWS, reference_waves
from haptoflow_training.evaluation.reference_set import Condition, ReferencePair, conditions
from haptoflow_training.evaluation.row_plan import PlannedRow
from haptoflow_training.evaluation.timing import Milliseconds
from haptoflow_training.export.model_file import read_model_file
from haptoflow_training.recordings.synthetic import load_materials

ROOT = Path(__file__).parents[2]


def _pair(label: str, index: int, seed: int) -> ReferencePair:
    generator = np.random.default_rng(seed)
    smoothing = np.hanning(3 + 6 * index)
    waves = [
        (3.0 ** index * np.convolve(generator.standard_normal(40000), smoothing, mode="same")).astype(np.float32)
        for _ in range(2)
    ]
    motion = np.tile(np.array([0.2, 0.0, 1.0], dtype=np.float32), (40000, 1))
    return ReferencePair(Condition(label, index, "constant", 0.2, 1.0, 0.0, 0.0, 0.0, seed), *waves, motion)


@pytest.fixture(scope="module")
def pairs() -> list[ReferencePair]:
    return [_pair(label, index, 10 * index + number) for index, label in enumerate("ab") for number in range(3)]


def _figures(pairs: list[ReferencePair], name: str) -> dict[str, object]:
    waves = reference_waves(name, pairs, 1)
    nothing = [np.zeros(0, dtype=np.float32)] * len(pairs)
    starts = [np.arange(0, len(wave), 28) for wave in waves]
    rows = accuracy.measure(pairs, accuracy.GeneratedSet(waves, nothing, starts))
    discrimination = accuracy.label_discrimination(accuracy.make_yardstick(pairs).classifier, pairs, waves)
    return {
        "summary": accuracy.summary(rows), "discrimination": discrimination, "parameters": 0, "bytes": 0,
        "drift_db_per_min": None, "seed": 1, "conditions": rows,
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
    result = {"model_sha256": "0" * 64, **table(plan, measured, times, times)}
    assert [row["name"] for row in result["rows"]] == ["standard", "size", "independent-draw"]
    assert [row["seeds"] for row in result["rows"]] == [2, 1, 1] and "by_seed" not in result["rows"][2]
    assert result["rows"][2]["ms_per_segment"] is None

    images = tmp_path / "images"
    images.mkdir()
    draw_chart(result, images / "accuracy-time.png")
    draw_spectra(pairs, [pair.independent for pair in pairs], images / "label-spectra.png", "0" * 64)
    write_document(result, tmp_path / "document.md", images, True, True)
    text = (tmp_path / "document.md").read_text(encoding="utf-8")
    assert "| **standard** |" in text and "| size |" in text and "time only" in text
    assert "images/accuracy-time.png" in text and "| missing" not in text
    assert result["not_measured"] == ["missing"] and "Not measured yet, so not judged: missing." in text
    assert all((images / name).stat().st_size > 5000 for name in ("accuracy-time.png", "label-spectra.png"))


def test_seeds_are_compared_on_the_recordings_that_all_of_them_were_measured_on() -> None:
    # GFC 0.9 everywhere but at the one speed that the second seed was not measured at.
    def condition(label: str, speed: float, gfc: float) -> dict[str, object]:
        figures = dict.fromkeys(("level_error_db", "gfc_segment", "rmse", "lsd_db", "continuity"), 0.5)
        motion = {"label": label, "kind": "constant", "speed_mps": speed, "force_newtons": 1.0}
        return {**motion, **figures, "gfc_recording": gfc, "band_errors_db": [0.0]}

    def result(seed: int, conditions: list[dict[str, object]]) -> dict[str, object]:
        common = {"discrimination": None, "parameters": 5, "bytes": 20, "drift_db_per_min": None}
        return {"seed": seed, "summary": accuracy.summary(conditions), "conditions": conditions, **common}

    whole = [condition(label, speed, 0.5 if speed == 1.0 else 0.9) for label in "ab" for speed in (0.1, 1.0)]
    part = [condition(label, 0.1, 0.8) for label in "ab"]
    plan = [PlannedRow("standard", "HaptoFlow", model="m", seeds=(1, 4))]
    row = table(plan, {"standard": [result(1, whole), result(4, part)]}, {}, {})["rows"][0]
    assert row["recordings"] == 4 and row["gfc_recording"] == pytest.approx(0.7)
    assert row["by_seed"]["seeds"] == [1, 4] and row["by_seed"]["recordings"] == 2
    assert row["by_seed"]["gfc_recording"] == pytest.approx([0.9, 0.8])


def test_every_fourth_recording_is_a_quarter_of_each_label_and_over_labels_every_condition_alike() -> None:
    chosen = conditions(load_materials())
    nothing = np.zeros(0, dtype=np.float32)
    picked = accuracy.every_fourth([ReferencePair(entry, nothing, nothing, nothing) for entry in chosen])
    labels = [pair.condition.label for pair in picked]
    assert len(picked) == len(chosen) // 4 and {labels.count(label) for label in labels} == {2}
    speeds = [pair.condition.speed_mps for pair in picked]
    assert {speeds.count(entry.speed_mps) for entry in chosen} == {len(picked) // 8}


def test_rows_measured_later_join_the_table_in_the_plan_s_order() -> None:
    plan = [PlannedRow("a", "f", model="m"), PlannedRow("b", "f", model="m"), PlannedRow("c", "f", model="m")]
    old = {"machine": "then", "rows": [{"name": "b", "lsd_db": 1.0}, {"name": "c", "lsd_db": 2.0}]}
    new = {"machine": "now", "rows": [{"name": "b", "lsd_db": 3.0}]}
    assert merged(old, new, plan) == {
        "machine": "now", "not_measured": ["a"],
        "rows": [{"name": "b", "lsd_db": 3.0}, {"name": "c", "lsd_db": 2.0}],
    }  # fmt: skip


def test_a_row_whose_model_is_not_there_any_more_keeps_the_times_of_its_own_run_and_says_of_which_day() -> None:
    times = {"ms_per_segment": {"p50": 1.0}, "ms_paced": {"p50": 2.0}, "timed_on": "then"}
    nothing = dict.fromkeys(times)
    old = {"rows": [{"name": "a", "lsd_db": 1.0, **times}, {"name": "b", "lsd_db": 2.0, **times}]}
    timed_now = {"name": "b", **times, "timed_on": "now"}
    new = {"rows": [{"name": "a", "lsd_db": 3.0, **nothing}, timed_now, {"name": "never", **nothing}]}
    assert with_earlier_times(new, old)["rows"] == [
        {"name": "a", "lsd_db": 3.0, **times}, timed_now, {"name": "never", **nothing},
    ]  # fmt: skip


def test_conditions_hold_a_speed_and_a_force_that_training_leaves_out_and_judge_fundamentals_only_in_the_band() -> None:
    chosen = conditions(load_materials())
    assert any(0.25 <= entry.speed_mps < 0.3 for entry in chosen)
    assert any(1.2 <= entry.force_newtons < 1.5 for entry in chosen)
    fundamentals = [entry.expected_fundamental_hz for entry in chosen if entry.expected_fundamental_hz]
    assert fundamentals and min(fundamentals) > 20.0 and max(fundamentals) < 800.0
    assert {entry.label for entry in chosen if entry.expected_fundamental_hz} == {
        material.label for material in load_materials() if material.rulings
    }


@pytest.mark.parametrize("tier", ["draft", "standard", "fine"])
def test_the_kept_row_of_each_shipped_tier_was_measured_with_the_graphs_that_are_shipped(tier: str) -> None:
    graphs = read_model_file(ROOT / SHIPPED_MODEL).graphs
    row = json.loads((ROOT / "Training" / "results" / "rows" / f"{tier}-1.json").read_text(encoding="utf-8"))
    assert row["made_from"]["graphs_crc32"] == f"{zlib.crc32(b''.join(graphs.values())):08x}"
