"""Verdicts: differences count only if chance is excluded, and rivals are judged as a whole."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from haptoflow_paper.metrics.judged_figures import BY_KEY, spread
from haptoflow_paper.report.accuracy_time import rivals, verdict
from haptoflow_paper.rows.row_summary import special_figures, summary, with_interval

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


def test_a_spread_is_over_magnitudes_and_uses_the_low_side_of_a_share() -> None:
    values = {-4.0: 1.0, 1.0: 0.9, 2.0: 0.8, -3.0: 0.7, 0.0: 0.6}
    cells = [{"label": "a", "crest_error_db": crest, "rib_coherence": share} for crest, share in values.items()]
    assert spread(cells, BY_KEY["crest_error_db"]) == pytest.approx({"median": 2.0, "p90": 3.6, "worst": 4.0})
    assert spread(cells, BY_KEY["rib_coherence"]) == pytest.approx({"median": 0.8, "p90": 0.64, "worst": 0.6})
    assert spread(cells, BY_KEY["modulation_error_db"]) is None


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
