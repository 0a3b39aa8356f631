"""The goals of the default tier, judged from accuracy-time.json."""

from __future__ import annotations

from typing import Any

import pytest

from haptoflow_paper.report.cell_figures import BY_KEY, spread
from haptoflow_paper.report.accuracy_time import rivals, verdict
from haptoflow_paper.report.goals import Goal, judge
from haptoflow_paper.rows.row_summary import summary, with_interval

_FAST = {"level_error_db": -0.5, "gfc_recording": 0.986, "lsd_db": 2.0}


def _spread(value: float) -> dict[str, float]:
    return {"median": value, "p90": value, "worst": value}


def _good() -> dict[str, Any]:
    return {
        "level_error_db": -0.2, "gfc_recording": 0.991, "gfc_label_worst": 0.96, "lsd_db": 0.8, "drift_db_per_min": 0.02,
        "told_apart_percent": {"median": 58.0, "p90": 65.0, "worst": 69.0},
        "cells": {"level_error_db": _spread(0.6), "gfc_recording": _spread(0.98), "lsd_db": _spread(1.7),
                  "f0_error_percent": _spread(0.5), "harmonic_share": _spread(0.9)},
        "special": {"slow_level_error_db": _spread(2.0), "ruled_lsd_db": _spread(1.3), "nap_error_db": 0.5,
                    "impact_kurtosis_log_ratio": _spread(0.45), "impact_crest_error_db": _spread(1.2),
                    "rib_modulation_error_db": _spread(2.0), "rib_coherence": _spread(0.9),
                    "straight_lsd_db": 1.0, "oblique_lsd_db": 1.4},
    }  # fmt: skip


def _row(name: str, block: str, hot: float | None, paced: float | None = None, **figures: Any) -> dict[str, Any]:
    times = [None if value is None else {"p50": value, "p99": value} for value in (hot, paced)]
    return {"name": name, "block": block, "rival": name, "ms_per_segment": times[0], "ms_paced": times[1], **figures}


_EARNED = dict.fromkeys(
    ("lsd_db", "gfc_recording", "told_apart_percent", "rib_modulation_error_db", "kurtosis_log_ratio"), "ahead"
)


def _table(**standard: Any) -> dict[str, Any]:
    rival = {"verdict": {"level_error_db": "ahead", "lsd_db": "even"}, **_good()}
    return {
        "model_bytes": 9 * 2**20,
        "rows": [
            _row("standard", "ours", 0.2, 0.5, fast=[_FAST, _FAST], **{**_good(), **standard}),
            _row("draft", "ours", 0.1, 0.3, verdict=dict(_EARNED), **_good()),
            _row("sketch", "ours", 0.05, 0.08, verdict=dict(_EARNED), **_good()),
            _row("ar", "as-published", 0.4, 0.9, **rival),
            _row("ar-ribs", "given-the-same", 0.4, 0.9, **rival),
            _row("paper-codec-size", "as-published", 31.0, 32.0),
        ],
    }


def _named(goals: list[Goal], beginning: str) -> Goal:
    """The goal of this name, or the only one that begins so."""
    found = [goal for goal in goals if goal.what == beginning] or [
        goal for goal in goals if goal.what.startswith(beginning)
    ]
    assert len(found) == 1, [goal.what for goal in goals]
    return found[0]


def test_a_table_that_reaches_every_goal_meets_all_of_them() -> None:
    goals = judge(_table())
    assert len(goals) == 37 and all(goal.holds for goal in goals), [goal for goal in goals if not goal.holds]


@pytest.mark.parametrize(
    ("part", "figure", "value", "beginning"),
    [
        ("", "level_error_db", -0.3, "size of the median"),
        ("cells", "level_error_db", _spread(0.8), "level, nine"),
        ("special", "slow_level_error_db", _spread(2.3), "level at 10 mm/s"),
        ("", "gfc_recording", 0.987, "GFC"),
        ("", "gfc_label_worst", 0.94, "GFC of the worst label"),
        ("", "lsd_db", 0.95, "LSD, dB"),
        ("cells", "lsd_db", _spread(1.9), "LSD, nine"),
        ("special", "ruled_lsd_db", _spread(1.5), "LSD of ruled"),
        ("special", "oblique_lsd_db", 1.6, "LSD across ribs"),
        ("cells", "f0_error_percent", _spread(1.1), "error of the fundamental"),
        ("cells", "harmonic_share", _spread(0.7), "harmonic share"),
        ("special", "impact_kurtosis_log_ratio", _spread(0.48), "impacts: factor of kurtosis"),
        ("special", "impact_crest_error_db", _spread(1.6), "impacts: crest"),
        ("special", "rib_modulation_error_db", _spread(3.1), "ribs, 0.01 to 0.5 m/s: modulation"),
        ("special", "rib_coherence", _spread(0.7), "ribs, 0.01 to 0.5 m/s: coherence"),
        ("special", "nap_error_db", 0.8, "nap"),
        ("", "drift_db_per_min", -0.2, "drift"),
        ("", "told_apart_percent", {"median": 61.0, "p90": 65.0, "worst": 69.0}, "told apart from recordings, median"),
        ("", "told_apart_percent", {"median": 58.0, "p90": 65.0, "worst": 71.0}, "told apart from recordings, worst"),
        ("", "fast", [_FAST, {**_FAST, "level_error_db": 0.8}], "level error, 500"),
        ("", "fast", [_FAST, {**_FAST, "gfc_recording": 0.98}], "GFC, 500"),
        ("", "fast", [_FAST, {**_FAST, "lsd_db": 2.5}], "LSD, 500"),
    ],
)
def test_a_figure_beyond_its_limit_misses_its_goal(part: str, figure: str, value: Any, beginning: str) -> None:
    table = _table()
    standard = table["rows"][0]
    (standard[part] if part else standard)[figure] = value
    goals = judge(table)
    assert _named(goals, beginning).holds is False
    assert [goal.what for goal in goals if goal.holds is False] == [_named(goals, beginning).what]


