"""The figures by which a row is judged, and their errors: one list for table, verdicts, goals and page."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

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
