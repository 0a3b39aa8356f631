"""The figures of one cell: a recording and the waveform generated for its motion."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from haptoflow_benchmark import waveform_metrics as metrics
from haptoflow_paper.report import row_metrics, temporal_metrics as temporal
from haptoflow_paper.rows.reference_conditions import Condition, is_on_other_label
from haptoflow_paper.rows.reference_set import ReferencePair

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


_Cell = Mapping[str, Any]


@dataclass(frozen=True)
class JudgedFigure:
    """words: the figure's name on a page. limit: the error that the goals allow nine cells in ten; errors are stated
    in multiples of it. is_share: 1 is right and less is wrong; otherwise 0 is right. over_labels: the figure belongs
    to labels rather than to cells."""

    key: str
    words: str
    limit: float
    is_share: bool = False
    over_labels: bool = False

    def size(self, value: float) -> float:
        """The error's magnitude: 0 or more, 0 is right."""
        return max(0.0, 1.0 - value) if self.is_share else abs(value)

    def shown(self, size: float) -> float:
        """An error's magnitude as the value of the figure with that error."""
        return 1.0 - size if self.is_share else size


JUDGED = (
    JudgedFigure("level_error_db", "level", 2.2),
    JudgedFigure("gfc_recording", "GFC", 0.03, is_share=True),
    JudgedFigure("lsd_db", "LSD", 2.4),
    JudgedFigure("f0_error_percent", "fundamental", 1.0),
    JudgedFigure("harmonic_share", "harmonics", 0.2, is_share=True),
    JudgedFigure("crest_error_db", "crest", 1.5),
    JudgedFigure("kurtosis_log_ratio", "kurtosis", math.log(1.5)),
    JudgedFigure("envelope_kurtosis_log_ratio", "kurtosis of the envelope", math.log(1.5)),
    JudgedFigure("envelope_variation_log_ratio", "variation of the envelope", math.log(1.5)),
    JudgedFigure("modulation_error_db", "modulation", 3.0),
    JudgedFigure("rib_modulation_error_db", "modulation by ribs", 3.0),
    JudgedFigure("rib_coherence", "coherence of ribs", 0.2, is_share=True),
    JudgedFigure("told_apart_percent", "told apart", 80.0, over_labels=True),
)
BY_KEY = {figure.key: figure for figure in JUDGED}


def sizes(cells: Sequence[_Cell], figure: JudgedFigure) -> list[float]:
    """Errors of each cell that has the figure, or of each label if the figure belongs to labels."""
    if figure.over_labels:
        return [figure.size(float(np.mean(values))) for values in by_label(cells, figure.key).values()]
    return [figure.size(cell[figure.key]) for cell in cells if cell.get(figure.key) is not None]


def spread(cells: Sequence[_Cell], figure: JudgedFigure) -> dict[str, float] | None:
    """{median, p90, worst}: nine in ten are at least as good as p90; None if no cell has the figure."""
    found = sizes(cells, figure)
    if not found:
        return None
    values = {"median": np.median(found), "p90": np.quantile(found, 0.9), "worst": np.max(found)}
    return {name: figure.shown(float(value)) for name, value in values.items()}


def by_label(cells: Sequence[_Cell], key: str) -> dict[str, list[float]]:
    """Values of the cells that have them, label by label."""
    grouped: dict[str, list[float]] = {}
    for cell in cells:
        if cell.get(key) is not None:
            grouped.setdefault(cell["label"], []).append(cell[key])
    return grouped
