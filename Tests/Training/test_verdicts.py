"""Verdicts: differences count only if chance is excluded, and rivals are judged as a whole."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from haptoflow_paper.metrics.judged_figures import BY_KEY, spread
from haptoflow_paper.report.verdicts import rivals, verdict
from haptoflow_paper.rows.row_summary import special_figures, summary, with_interval, worst_cells

_LABELS = "abcdef"


def _cells(seed: int, size: float, noise: float = 0.3, **more: Any) -> list[dict[str, Any]]:
    """Ten cells for each label, whose level errors have both signs and about this magnitude."""
    generator = np.random.default_rng(seed)
    return [
        {
            "label": label, "kind": "constant", "speed_mps": 0.1, "force_newtons": 1.0, "direction_degrees": 0.0,
            "crossing_degrees": 0.0, "seed": number,
            "level_error_db": float((-1) ** number * (size + noise * generator.random())), "lsd_db": 1.0, **more,
        }
        for label in _LABELS for number in range(10)
    ]  # fmt: skip


def test_errors_of_opposite_sign_do_not_cancel_in_a_verdict() -> None:
    found = verdict(_cells(1, 0.5), _cells(2, 2.0))
    assert found == {"level_error_db": "ahead", "lsd_db": "even"}
    assert verdict(_cells(2, 2.0), _cells(1, 0.5))["level_error_db"] == "behind"


def test_chance_differences_are_judged_even() -> None:
    outcomes = [verdict(_cells(seed, 1.0, 1.0), _cells(seed + 50, 1.0, 1.0))["level_error_db"] for seed in range(20)]
    assert outcomes.count("even") >= 16


def test_only_recordings_common_to_both_rows_are_compared() -> None:
    # The rival was not measured on the cells that are hard for every row.
    hard = [{**cell, "seed": 100 + cell["seed"], "level_error_db": 9.0} for cell in _cells(1, 0.0)]
    assert verdict([*_cells(1, 0.5), *hard], _cells(2, 2.0))["level_error_db"] == "ahead"
    assert "level_error_db" not in verdict(_cells(1, 0.5), hard)


def test_a_ratio_above_one_and_a_coherence_above_the_recording_s_are_no_advantage() -> None:
    ours, theirs = _cells(1, 0.5, rib_coherence=1.0), _cells(1, 0.5, rib_coherence=1.2)
    assert verdict(ours, theirs)["rib_coherence"] == "even"


def _row(name: str, rival: str, level: float, lsd: float, level_verdict: str, lsd_verdict: str) -> dict[str, Any]:
    values = {"level_error_db": level, "lsd_db": lsd}
    spreads = {key: {"median": value, "p90": value, "worst": value} for key, value in values.items()}
    return {
        "name": name, "rival": rival, "block": "as-published", "cells": spreads,
        "verdict": {"level_error_db": level_verdict, "lsd_db": lsd_verdict},
    }  # fmt: skip


def test_solver_variants_of_one_network_are_one_rival_by_its_best_row_in_each_figure() -> None:
    rows = [
        _row("plain-1", "plain", 8.0, 3.0, "ahead", "even"), _row("plain-16", "plain", 1.0, 5.0, "behind", "ahead"),
        _row("ar", "AR", 1.0, 1.0, "even", "behind"),
    ]  # fmt: skip
    plain, ar = rivals(rows, ("as-published",))
    assert plain.by_figure == {"level_error_db": "behind", "lsd_db": "even"}
    assert plain.variants == {"level_error_db": "plain-16", "lsd_db": "plain-1"}
    assert ar.figures("behind") == ["lsd_db"] and rivals(rows, ("given-the-same",)) == []


def test_a_variant_measured_on_easier_recordings_gains_no_advantage() -> None:
    full, quarter = _row("ours", "", 1.0, 1.0, "", ""), _row("ours-quarter", "", 0.2, 1.0, "", "")
    # 1.5 times our error on the same recordings, and 3 times.
    one = {**_row("one", "plain", 1.5, 2.0, "behind", "ahead"), "against": "ours"}
    two = {**_row("two", "plain", 0.9, 2.5, "ahead", "ahead"), "against": "ours-quarter"}
    found = rivals([{**full, "block": "ours"}, {**quarter, "block": "ours"}, one, two], ("as-published",))
    assert [(entry.rival, entry.variants["level_error_db"]) for entry in found] == [("plain", "one")]


def test_a_spread_is_over_magnitudes_and_uses_the_low_side_of_a_share() -> None:
    values = {-4.0: 1.0, 1.0: 0.9, 2.0: 0.8, -3.0: 0.7, 0.0: 0.6}
    cells = [{"label": "a", "crest_error_db": crest, "rib_coherence": share} for crest, share in values.items()]
    assert spread(cells, BY_KEY["crest_error_db"]) == pytest.approx({"median": 2.0, "p90": 3.6, "worst": 4.0})
    assert spread(cells, BY_KEY["rib_coherence"]) == pytest.approx({"median": 0.8, "p90": 0.64, "worst": 0.6})
    assert spread(cells, BY_KEY["modulation_error_db"]) is None


def test_told_apart_is_spread_over_labels_and_not_over_cells() -> None:
    values = (("a", 40.0), ("a", 60.0), ("b", 90.0), ("b", 100.0))
    cells = [{"label": label, "told_apart_percent": value} for label, value in values]
    assert spread(cells, BY_KEY["told_apart_percent"]) == pytest.approx({"median": 72.5, "p90": 90.5, "worst": 95.0})


def test_the_worst_cells_are_named_with_the_figure_furthest_beyond_its_limit() -> None:
    cells = _cells(1, 0.5)
    cells[7] |= {"level_error_db": -22.0}
    cells[31] |= {"crest_error_db": 7.5, "speed_mps": 0.03}
    found = worst_cells(cells)
    assert (found[0]["label"], found[0]["figure"]) == ("a", "level_error_db")
    assert found[0]["times_limit"] == pytest.approx(10.0)
    assert (found[1]["label"], found[1]["figure"], found[1]["speed_mps"]) == ("d", "crest_error_db", 0.03)


def test_parts_of_the_grid_are_judged_by_their_own_cells() -> None:
    cells = _cells(1, 0.5)
    cells[0] |= {"recorded_kurtosis": 9.0, "kurtosis_log_ratio": -1.0, "crest_error_db": -2.0}
    cells[1] |= {"recorded_kurtosis": 3.0, "kurtosis_log_ratio": -5.0}
    cells[2] |= {"kind": "varying", "recorded_kurtosis": 30.0, "kurtosis_log_ratio": 4.0}
    cells[3] |= {"kind": "oblique", "lsd_db": 3.0}
    cells[4] |= {"speed_mps": 0.01, "level_error_db": -3.0}
    cells[5] |= {"kind": "nap", "level_error_db": 1.0}
    cells[6] |= {"kind": "nap", "level_error_db": -0.5, "direction_degrees": 180.0}
    cells[7] |= {"speed_mps": 1.5, "rib_coherence": 0.1}
    cells[8] |= {"rib_coherence": 0.9}
    found = special_figures(cells)
    assert found["impact_cells"] == 1 and found["impact_kurtosis_log_ratio"]["worst"] == 1.0
    assert found["slow_level_error_db"]["p90"] == 3.0 and found["nap_error_db"] == pytest.approx(1.5)
    assert found["oblique_lsd_db"] == 3.0 and found["straight_lsd_db"] == 1.0
    assert found["rib_coherence"]["worst"] == pytest.approx(0.9) and found["change_level_error_db"] is None


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
