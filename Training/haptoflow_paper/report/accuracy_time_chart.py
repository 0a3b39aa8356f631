"""The chart of accuracy over time: the cost and the error of each tier and its rivals."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from haptoflow_benchmark.waveform_metrics import power_spectrum
from haptoflow_paper.rows.reference_set import ReferencePair
from haptoflow_paper.rows.row_plan import ABLATION, AS_PUBLISHED, OURS, REFERENCE
from haptoflow_training.model_stamp import picture_metadata
from haptoflow_training.waveform import SAMPLE_RATE_HZ

_OURS = "HaptoFlow"
# Ablations and references are in the table only.
_NOT_DRAWN = (ABLATION, REFERENCE)
_OTHERS = ("other architectures", "#2f7d57")
_LEGEND = {
    "HaptoFlow": ("HaptoFlow", "#d1495b"),
    "plain flow matching": ("plain flow matching, 1 to 16 steps", "#4a73b5"),
    "other recipes": ("other few-step recipes: MeanFlow, reflow", "#8a5fb0"),
    "baselines": _OTHERS,
}
# The points that are named in the chart; the others can be found in the table.
_NAMED = {
    "draft": "draft",
    "standard": "standard",
    "sketch": "sketch",
    "plain-euler-1": "1 Euler step",
    "plain-euler-16": "16 Euler steps",
    "ar": "AR",
    "ar-ribs": "AR with ribs",
    "spsi": "SPSI",
    "transformer": "Transformer",
    "dstn": "DSTN",
}


@dataclass(frozen=True)
class Panel:
    """One plot of the chart: the figure `key` of each row over milliseconds. limits: ends of the linear axis, in `unit`."""

    key: str
    title: str
    unit: str
    limits: tuple[float, float]


@dataclass(frozen=True)
class ChartPoint:
    """value and the ends of its 95 % interval; name is empty for points that are not named."""

    row: str
    family: str
    block: str
    milliseconds: float
    value: float
    low: float
    high: float
    name: str


PANELS = (
    Panel("told_apart_percent", "Told apart from recordings, % (50 is chance)", "%", (40.0, 100.0)),
    Panel("lsd_db", "Log-spectral distance, dB (lower is better)", "dB", (0.0, 16.0)),
)


def panel_value(row: Mapping[str, Any], key: str) -> float | None:
    """A row's figure, or the median of its spread."""
    value = row.get(key)
    return value["median"] if isinstance(value, Mapping) else value


def chart_points(rows: Sequence[dict[str, Any]], key: str) -> list[ChartPoint]:
    """Every row that is drawn, timed and measured. Rows on every fourth recording are left out of the told-apart
    panel: a classifier fitted to fewer recordings is weaker. Our own row on a quarter is left out everywhere,
    because the row on all recordings is drawn."""
    points = []
    for row in rows:
        value = panel_value(row, key)
        is_comparable = not row.get("every_fourth") or (key != "told_apart_percent" and row["block"] != OURS)
        if _is_timed(row) and value is not None and is_comparable:
            low, high = row.get(f"{key}_interval", (value, value))
            name = _NAMED.get(row["name"], "")
            milliseconds = row["ms_per_segment"]["p50"]
            points.append(ChartPoint(row["name"], row["family"], row["block"], milliseconds, value, low, high, name))
    return points


def chart_lines(points: Sequence[ChartPoint]) -> list[list[ChartPoint]]:
    """One network and solver at increasing numbers of steps: points joined by a line."""
    grouped: dict[str, list[ChartPoint]] = {}
    for point in points:
        stem, _, steps = point.row.rpartition("-")
        if steps.isdigit():
            grouped.setdefault(stem, []).append(point)
    return [sorted(group, key=lambda point: point.milliseconds) for group in grouped.values() if len(group) > 1]


