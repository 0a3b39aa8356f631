"""Figures of the few-shot study over all materials, with intervals."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

_RESAMPLES, _SEED = 400, 11
_INTERVAL = (0.025, 0.975)

Cell = Mapping[str, float]

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
