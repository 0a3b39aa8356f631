"""The figures of the two studies as SVG, drawn as in the paper. Figures of simulated studies are marked."""

from __future__ import annotations

import io
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from haptoflow_training.studies.latency_analysis import LatencyResult
from haptoflow_training.studies.plans import TURN_OFF, TURN_ON
from haptoflow_training.studies.rating_tests import SIGNIFICANCE, TREND, Pair
from haptoflow_training.studies.similarity_analysis import SimilarityResult

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SIMULATED_WORDS = "SIMULATED: no person took part"
_CONDITIONS = {TURN_ON: ("Turn-On", "#d1495b", "o"), TURN_OFF: ("Turn-Off", "#4a73b5", "s")}
_METHOD_COLOURS = ("#d1495b", "#4a73b5", "#2f7d57", "#e0a030", "#8a5fb0", "#5a8f9c")
_GREEN = "#1e8a3c"
_BRACKET_STEP = 0.55
_COLUMNS = 3


@dataclass(frozen=True)
class Bracket:
    """Connects two methods' bars, by column; level: its height above the bars, from 0."""

    first: int
    second: int
    sign: str
    colour: str
    level: int


def latency_figure(result: LatencyResult, *, is_simulated: bool) -> str:
    """Percentage of yes with standard errors, fitted curves dashed, thresholds with their intervals."""
    figure, (axis,) = _figure(1, 1, 7.2, 4.6, is_simulated)
    for condition, (words, colour, marker) in _CONDITIONS.items():
        points, fit = result.points[condition], result.fits[condition]
        if points:
            axis.errorbar(
                [point.delivered_ms for point in points],
                [point.percent for point in points],
                [0.0 if np.isnan(point.error_percent) else point.error_percent for point in points],
                fmt=marker, color=colour, capsize=3, label=words,
            )  # fmt: skip
        if fit.curve is None:
            continue
        delays = [point.delivered_ms for point in points]
        drawn = np.linspace(min(delays), max(delays), 200)
        axis.plot(drawn, fit.curve.percent(drawn), "--", color=colour, label=f"{words}: {fit.curve.x0:.1f} ms")
        if fit.threshold_interval is not None:
            low, high = fit.threshold_interval.low, fit.threshold_interval.high
            axis.plot([low, high], [50.0, 50.0], color=colour, alpha=0.35, linewidth=6, solid_capstyle="butt")
    axis.axhline(50.0, color="grey", linewidth=0.8)
    axis.set_ylim(-4.0, 104.0)
    axis.set_xlabel("delay (ms)")
    axis.set_ylabel("delay perceived (%)")
    axis.grid(alpha=0.3)
    axis.legend(fontsize=8, loc="lower right")
    return _svg(figure)


def similarity_figure(result: SimilarityResult, *, is_simulated: bool) -> str:
    """A plot for each material: mean ratings with standard errors, brackets over pairs that differ or are
    equivalent."""
    count, methods = len(result.materials), len(result.methods)
    columns = min(_COLUMNS, count)
    rows = -(-count // columns)
    brackets = {name: brackets_of(result.by_material[name].pairs) for name in result.materials}
    levels = max((bracket.level + 1 for found in brackets.values() for bracket in found), default=0)
    top = 7.3 + _BRACKET_STEP * levels
    width, height = 1.4 + 0.55 * methods * columns, 0.9 + rows * (1.9 + 0.22 * levels)
    figure, axes = _figure(rows, columns, width, height, is_simulated)
    for axis in axes[count:]:
        axis.set_visible(False)
    for place, (material, axis) in enumerate(zip(result.materials, axes, strict=False)):
        ratings = result.ratings[place]
        errors = np.std(ratings, axis=0, ddof=1) / np.sqrt(len(ratings))
        colours = [_METHOD_COLOURS[method % len(_METHOD_COLOURS)] for method in range(methods)]
        heights = ratings.mean(axis=0) - 1.0
        axis.bar(range(methods), heights, bottom=1.0, yerr=errors, capsize=3, color=colours, width=0.7)
        for bracket in brackets[material]:
            _draw(axis, bracket)
        axis.set_title(_plain(material), fontsize=10)
        axis.set_ylim(1.0, top)
        axis.set_yticks(range(1, 8))
        axis.set_xticks(range(methods), [_plain(name) for name in result.methods], fontsize=7, rotation=30, ha="right")
        axis.grid(axis="y", alpha=0.3)
        axis.set_axisbelow(True)
        if place % columns == 0:
            axis.set_ylabel("similarity (1-7)")
    return _svg(figure)


def brackets_of(pairs: Sequence[Pair]) -> list[Bracket]:
    """A dagger for p < 0.1, a star for p < 0.05 after correction, a green sign for equivalence; short brackets at
    the bottom."""
    wanted = []
    for pair in pairs:
        if pair.p_shaffer is not None and pair.p_shaffer < TREND:
            wanted.append((pair, "*" if pair.p_shaffer < SIGNIFICANCE else "†", "#222222"))
        if pair.p_equivalence is not None and pair.p_equivalence < SIGNIFICANCE:
            wanted.append((pair, "≈", _GREEN))
    taken: list[list[Bracket]] = []
    for pair, sign, colour in sorted(wanted, key=lambda each: (each[0].second - each[0].first, each[0].first)):
        level = 0
        while level < len(taken) and any(_overlap(pair, other) for other in taken[level]):
            level += 1
        if level == len(taken):
            taken.append([])
        taken[level].append(Bracket(pair.first, pair.second, sign, colour, level))
    return [bracket for row in taken for bracket in row]


def _overlap(pair: Pair, other: Bracket) -> bool:
    return pair.first < other.second and other.first < pair.second


def _draw(axis: Axes, bracket: Bracket) -> None:
    height = 7.25 + _BRACKET_STEP * bracket.level
    left, right = bracket.first + 0.08, bracket.second - 0.08
    foot, middle = height - 0.12, (left + right) / 2.0
    axis.plot([left, left, right, right], [foot, height, height, foot], color=bracket.colour, linewidth=1)
    axis.text(middle, height - 0.1, bracket.sign, color=bracket.colour, ha="center", va="bottom", fontsize=10)


def _figure(rows: int, columns: int, width: float, height: float, is_simulated: bool) -> tuple[Figure, list[Any]]:
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    size = max(width, 5.0), height
    figure, axes = pyplot.subplots(rows, columns, figsize=size, layout="constrained", squeeze=False)
    if is_simulated:
        figure.suptitle(SIMULATED_WORDS, color="#b00020", fontsize=11, fontweight="bold")
        for axis in axes.flat:
            axis.text(
                0.5, 0.5, "simulated", transform=axis.transAxes, fontsize=30 if axes.size == 1 else 18, color="#b00020",
                alpha=0.18, ha="center", va="center", rotation=30, zorder=5,
            )  # fmt: skip
    return figure, list(axes.flat)


def _plain(name: str) -> str:
    """The text with dollar signs escaped, which matplotlib would read as formulas."""
    return name.replace("$", r"\$")


def _svg(figure: Figure) -> str:
    import matplotlib
    from matplotlib import pyplot

    text = io.StringIO()
    # Text is stored as text, so that the reader's browser supplies the glyphs of any script; matplotlib's own font has
    # few.
    with matplotlib.rc_context({"svg.hashsalt": "haptoflow", "svg.fonttype": "none"}), warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="Glyph .* missing from current font")
        figure.savefig(text, format="svg", metadata={"Date": None})
    pyplot.close(figure)
    return text.getvalue()