def draw_chart(table: dict[str, Any], path: Path) -> None:
    """One panel for the classifier, one for the spectrum, over milliseconds. Values beyond a panel are drawn at its
    edge and written out."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(1, 2, figsize=(12.0, 6.0))
    for axis, panel in zip(axes, PANELS, strict=True):
        draw_panel(axis, panel, table["rows"])
    handles = _legend_handles({row["family"] for row in table["rows"] if row["block"] not in _NOT_DRAWN})
    figure.legend(handles=handles, loc="lower center", ncols=3, frameon=False, fontsize=10)
    figure.tight_layout(rect=(0.0, 0.11, 1.0, 1.0))
    figure.savefig(path, dpi=110, metadata=picture_metadata(table["model_sha256"]))
    pyplot.close(figure)


def draw_panel(axis: Any, panel: Panel, rows: Sequence[dict[str, Any]]) -> None:
    """One figure of the rows over their milliseconds on matplotlib axes."""
    points = chart_points(rows, panel.key)
    axis.set_ylim(*panel.limits)
    axis.set_xscale("log")
    _set_times(axis, [row["ms_per_segment"]["p50"] for row in rows if _is_timed(row)] or [0.1, 10.0])
    axis.set_title(panel.title, fontsize=12)
    axis.set_ylabel(panel.unit)
    axis.grid(alpha=0.25)
    _draw_another_recording(axis, panel, rows)
    for line in chart_lines(points):
        axis.plot(
            [point.milliseconds for point in line], [point.value for point in line],
            color=_colour(line[0].family), linewidth=1.2, alpha=0.55, zorder=2,
        )  # fmt: skip
    for point in points:
        if panel.limits[0] <= point.value <= panel.limits[1]:
            _draw_point(axis, panel, point)
    beyond = [point for point in points if not panel.limits[0] <= point.value <= panel.limits[1]]
    for rank, point in enumerate(sorted(beyond, key=lambda entry: entry.milliseconds)):
        _draw_beyond(axis, panel, point, rank)
    for row in rows:
        if _is_timed(row) and panel_value(row, panel.key) is None:
            _draw_time_alone(axis, row)


def _is_timed(row: dict[str, Any]) -> bool:
    return row["ms_per_segment"] is not None and row["block"] not in _NOT_DRAWN


def _colour(family: str) -> str:
    return _LEGEND.get(family, _OTHERS)[1]


def _set_times(axis: Any, milliseconds: Sequence[float]) -> None:
    from matplotlib.ticker import LogLocator, NullFormatter, StrMethodFormatter

    # Room for the names.
    axis.set_xlim(min(milliseconds) / 1.7, max(milliseconds) * 1.8)
    axis.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axis.xaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
    axis.xaxis.set_minor_formatter(NullFormatter())
    axis.set_xlabel("milliseconds for a segment of 100 ms, one thread")


def _draw_another_recording(axis: Any, panel: Panel, rows: Sequence[dict[str, Any]]) -> None:
    another = next((row for row in rows if row["name"] == "independent-draw"), None)
    value = None if another is None else panel_value(another, panel.key)
    if value is None:
        return
    axis.axhline(value, color="#7a7a7a", linestyle="--", linewidth=1.0, zorder=1)
    axis.annotate(
        "another recording of the same material", (0.88, value), xycoords=("axes fraction", "data"),
        xytext=(0, 3.0), textcoords="offset points", ha="right", va="bottom", fontsize=9,
        color="#5a5a5a",
    )  # fmt: skip


def _draw_point(axis: Any, panel: Panel, point: ChartPoint) -> None:
    ours = point.block == OURS
    colour = _colour(point.family)
    axis.plot(
        point.milliseconds, point.value, marker="*" if ours else "o", markersize=14 if ours else 6,
        linestyle="none", color=colour, markerfacecolor="white" if point.block == AS_PUBLISHED else colour,
        zorder=4 if ours else 3,
    )  # fmt: skip
    axis.errorbar(
        point.milliseconds, point.value,
        yerr=[[max(0.0, point.value - point.low)], [max(0.0, point.high - point.value)]],
        fmt="none", ecolor="#333333", elinewidth=1.2, capsize=3.0, zorder=5,
    )  # fmt: skip
    if point.name:
        right, up, side = _name_place(panel, point)
        axis.annotate(
            point.name, (point.milliseconds, point.value), xytext=(right, up),
            textcoords="offset points", fontsize=10, fontweight="bold" if ours else "normal",
            ha=side, va="center", color=_colour(point.family), zorder=5,
        )  # fmt: skip


# Positions of names that would overlap, by panel and row: points right of the marker, points above it, and the
# horizontal alignment.
_NAME_PLACES = {
    ("told_apart_percent", "sketch"): (0.0, 24.0, "center"),
    ("told_apart_percent", "draft"): (2.0, -14.0, "right"),
    ("told_apart_percent", "standard"): (6.0, -9.0, "left"),
    ("told_apart_percent", "plain-euler-1"): (-8.0, 3.0, "right"),
    ("told_apart_percent", "transformer"): (14.0, -3.0, "left"),
    ("told_apart_percent", "dstn"): (14.0, -16.0, "left"),
    ("told_apart_percent", "ar"): (-8.0, 0.0, "right"),
    ("lsd_db", "draft"): (2.0, -14.0, "right"),
    ("lsd_db", "sketch"): (0.0, 16.0, "center"),
    ("lsd_db", "standard"): (12.0, 18.0, "left"),
    ("lsd_db", "plain-euler-1"): (-8.0, -3.0, "right"),
    ("lsd_db", "ar"): (-8.0, 4.0, "right"),
    ("lsd_db", "ar-ribs"): (-10.0, 30.0, "left"),
}


def _name_place(panel: Panel, point: ChartPoint) -> tuple[float, float, str]:
    return _NAME_PLACES.get((panel.key, point.row), (8.0, 7.0, "left"))


def _draw_beyond(axis: Any, panel: Panel, point: ChartPoint, rank: int) -> None:
    below = point.value < panel.limits[0]
    edge = panel.limits[0] if below else panel.limits[1]
    lift = (10 + 15 * rank) * (1 if below else -1)
    axis.plot(
        point.milliseconds, edge, marker="v" if below else "^", markersize=8, color=_colour(point.family),
        clip_on=False, zorder=5,
    )  # fmt: skip
    axis.annotate(
        f"{point.name or point.row}: {point.value:.0f} {panel.unit}", (point.milliseconds, edge), xytext=(8, lift),
        textcoords="offset points", va="center", fontsize=9, color=_colour(point.family),
    )  # fmt: skip


def _draw_time_alone(axis: Any, row: dict[str, Any]) -> None:
    milliseconds = row["ms_per_segment"]["p50"]
    axis.axvline(milliseconds, color="#555555", linestyle=":", linewidth=1.4)
    axis.annotate(
        f"the paper's sizes: {milliseconds:.0f} ms (time only)", (milliseconds, 0.5), xytext=(-5, 0), rotation=90,
        xycoords=("data", "axes fraction"), textcoords="offset points", ha="right", va="center", fontsize=9,
    )  # fmt: skip


def _legend_handles(families: set[str]) -> list[Any]:
    from matplotlib.lines import Line2D

    handles = [
        Line2D([], [], color=colour, marker="*" if family == _OURS else "o", markersize=13 if family == _OURS else 7,
               linestyle="-" if family == "plain flow matching" else "none", label=words)
        for family, (words, colour) in _LEGEND.items()
        if family in families
    ]  # fmt: skip
    for words, face in (("hollow: as published", "white"), ("filled: given the same", "#777777")):
        look = {"marker": "o", "markersize": 7, "markerfacecolor": face, "linestyle": "none"}
        handles.append(Line2D([], [], color="#777777", label=words, **look))
    bar = Line2D([], [], color="#333333", marker="|", markersize=12, markeredgewidth=1.4, linestyle="none",
                 label="bar: 95 % interval over recordings")  # fmt: skip
    edge = Line2D([], [], color="#333333", marker="v", markersize=7, linestyle="none", label="beyond the scale")
    return [*handles, bar, edge]


def draw_spectra(
    pairs: Sequence[ReferencePair], waves: Sequence[NDArray[np.float32]], path: Path, model_sha256: str
) -> None:
    """Mean power spectra of recordings and of the default tier's closed loop, one panel a label."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    labels = list(dict.fromkeys(pair.condition.label for pair in pairs))
    columns = 5
    count = -(-len(labels) // columns)
    figure, axes = pyplot.subplots(count, columns, figsize=(15.0, 2.5 * count), sharex=True, squeeze=False)
    frequency = np.fft.rfftfreq(256, 1.0 / SAMPLE_RATE_HZ)
    for axis, label in zip(axes.flat, labels, strict=False):
        rows = [index for index, pair in enumerate(pairs) if pair.condition.label == label]
        for name, colour, chosen in (
            ("recorded", "#3a3a3a", [pairs[index].recorded for index in rows]),
            ("generated", "#d1495b", [waves[index] for index in rows]),
        ):
            power = np.mean([power_spectrum(wave[400:], 256) for wave in chosen], axis=0)
            axis.plot(frequency[2:], 10.0 * np.log10(power[2:] + 1e-9), color=colour, linewidth=1.2, label=name)
        axis.set_title(label, fontsize=10)
        axis.grid(alpha=0.25)
    axes[0][0].legend(fontsize=8)
    for axis in axes[-1]:
        axis.set_xlabel("Hz")
    for row in axes:
        row[0].set_ylabel("dB")
    figure.tight_layout()
    figure.savefig(path, dpi=90, metadata=picture_metadata(model_sha256))
    pyplot.close(figure)
