"""Figures of the few-shot study: of one condition, and of all materials with intervals."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from haptoflow_benchmark.few_shot.few_shot_cases import FewShotCondition
from haptoflow_benchmark.metrics import temporal_metrics as temporal
from haptoflow_benchmark.metrics import waveform_metrics as metrics

BAND_HZ = (20.0, 450.0)
SETTLING_SAMPLES = 400
_LINES_HZ = (20.0, 800.0)
_MINIMUM_DEPTH = 0.1
_RESAMPLES, _SEED = 400, 11
_INTERVAL = (0.025, 0.975)

Cell = Mapping[str, float]


def condition_figures(
    condition: FewShotCondition, wave: NDArray[np.floating], hop_starts: NDArray[np.int64] | None
) -> dict[str, float]:
    """The figures of one condition; those that do not apply to it are left out."""
    made, recorded = wave[SETTLING_SAMPLES:], condition.recorded[SETTLING_SAMPLES:]
    crest = [temporal.crest_factor(each) for each in (made, recorded)]
    cell = {
        "level_error_db": metrics.level_error_db(made, recorded),
        "gfc": metrics.gfc_recording(made, recorded),
        "lsd_db": metrics.log_spectral_distance_db(made, recorded, BAND_HZ),
        "kurtosis_log_ratio": temporal.log_ratio(temporal.kurtosis(made), temporal.kurtosis(recorded)),
        "crest_log_ratio": temporal.log_ratio(*crest),
        "modulation_error_db": temporal.modulation_error_db(made, recorded),
    }
    if hop_starts is not None:
        cell["seam_jump"] = metrics.hop_jump_ratio(made, hop_starts - SETTLING_SAMPLES)
    for rate in condition.rib_rates_hz[:1]:
        if _LINES_HZ[0] < rate < _LINES_HZ[1]:
            pitch = [metrics.fundamental_hz(each, rate) for each in (made, recorded)]
            cell["rib_fundamental_error_percent"] = 100.0 * abs(pitch[0] / pitch[1] - 1.0)
        if temporal.rib_modulation_depth(recorded, rate) >= _MINIMUM_DEPTH:
            cell["rib_modulation_error_db"] = temporal.rib_modulation_error_db(made, recorded, rate)
    return cell


_SUMMARIES = {
    "level_error_median_db": ("level_error_db", lambda values: np.median(np.abs(values))),
    "level_error_p90_db": ("level_error_db", lambda values: np.quantile(np.abs(values), 0.9)),
    "gfc_mean": ("gfc", np.mean),
    "gfc_min": ("gfc", np.min),
    "lsd_median_db": ("lsd_db", np.median),
    "lsd_p90_db": ("lsd_db", lambda values: np.quantile(values, 0.9)),
    "kurtosis_log_ratio": ("kurtosis_log_ratio", lambda values: np.mean(np.abs(values))),
    "crest_log_ratio": ("crest_log_ratio", lambda values: np.mean(np.abs(values))),
    "modulation_error_db": ("modulation_error_db", np.mean),
    "rib_fundamental_error_percent": ("rib_fundamental_error_percent", np.median),
    "rib_modulation_error_db": ("rib_modulation_error_db", lambda values: np.mean(np.abs(values))),
    "seam_jump": ("seam_jump", np.median),
}


def summarised(cells_by_material: Sequence[Sequence[Cell]]) -> dict[str, Any]:
    """Each figure over all conditions of all materials, with a 95 % interval from resampling materials."""
    drawn = np.random.default_rng(_SEED).integers(len(cells_by_material), size=(_RESAMPLES, len(cells_by_material)))
    summary: dict[str, Any] = {}
    for name, (key, reduce) in _SUMMARIES.items():
        by_material = [np.array([cell[key] for cell in cells if key in cell]) for cells in cells_by_material]
        if not any(len(values) for values in by_material):
            continue
        values = [np.concatenate([by_material[index] for index in row]) for row in drawn]
        spread = np.quantile([reduce(each) for each in values if len(each)], _INTERVAL)
        summary[name] = {
            "value": round(float(reduce(np.concatenate(by_material))), 4),
            "interval": [round(float(edge), 4) for edge in spread],
        }
    return summary
