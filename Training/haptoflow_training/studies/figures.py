"""The figures of the two studies as SVG, drawn as in the paper. Figures of simulated studies are marked."""

from __future__ import annotations

import io
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy import stats

from haptoflow_training.studies.analysis import LatencyResult, SimilarityResult
from haptoflow_training.studies.plans import TURN_OFF, TURN_ON
from haptoflow_training.studies.log_table import participants_words
from haptoflow_training.studies.psychometric import Answers
from haptoflow_training.studies.rating_tests import SIGNIFICANCE, TREND, Pair

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
    """Percentage of yes with Wilson's intervals, every single answer, fitted curves dashed, thresholds with their
    intervals."""
    figure, (axis,) = _figure(1, 1, 7.6, 5.0, is_simulated)
    every = np.concatenate([result.single[condition].delay_ms for condition in _CONDITIONS])
    # Both conditions have points at the same levels. Each is drawn a little aside, or one would hide the other.
    aside_ms = 0.008 * float(np.ptp(every)) if len(every) else 0.0
    for place, (condition, (words, colour, marker)) in enumerate(_CONDITIONS.items()):
        points, fit = result.points[condition], result.fits[condition]
        shift_ms = aside_ms if place else -aside_ms
        if points:
            percent = np.array([point.percent for point in points])
            # Rounding may put an end of the interval beyond its point.
            below = np.maximum(0.0, percent - [point.low_percent for point in points])
            above = np.maximum(0.0, [point.high_percent for point in points] - percent)
            axis.errorbar(
                [point.delivered_ms + shift_ms for point in points], percent, [below, above],
                fmt=marker, color=colour, capsize=3, markersize=5,
                label=f"{words} (n = {result.answers[condition]} answers)",
            )  # fmt: skip
            _draw_answers(axis, result.single[condition], place, shift_ms, colour)
        if fit.curve is None:
            continue
        delays = [point.delivered_ms for point in points]
        drawn = np.linspace(min(delays), max(delays), 200)
        axis.plot(drawn, fit.curve.percent(drawn), "--", color=colour, label=f"{words}: {fit.curve.x0:.1f} ms")
        if fit.threshold_interval is not None:
            low, high = fit.threshold_interval.low, fit.threshold_interval.high
            height = 48.2 if place else 51.8
            axis.plot([low, high], [height, height], color=colour, alpha=0.45, linewidth=5, solid_capstyle="butt")
    axis.axhline(50.0, color="grey", linewidth=0.8)
    axis.set_ylim(-14.0, 114.0)
    axis.set_yticks(range(0, 101, 20))
    axis.set_title(f"{participants_words(result.participants)}; ticks above and below are single answers", fontsize=9)
    axis.set_xlabel("delay (ms)")
    axis.set_ylabel("delay perceived (%)")
    axis.grid(alpha=0.3)
    # Below the axis, where no answer and no interval lies.
    axis.legend(fontsize=8, loc="upper center", bbox_to_anchor=(0.5, -0.13), ncols=2, frameon=False)
    return _svg(figure)


def _draw_answers(axis: Axes, answers: Answers, place: int, shift_ms: float, colour: str) -> None:
    """A tick for each answer: yes above 100 %, no below 0 %, a row for each condition; ticks of equal delay lie beside
    each other by participant."""
    spread = 3.0 * abs(shift_ms) * ((answers.participant + 0.5) / max(1, answers.participants) - 0.5)
    for is_yes in (True, False):
        chosen = answers.yes.astype(bool) == is_yes
        height = (105.0 + 4.5 * place) if is_yes else (-5.0 - 4.5 * place)
        delays = answers.delay_ms[chosen] + shift_ms + spread[chosen]
        heights = np.full(len(delays), height)
        axis.plot(delays, heights, "|", color=colour, alpha=0.75, markersize=5, markeredgewidth=0.8)


