"""Summaries of a row's cells: medians with bootstrap intervals, percentiles, and the worst cells."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from haptoflow_paper.report.cell_figures import BY_KEY, IDENTITY, JUDGED, JudgedFigure, by_label, spread
from haptoflow_paper.rows.reference_conditions import STEADY_KINDS

_Cell = Mapping[str, Any]

_DRAWS = 500
_INTERVAL = (0.025, 0.975)
# Figures with a headline of their own: the median over labels of each label's mean, with its sign.
_HEADLINES = ("level_error_db", "gfc_recording", "gfc_segment", "rmse", "lsd_db", "continuity")
# Figures whose spread is stored under their own name; those of figures with headlines are stored under `cells`.
SPREAD_KEYS = (
    "crest_error_db",
    "kurtosis_log_ratio",
    "envelope_kurtosis_log_ratio",
    "envelope_variation_log_ratio",
    "modulation_error_db",
    "rib_modulation_error_db",
    "rib_coherence",
    "told_apart_percent",
)
_IMPACT_KURTOSIS = 4.0
_MINIMUM_SPEED_MPS = 0.01
_RIB_SPEEDS_MPS = (0.01, 0.5)
_LISTED_CELLS = 3


def summary(cells: Sequence[_Cell]) -> dict[str, Any]:
    """The accuracy part of a row of accuracy-time.json; empty without cells. Intervals are 95 % bootstrap intervals
    over recordings, within labels."""
    if not cells:
        return {}
    result: dict[str, Any] = {}
    for key in _HEADLINES:
        result[key] = over_labels(cells, key)
        if result[key] is not None:
            result[f"{key}_interval"] = list(with_interval(cells, key)[1:])
    result["level_error_p90_db"] = level_error_p90_db(cells)
    result["level_error_worst_db"] = float(np.max(np.abs(_values(cells, "level_error_db"))))
    result["band_error_db"] = _median(cells, "band_error_db")
    result["gfc_label_worst"] = min(float(np.mean(values)) for values in by_label(cells, "gfc_recording").values())
    result["f0_error_percent"] = _median(cells, "f0_error_percent")
    result["harmonic_share"] = _median(cells, "harmonic_share")
    for key in SPREAD_KEYS:
        result[key] = spread(cells, BY_KEY[key])
        if result[key] is not None:
            result[f"{key}_interval"] = list(median_interval(cells, BY_KEY[key]))
    result["cells"] = {figure.key: spread(cells, figure) for figure in JUDGED if figure.key not in SPREAD_KEYS}
    result["special"] = special_figures(cells)
    result["worst_cells"] = worst_cells(cells)
    return result


def label_table(cells: Sequence[_Cell]) -> dict[str, dict[str, float]]:
    """For each label and figure, the error that nine in ten of its cells do not exceed."""
    table: dict[str, dict[str, float]] = {}
    for label in dict.fromkeys(cell["label"] for cell in cells):
        own = [cell for cell in cells if cell["label"] == label]
        found = {figure.key: spread(own, figure) for figure in JUDGED}
        table[label] = {key: values["p90"] for key, values in found.items() if values is not None}
    return table


def worst_cells(cells: Sequence[_Cell]) -> list[dict[str, Any]]:
    """The three cells that are furthest beyond a limit, each with the figure and the multiple of its limit."""
    found = []
    for cell in cells:
        over = [
            (figure.size(cell[figure.key]) / figure.limit, figure)
            for figure in JUDGED
            if not figure.over_labels and cell.get(figure.key) is not None
        ]
        if over:
            times, figure = max(over, key=lambda entry: entry[0])
            identity = {key: cell[key] for key in IDENTITY}
            found.append({**identity, "figure": figure.key, "value": cell[figure.key], "times_limit": times})
    return sorted(found, key=lambda entry: -entry["times_limit"])[:_LISTED_CELLS]


def special_figures(cells: Sequence[_Cell]) -> dict[str, Any]:
    """Figures of parts of the grid that goals need; None if there is no such cell."""
    steady = [cell for cell in cells if cell["kind"] in STEADY_KINDS]
    impacts = [cell for cell in steady if (cell.get("recorded_kurtosis") or 0.0) > _IMPACT_KURTOSIS]
    ribs = [cell for cell in steady if _RIB_SPEEDS_MPS[0] <= cell["speed_mps"] <= _RIB_SPEEDS_MPS[1]]
    ruled = {cell["label"] for cell in cells if cell["kind"] == "oblique"}
    oblique = [cell for cell in cells if cell["kind"] == "oblique"]
    compared = {cell["speed_mps"] for cell in oblique}
    straight = [
        cell for cell in cells
        if cell["label"] in ruled and cell["kind"] == "constant" and cell["speed_mps"] in compared
    ]  # fmt: skip
    return {
        "impact_cells": len(impacts),
        "impact_kurtosis_log_ratio": _part(impacts, "kurtosis_log_ratio"),
        "impact_crest_error_db": _part(impacts, "crest_error_db"),
        "rib_modulation_error_db": _part(ribs, "rib_modulation_error_db"),
        "rib_coherence": _part(ribs, "rib_coherence"),
        "ruled_lsd_db": _part([cell for cell in cells if cell["label"] in ruled], "lsd_db"),
        "straight_lsd_db": over_labels(straight, "lsd_db"),
        "oblique_lsd_db": over_labels(oblique, "lsd_db"),
        "slow_level_error_db": _part([cell for cell in steady if cell["speed_mps"] == _MINIMUM_SPEED_MPS], "level_error_db"),
        "nap_error_db": _nap_error_db(cells),
        "change_level_error_db": _plain_spread(cells, "change_level_error_db"),
        "change_crest_error_db": _plain_spread(cells, "change_crest_error_db"),
    }


def _part(cells: Sequence[_Cell], key: str) -> dict[str, float] | None:
    return spread(cells, BY_KEY[key])


def _plain_spread(cells: Sequence[_Cell], key: str) -> dict[str, float] | None:
    found = np.abs(_values(cells, key))
    if not len(found):
        return None
    return {"median": float(np.median(found)), "p90": float(np.quantile(found, 0.9)), "worst": float(found.max())}


def _nap_error_db(cells: Sequence[_Cell]) -> float | None:
    """The largest error, over labels with a nap and speeds, of the difference between motion against and along the
    nap."""
    levels: dict[tuple[str, float], list[float]] = {}
    for cell in cells:
        if cell["kind"] == "nap" and cell.get("level_error_db") is not None:
            levels.setdefault((cell["label"], cell["speed_mps"]), []).append(cell["level_error_db"])
    errors = [abs(pair[0] - pair[1]) for pair in levels.values() if len(pair) == 2]
    return max(errors, default=None)


def level_error_p90_db(cells: Sequence[_Cell]) -> float:
    """The level error's magnitude that nine in ten recordings do not exceed."""
    return float(np.quantile(np.abs(_values(cells, "level_error_db")), 0.9))