def test_missing_rows_leave_their_goals_unjudged() -> None:
    alone = judge({"rows": [row for row in _table()["rows"] if row["name"] == "standard"]})
    for beginning in (
        "standard ahead of draft", "standard ahead of sketch", "LSD of sketch", "behind a rival, as", "behind a rival, given",
        "times faster than the paper's sizes, hot: standard", "times faster than the paper's sizes, hot: draft",
        "size of the model",
    ):  # fmt: skip
        goal = _named(alone, beginning)
        assert goal.measured == "not measured" and goal.holds is None
    assert judge({"rows": []}) == []


def _test_verdicts_row(name: str, rival: str, level: float, lsd: float, level_verdict: str, lsd_verdict: str) -> dict[str, Any]:
    values = {"level_error_db": level, "lsd_db": lsd}
    spreads = {key: {"median": value, "p90": value, "worst": value} for key, value in values.items()}
    return {
        "name": name, "rival": rival, "block": "as-published", "cells": spreads,
        "verdict": {"level_error_db": level_verdict, "lsd_db": lsd_verdict},
    }  # fmt: skip


def test_solver_variants_of_one_network_are_one_rival_by_its_best_row_in_each_figure() -> None:
    rows = [
        _test_verdicts_row("plain-1", "plain", 8.0, 3.0, "ahead", "even"), _test_verdicts_row("plain-16", "plain", 1.0, 5.0, "behind", "ahead"),
        _test_verdicts_row("ar", "AR", 1.0, 1.0, "even", "behind"),
    ]  # fmt: skip
    plain, ar = rivals(rows, ("as-published",))
    assert plain.by_figure == {"level_error_db": "behind", "lsd_db": "even"}
    assert plain.variants == {"level_error_db": "plain-16", "lsd_db": "plain-1"}
    assert ar.figures("behind") == ["lsd_db"] and rivals(rows, ("given-the-same",)) == []


def test_a_spread_is_over_magnitudes_and_uses_the_low_side_of_a_share() -> None:
    values = {-4.0: 1.0, 1.0: 0.9, 2.0: 0.8, -3.0: 0.7, 0.0: 0.6}
    cells = [{"label": "a", "crest_error_db": crest, "rib_coherence": share} for crest, share in values.items()]
    assert spread(cells, BY_KEY["crest_error_db"]) == pytest.approx({"median": 2.0, "p90": 3.6, "worst": 4.0})
    assert spread(cells, BY_KEY["rib_coherence"]) == pytest.approx({"median": 0.8, "p90": 0.64, "worst": 0.6})
    assert spread(cells, BY_KEY["modulation_error_db"]) is None


def test_a_summary_takes_the_median_over_labels_and_its_interval_covers_it() -> None:
    cells = [
        {"label": label, "kind": "constant", "speed_mps": 0.1, "force_newtons": 1.0, "direction_degrees": 0.0,
         "crossing_degrees": 0.0, "seed": 1, "level_error_db": error, "gfc_recording": 0.9 + 0.01 * error}
        for label, errors in {"a": (0.0, 2.0), "b": (3.0, 5.0), "c": (-9.0, -7.0)}.items()
        for error in errors
    ]  # fmt: skip
    figures = summary(cells)
    assert figures["level_error_db"] == pytest.approx(1.0) == with_interval(cells, "level_error_db")[0]
    assert figures["level_error_worst_db"] == 9.0 and figures["level_error_p90_db"] == pytest.approx(8.0)
    assert figures["gfc_label_worst"] == pytest.approx(0.82)
    low, high = figures["level_error_db_interval"]
    assert low <= 1.0 <= high and high > low
    assert figures["continuity"] is None and figures["f0_error_percent"] is None
    assert summary([]) == {}
