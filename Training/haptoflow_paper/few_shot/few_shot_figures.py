"""Figures of one condition of a material that was fitted to seconds of recording."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from haptoflow_paper.few_shot.few_shot_cases import FewShotCondition
from haptoflow_paper.metrics import row_metrics
from haptoflow_paper.metrics import temporal_metrics as temporal
from haptoflow_benchmark.metrics import waveform_metrics as metrics

BAND_HZ = (20.0, 450.0)
SETTLING_SAMPLES = 400
_LINES_HZ = (20.0, 800.0)
_MINIMUM_DEPTH = 0.1


def condition_figures(condition: FewShotCondition, wave: NDArray[np.floating]) -> dict[str, float]:
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
    for rate in condition.rib_rates_hz[:1]:
        if _LINES_HZ[0] < rate < _LINES_HZ[1]:
            pitch = [row_metrics.fundamental_hz(each, rate) for each in (made, recorded)]
            cell["rib_fundamental_error_percent"] = 100.0 * abs(pitch[0] / pitch[1] - 1.0)
        if temporal.rib_modulation_depth(recorded, rate) >= _MINIMUM_DEPTH:
            cell["rib_modulation_error_db"] = temporal.rib_modulation_error_db(made, recorded, rate)
    return cell