def similarity_figure(result: SimilarityResult, *, is_simulated: bool) -> str:
    """A plot for each material: every rating, means with their intervals, brackets over pairs that differ or are
    equivalent."""
    count, methods = len(result.materials), len(result.methods)
    columns = min(_COLUMNS, count)
    rows = -(-count // columns)
    brackets = {name: brackets_of(result.by_material[name].pairs) for name in result.materials}
    levels = max((bracket.level + 1 for found in brackets.values() for bracket in found), default=0)
    top = 7.3 + _BRACKET_STEP * levels
    width, height = 1.4 + 0.65 * methods * columns, 0.9 + rows * (2.2 + 0.22 * levels)
    figure, axes = _figure(rows, columns, width, height, is_simulated)
    for axis in axes[count:]:
        axis.set_visible(False)
    for place, (material, axis) in enumerate(zip(result.materials, axes, strict=False)):
        ratings = result.ratings[place]
        means = ratings.mean(axis=0)
        errors = np.abs(mean_interval(ratings) - means)
        colours = [_METHOD_COLOURS[method % len(_METHOD_COLOURS)] for method in range(methods)]
        axis.bar(range(methods), means - 1.0, bottom=1.0, color=colours, alpha=0.35, width=0.8)
        _draw_ratings(axis, ratings, colours)
        axis.errorbar(range(methods), means, errors, fmt="_", color="#111111", capsize=3, markersize=9, zorder=4)
        for bracket in brackets[material]:
            _draw(axis, bracket)
        axis.set_title(f"{_plain(material)} (n = {len(ratings)})", fontsize=10)
        axis.set_ylim(0.7, top)
        axis.set_yticks(range(1, 8))
        axis.set_xticks(range(methods), [_plain(name) for name in result.methods], fontsize=7, rotation=30, ha="right")
        axis.grid(axis="y", alpha=0.3)
        axis.set_axisbelow(True)
        if place % columns == 0:
            axis.set_ylabel("similarity (1-7)")
    return _svg(figure)


def mean_interval(ratings: np.ndarray) -> np.ndarray:
    """Both ends (rows) of each column's interval of 95 % for its mean, by Student's t, within the scale of 1 to 7."""
    count = len(ratings)
    half = stats.t.ppf(0.975, count - 1) * np.std(ratings, axis=0, ddof=1) / np.sqrt(count)
    means = ratings.mean(axis=0)
    return np.clip(np.stack([means - half, means + half]), 1.0, 7.0)


def _draw_ratings(axis: Axes, ratings: np.ndarray, colours: Sequence[str]) -> None:
    """A dot for each rating; equal ones lie side by side, as wide as a bar for all participants."""
    step = min(0.09, 0.72 / len(ratings))
    for method, colour in enumerate(colours):
        for value in np.unique(ratings[:, method]):
            count = int(np.count_nonzero(ratings[:, method] == value))
            places = method + step * (np.arange(count) - 0.5 * (count - 1))
            axis.plot(places, np.full(count, value), "o", color=colour, markersize=2.2, markeredgewidth=0.0, zorder=3)


def brackets_of(pairs: Sequence[Pair]) -> list[Bracket]:
    """A dagger for p < 0.1, a star for p < 0.05 after correction, a green sign for equivalence; short brackets at
    the bottom."""
    wanted = []
    for pair in pairs:
        if pair.p_shaffer is not None and pair.p_shaffer < TREND:
            wanted.append((pair, "*" if pair.p_shaffer < SIGNIFICANCE else "†", "#222222"))
        if pair.p_holm < SIGNIFICANCE:
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
    from matplotlib.figure import Figure

    size = max(width, 5.0), height
    figure = Figure(figsize=size, layout="constrained")
    axes = figure.subplots(rows, columns, squeeze=False)
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

    text = io.StringIO()
    # Text is stored as text, so that the reader's browser supplies the glyphs of any script; matplotlib's own font has
    # few.
    with matplotlib.rc_context({"svg.hashsalt": "haptoflow", "svg.fonttype": "none"}), warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="Glyph .* missing from current font")
        figure.savefig(text, format="svg", metadata={"Date": None})
    return text.getvalue()