def over_labels(cells: Sequence[_Cell], key: str) -> float | None:
    """Median over labels of each label's mean; None if no cell has the figure."""
    grouped = by_label(cells, key)
    return float(np.median([np.mean(values) for values in grouped.values()])) if grouped else None


def with_interval(cells: Sequence[_Cell], key: str, seed: int = 0) -> tuple[float, float, float]:
    """`over_labels` of a figure that at least one cell has, and the ends of its interval."""
    grouped = by_label(cells, key)
    draws = np.median(_resampled_means(grouped, seed), axis=0)
    low, high = np.quantile(draws, _INTERVAL)
    return float(np.median([np.mean(values) for values in grouped.values()])), float(low), float(high)


def median_interval(cells: Sequence[_Cell], figure: JudgedFigure, seed: int = 0) -> tuple[float, float]:
    """Ends of the interval of the spread's median, the lower value first."""
    grouped = by_label(cells, figure.key)
    if figure.over_labels:
        draws = np.median(_resampled_means(grouped, seed), axis=0)
    else:
        sizes = {label: [figure.size(value) for value in values] for label, values in grouped.items()}
        draws = np.median(np.concatenate(_resampled(sizes, seed), axis=1), axis=1)
    ends = [figure.shown(float(value)) for value in np.quantile(draws, _INTERVAL)]
    return min(ends), max(ends)


def mean_interval(grouped: Mapping[str, Sequence[float]], seed: int = 0) -> tuple[float, float]:
    """Ends of the interval of the mean over labels of each label's mean."""
    draws = np.mean(_resampled_means(grouped, seed), axis=0)
    low, high = np.quantile(draws, _INTERVAL)
    return float(low), float(high)


def _resampled(grouped: Mapping[str, Sequence[float]], seed: int) -> list[NDArray[np.float64]]:
    """For each label, [draws, n]: its values drawn again with replacement."""
    generator = np.random.default_rng(seed)
    result = []
    for values in grouped.values():
        array = np.asarray(values, dtype=np.float64)
        result.append(array[generator.integers(0, len(array), (_DRAWS, len(array)))])
    return result


def _resampled_means(grouped: Mapping[str, Sequence[float]], seed: int) -> list[NDArray[np.float64]]:
    return [values.mean(axis=1) for values in _resampled(grouped, seed)]


def _values(cells: Sequence[_Cell], key: str) -> NDArray[np.float64]:
    return np.array([cell[key] for cell in cells if cell.get(key) is not None], dtype=np.float64)


def _median(cells: Sequence[_Cell], key: str) -> float | None:
    found = _values(cells, key)
    return float(np.median(found)) if len(found) else None
