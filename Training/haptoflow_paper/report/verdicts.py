"""Verdicts between two rows on the same recordings: a difference counts only if chance is excluded."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from haptoflow_paper.metrics.cell_figures import IDENTITY
from haptoflow_paper.metrics.judged_figures import BY_KEY, JUDGED, JudgedFigure
from haptoflow_paper.rows.row_summary import mean_interval

_Cell = Mapping[str, Any]

AHEAD, EVEN, BEHIND = "ahead", "even", "behind"


def verdict(ours: Sequence[_Cell], rival: Sequence[_Cell]) -> dict[str, str]:
    """For each judged figure that both rows have: whether ours is ahead of the rival, even with it or behind it.

    Compared is the error magnitude, rival's less ours, of each recording that both were measured on, averaged over the
    mean of each label. Ahead or behind means that its 95 % bootstrap interval, over recordings within labels, excludes
    zero.
    """
    by_identity = {_identity(cell): cell for cell in ours}
    pairs = [(by_identity[_identity(cell)], cell) for cell in rival if _identity(cell) in by_identity]
    found = {}
    for figure in JUDGED:
        differences = _differences(pairs, figure)
        if differences:
            low, high = mean_interval(differences)
            found[figure.key] = AHEAD if low > 0.0 else BEHIND if high < 0.0 else EVEN
    return found


def _identity(cell: _Cell) -> tuple[Any, ...]:
    return tuple(cell[key] for key in IDENTITY)


def _differences(pairs: Sequence[tuple[_Cell, _Cell]], figure: JudgedFigure) -> dict[str, list[float]]:
    grouped: dict[str, list[float]] = {}
    for ours, theirs in pairs:
        values = [cell.get(figure.key) for cell in (ours, theirs)]
        if values[0] is not None and values[1] is not None:
            difference = figure.size(values[1]) - figure.size(values[0])
            grouped.setdefault(ours["label"], []).append(difference)
    return grouped


@dataclass(frozen=True)
class RivalVerdict:
    """A rival in every figure, by its best variant in each: `variants` names that row by figure."""

    rival: str
    block: str
    by_figure: dict[str, str]
    variants: dict[str, str]

    def figures(self, outcome: str) -> list[str]:
        return [key for key, found in self.by_figure.items() if found == outcome]


def rivals(rows: Sequence[Mapping[str, Any]], blocks: Sequence[str]) -> list[RivalVerdict]:
    """Every rival of the blocks. Rows of one network at several numbers of steps are one rival, represented in each
    figure by its best row: the one whose median is furthest ahead of the row it is judged against, because not all
    are measured on the same recordings."""
    by_name = {row["name"]: row for row in rows}
    grouped: dict[tuple[str, str], list[Mapping[str, Any]]] = {}
    for row in rows:
        if row["block"] in blocks and row.get("verdict"):
            grouped.setdefault((row["block"], row["rival"]), []).append(row)
    return [_joined(rival, block, variants, by_name) for (block, rival), variants in grouped.items()]


def _joined(
    rival: str, block: str, variants: Sequence[Mapping[str, Any]], by_name: Mapping[str, Mapping[str, Any]]
) -> RivalVerdict:
    def lag(row: Mapping[str, Any], figure: JudgedFigure) -> float:
        reference = by_name.get(row.get("against", ""))
        ours = 0.0 if reference is None else figure.size(median_of(reference, figure.key))
        return figure.size(median_of(row, figure.key)) - ours

    by_figure, best = {}, {}
    for key, figure in BY_KEY.items():
        having = [row for row in variants if key in row["verdict"]]
        if having:
            chosen = min(having, key=lambda row: lag(row, figure))
            by_figure[key], best[key] = chosen["verdict"][key], chosen["name"]
    return RivalVerdict(rival, block, by_figure, best)


def median_of(row: Mapping[str, Any], key: str) -> float:
    """The median over cells of a row of accuracy-time.json."""
    spread = row[key] if isinstance(row.get(key), Mapping) else row["cells"][key]
    return float(spread["median"])
