"""The goals of the default tier, judged from accuracy-time.json: neither met by chance nor missed in silence."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from haptoflow_training.evaluation.accuracy_time_report import write_document
from haptoflow_training.evaluation.goals import Goal, judge

_GOOD = {
    "level_error_db": -0.3, "level_error_p90_db": 1.0, "gfc_recording": 0.991, "gfc_label_worst": 0.96, "lsd_db": 1.2,
    "f0_error_percent": 0.1, "harmonic_share": 0.95, "drift_db_per_min": 0.02,
}  # fmt: skip
_FAST = {"level_error_db": -0.5, "gfc_recording": 0.986, "lsd_db": 2.0}


def _row(name: str, family: str, milliseconds: float | None, **figures: Any) -> dict[str, Any]:
    times = None if milliseconds is None else {"p50": milliseconds, "p99": milliseconds}
    return {"name": name, "family": family, "ms_per_segment": times, **_GOOD, **figures}


def _table(**standard: Any) -> dict[str, Any]:
    size: dict[str, Any] = dict.fromkeys(_GOOD)
    rival = {"level_error_db": 0.5, "gfc_recording": 0.98, "lsd_db": 2.0}
    return {
        "rows": [
            _row("standard", "HaptoFlow", 0.5, **{"fast": [_FAST, _FAST], **standard}),
            _row("draft", "HaptoFlow", 0.2),
            _row("eight-step", "HaptoFlow", 4.0, gfc_recording=0.995, lsd_db=1.0),
            _row("ar", "baselines", 0.4, **rival),
            _row("independent-draw", "reference", None, lsd_db=0.3),
            _row("paper-codec-size", "baselines", 31.0, **size),
        ]
    }


def _named(goals: list[Goal], beginning: str) -> Goal:
    found = [goal for goal in goals if goal.what.startswith(beginning)]
    assert len(found) == 1, [goal.what for goal in goals]
    return found[0]


def test_a_table_that_reaches_everything_holds_everywhere() -> None:
    goals = judge(_table())
    assert len(goals) == 16 and all(goal.holds for goal in goals), [goal for goal in goals if not goal.holds]


@pytest.mark.parametrize(
    ("figure", "value", "beginning"),
    [
        ("level_error_db", -0.6, "size of the level error"),
        ("level_error_p90_db", 2.3, "level error of nine"),
        ("gfc_recording", 0.9899, "GFC by recording"),
        ("gfc_label_worst", 0.94, "GFC of the worst label"),
        ("lsd_db", 1.7, "log-spectral distance, dB"),
        ("f0_error_percent", 1.1, "error of the fundamental"),
        ("harmonic_share", 0.89, "share of power"),
        ("drift_db_per_min", -0.2, "drift"),
        ("lsd_db", 1.4, "log-spectral distance above"),
        ("fast", [_FAST, {**_FAST, "level_error_db": 0.8}], "level error, 500"),
        ("fast", [_FAST, {**_FAST, "gfc_recording": 0.98}], "GFC, 500"),
        ("fast", [_FAST, {**_FAST, "lsd_db": 2.5}], "log-spectral distance, 500"),
    ],
)
def test_a_figure_beyond_its_goal_is_a_goal_missed(figure: str, value: Any, beginning: str) -> None:
    assert _named(judge(_table(**{figure: value})), beginning).holds is False


def test_a_rival_that_is_better_in_one_figure_is_named_and_a_reference_is_no_rival() -> None:
    goal = _named(judge(_table(level_error_db=0.5)), "ahead in")
    assert goal.holds is False and goal.measured == "of 0 of 1, not of ar"


def test_goals_of_time_are_ratios_in_one_run_and_unjudged_without_the_row_to_compare_with() -> None:
    table = _table()
    slow = _named(judge({"rows": [{**row, "ms_per_segment": {"p50": 1.0, "p99": 1.0}} for row in table["rows"]]}), "times faster than the paper's sizes: standard")  # fmt: skip
    assert slow.holds is False and slow.measured == "1"
    missing = judge({"rows": [row for row in table["rows"] if row["name"] in ("standard", "ar")]})
    for beginning in ("times faster than the paper's sizes: draft", "GFC below our", "log-spectral distance above"):
        assert _named(missing, beginning) == Goal(
            _named(missing, beginning).what, _named(missing, beginning).wanted, "not measured", None
        )


def test_without_the_default_tier_nothing_is_judged() -> None:
    assert judge({"rows": []}) == []


def test_the_document_says_which_goals_are_missed(tmp_path: Path) -> None:
    keys = ("gfc_segment", "rmse", "level_error_worst_db", "band_error_db", "continuity", "label_discrimination")
    more = {**dict.fromkeys(keys, 1.0), "evaluations": 1, "ms_paced": None, "timed_on": "today", "parameters": 1, "recordings": 4, "seeds": 1}
    rows = [{**row, **more} for row in _table(gfc_recording=0.9895, kink_db={"median": 0.1, "worst": 0.2})["rows"]]
    for row in rows:
        row.pop("fast", None)
    document = tmp_path / "document.md"
    write_document({"model_sha256": "0" * 64, "date": "today", "machine": "m", "not_measured": [], "rows": rows}, document, tmp_path, False, False)
    text = document.read_text(encoding="utf-8")
    assert "| GFC by recording | at least 0.99 | 0.9895 | **no** |" in text
    assert "| size of the level error, dB | at most 0.5 | 0.3 | yes |" in text
