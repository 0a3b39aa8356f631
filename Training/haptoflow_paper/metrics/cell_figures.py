"""The figures of one cell: a recording and the waveform generated for its motion."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from haptoflow_paper.metrics import temporal_metrics as temporal
from haptoflow_benchmark import waveform_metrics as metrics
from haptoflow_paper.metrics import row_metrics
from haptoflow_paper.reference.reference_conditions import Condition, is_on_other_label
from haptoflow_paper.reference.reference_set import ReferencePair

_Floats = NDArray[np.float32]

# The closed loop starts from silence; its settling is not measured.
SETTLING_SAMPLES = 400
_FUNDAMENTALS_HZ = (20.0, 800.0)
# Shallower ribs are masked by jitter and noise; with less coherence in the recording, there is nothing to reproduce.
_MINIMUM_DEPTH, _MINIMUM_COHERENCE = 0.1, 0.4
_BEFORE_CHANGE, _AFTER_CHANGE = 100, 200

IDENTITY = ("label", "kind", "speed_mps", "force_newtons", "direction_degrees", "crossing_degrees", "seed")


def measure_cell(
    pair: ReferencePair, closed: _Floats, opened: _Floats, hop_starts: NDArray[np.int64]
) -> dict[str, Any]:
    """closed: the closed loop's waveform; opened: segments from true previous waveforms, concatenated, or empty.
    Figures that do not apply to the cell are left out."""
    condition = pair.condition
    cell: dict[str, Any] = {key: getattr(condition, key) for key in IDENTITY}
    if condition.kind == "change":
        return cell | _change_figures(closed, pair.recorded)
    generated, recorded = closed[SETTLING_SAMPLES:], pair.recorded[SETTLING_SAMPLES:]
    segments = opened if len(opened) else closed[200:]
    truth = pair.recorded[200 : 200 + len(segments)]
    bands = np.abs(row_metrics.critical_band_errors_db(generated, recorded))
    cell |= {
        "level_error_db": metrics.level_error_db(generated, recorded),
        "gfc_recording": metrics.gfc_recording(generated, recorded),
        "gfc_segment": row_metrics.gfc_segment(segments, truth),
        "rmse": row_metrics.relative_rmse(segments, truth),
        "lsd_db": metrics.log_spectral_distance_db(generated, recorded),
        "band_error_db": float(np.median(bands)),
    }
    if len(hop_starts):
        cell["continuity"] = row_metrics.hop_jump_ratio(generated, hop_starts - SETTLING_SAMPLES)
    return cell | _temporal_figures(generated, recorded) | _rib_figures(condition, generated, recorded)


def _temporal_figures(generated: _Floats, recorded: _Floats) -> dict[str, float]:
    kurtosis = [temporal.kurtosis(wave) for wave in (generated, recorded)]
    envelopes = [temporal.envelope(wave) for wave in (generated, recorded)]
    crest = [temporal.crest_factor(wave) for wave in (generated, recorded)]
    return {
        "recorded_kurtosis": kurtosis[1],
        "crest_error_db": _decibels(crest[0] / crest[1]),
        "kurtosis_log_ratio": temporal.log_ratio(*kurtosis),
        "envelope_kurtosis_log_ratio": temporal.log_ratio(*(temporal.kurtosis(values) for values in envelopes)),
        "envelope_variation_log_ratio": temporal.log_ratio(*(temporal.variation(values) for values in envelopes)),
        "modulation_error_db": temporal.modulation_error_db(generated, recorded),
    }


def _rib_figures(condition: Condition, generated: _Floats, recorded: _Floats) -> dict[str, float]:
    """The figures of the worst family if a surface has two; harmonics are those of the dominant family."""
    if not condition.rib_rates_hz or metrics.rms(generated) == 0.0:
        return {}
    found: dict[str, float] = {}
    swings, steps, errors = [], [], []
    for rate in condition.rib_rates_hz:
        if temporal.rib_modulation_depth(recorded, rate) >= _MINIMUM_DEPTH:
            swings.append(temporal.rib_modulation_error_db(generated, recorded, rate))
        if (reference := row_metrics.rib_coherence(recorded, rate)) >= _MINIMUM_COHERENCE:
            steps.append(min(1.0, row_metrics.rib_coherence(generated, rate) / reference))
        if _FUNDAMENTALS_HZ[0] < rate < _FUNDAMENTALS_HZ[1]:
            made, truth = (row_metrics.fundamental_hz(wave, rate) for wave in (generated, recorded))
            errors.append(100.0 * abs(made / truth - 1.0))
    if swings:
        found["rib_modulation_error_db"] = max(swings, key=abs)
    if steps:
        found["rib_coherence"] = min(steps)
    if errors:
        found["f0_error_percent"] = max(errors)
    if _FUNDAMENTALS_HZ[0] < condition.rib_rates_hz[0] < _FUNDAMENTALS_HZ[1]:
        truth = row_metrics.fundamental_hz(recorded, condition.rib_rates_hz[0])
        shares = [row_metrics.harmonic_share(wave, truth) for wave in (generated, recorded)]
        found["harmonic_share"] = temporal.folded(shares[0] / (shares[1] + 1e-9))
    return found


def _change_figures(generated: _Floats, recorded: _Floats) -> dict[str, float]:
    """Around changes of label, from 50 ms before to 100 ms after: level (of the worse new label) and crest, of
    waveforms divided by the recorded level of the label under the tip."""
    on_other = is_on_other_label(len(recorded))
    levels = np.array([metrics.rms(recorded[on_other == side]) for side in (False, True)]) + 1e-9
    scaled = [np.asarray(wave, dtype=np.float64) / levels[on_other.astype(int)] for wave in (generated, recorded)]
    changes = np.flatnonzero(np.diff(on_other)) + 1
    changes = changes[(changes > SETTLING_SAMPLES) & (changes + _AFTER_CHANGE <= len(recorded))]
    windows = changes[:, None] + np.arange(-_BEFORE_CHANGE, _AFTER_CHANGE)[None, :]
    errors = []
    for side in (False, True):
        chosen = windows[on_other[changes] == side]
        errors.append(metrics.level_error_db(*(wave[chosen].reshape(-1) for wave in scaled)))
    crest = [temporal.crest_factor(wave[windows].reshape(-1)) for wave in scaled]
    return {"change_level_error_db": max(errors, key=abs), "change_crest_error_db": _decibels(crest[0] / crest[1])}


def _decibels(ratio: float) -> float:
    return 20.0 * float(np.log10(max(ratio, 1e-3)))
