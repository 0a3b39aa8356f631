"""The figures of one recording: correct values, and only those that apply to its motion."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from haptoflow_paper.metrics.cell_figures import measure_cell
from haptoflow_paper.reference.reference_conditions import Condition, is_on_other_label
from haptoflow_paper.reference.reference_set import ReferencePair

_SAMPLES = 24000
_NOTHING = np.zeros(0, dtype=np.float32)
_STARTS = np.arange(0, _SAMPLES, 28)


def _noise(seed: int) -> NDArray[np.float32]:
    return np.random.default_rng(seed).standard_normal(_SAMPLES).astype(np.float32)


def _pair(recorded: NDArray[np.float32], kind: str = "constant", **more: Any) -> ReferencePair:
    motion = np.zeros((_SAMPLES, 3), dtype=np.float32)
    condition = Condition("a", 0, kind, 0.1, 1.0, 0.0, 12.0, 1, **more)
    return ReferencePair(condition, recorded, recorded, motion)


def _ribbed(depth: float, rate_hz: float, seed: int, drift: float = 0.0) -> NDArray[np.float32]:
    time = np.arange(_SAMPLES) / 2000.0
    wander = drift * np.cumsum(np.random.default_rng(seed + 1).standard_normal(_SAMPLES)) / np.sqrt(1000.0)
    line = np.cos(2 * np.pi * rate_hz * time + wander)
    return (_noise(seed) * np.sqrt(1.0 + depth * line) + 0.5 * line).astype(np.float32)


def test_gaussian_noise_in_place_of_impacts_lacks_crest_and_kurtosis_but_has_the_right_level() -> None:
    recorded = _noise(1)
    recorded[::400] *= 25.0
    made = _noise(2) * recorded.std()
    cell = measure_cell(_pair(recorded), made, _NOTHING, _STARTS)
    assert abs(cell["level_error_db"]) < 0.3 and cell["recorded_kurtosis"] > 20.0
    assert cell["crest_error_db"] < -5.0 and cell["kurtosis_log_ratio"] < -1.5
    assert cell["envelope_kurtosis_log_ratio"] < -1.0 and cell["envelope_variation_log_ratio"] < -0.5


def test_faint_and_drifting_ribs_are_detected_as_such() -> None:
    pair = _pair(_ribbed(0.9, 50.0, 3), rib_rates_hz=(50.0,))
    good = measure_cell(pair, _ribbed(0.9, 50.0, 5), _NOTHING, _STARTS)
    faint = measure_cell(pair, _ribbed(0.2, 50.0, 5), _NOTHING, _STARTS)
    drifting = measure_cell(pair, _ribbed(0.9, 50.0, 5, drift=3.0), _NOTHING, _STARTS)
    assert abs(good["rib_modulation_error_db"]) < 1.0 and good["rib_coherence"] > 0.95
    assert faint["rib_modulation_error_db"] < -6.0
    assert drifting["rib_coherence"] < 0.5 and good["f0_error_percent"] < 0.2


def test_a_change_of_label_is_judged_near_the_changes_only_and_in_each_direction() -> None:
    elsewhere = is_on_other_label(_SAMPLES)
    levels = np.where(elsewhere, 4.0, 1.0).astype(np.float32)
    pair = _pair(_noise(1) * levels, "change", other_label="b", other_index=1)
    right = measure_cell(pair, _noise(2) * levels, _NOTHING, _STARTS)
    assert abs(right["change_level_error_db"]) < 0.7 and abs(right["change_crest_error_db"]) < 0.7
    assert "level_error_db" not in right and "told_apart_percent" not in right
    # A generator that keeps the old label for 100 ms is detected in both directions.
    late = np.roll(levels, 200)
    assert abs(measure_cell(pair, _noise(2) * late, _NOTHING, _STARTS)["change_level_error_db"]) > 3.0
    away = (np.arange(_SAMPLES) % 1000 > 300) & (np.arange(_SAMPLES) % 1000 < 800)
    loud = _noise(2) * levels * np.where(away, 9.0, 1.0).astype(np.float32)
    assert abs(measure_cell(pair, loud, _NOTHING, _STARTS)["change_level_error_db"]) < 0.7
