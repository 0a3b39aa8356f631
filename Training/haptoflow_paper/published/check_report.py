"""The report as one page in Markdown beside its pictures, and as one JSON file to send."""

from __future__ import annotations

import platform
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
import torch

from haptoflow_benchmark.engine_library import EngineLibrary
from haptoflow_paper.published.check_lines import FAIL, NOT_APPLICABLE, PASS, Line
from haptoflow_paper.published.check_points import BUDGET_MS, Measured
from haptoflow_paper.published.check_signals import LabelWaves
from haptoflow_paper.report.accuracy_time import machine_words
from haptoflow_training.model_stamp import model_line, picture_metadata, table
from haptoflow_training.training.run_log import source_commit
from haptoflow_training.waveform import SAMPLE_RATE_HZ
from haptoflow_training.whole_file import write_json, write_text

PAGE, FIGURES, CHART, SPECTRA = "check.md", "check.json", "chart.png", "spectra.png"


def environment(engine: EngineLibrary, root: Path) -> dict[str, Any]:
    """Versions and machine; nothing of the user: no name, no path, no host."""
    return {
        "machine": machine_words(),
        "versions": {
            "haptoflow": engine.version(), "commit": source_commit(root), "python": platform.python_version(),
            "torch": torch.__version__, "numpy": np.__version__,
        },
    }  # fmt: skip


def write_report(
    out: Path,
    lines: Sequence[Line],
    found: Sequence[Measured],
    header: dict[str, Any],
    model_sha256: str,
    about: dict[str, Any],
) -> None:
    """check.md and check.json in `out`; the pictures lie there already."""
    points = [
        {
            "name": each.point.name, "steps": each.point.steps, "family": each.point.family,
            "is_tier": each.point.is_tier, "hot_ms": asdict(each.hot), "paced_ms": asdict(each.paced),
            "difference": each.difference, "lsd_db": each.lsd_db,
        }
        for each in found
    ]  # fmt: skip
    write_json(
        out / FIGURES,
        {
            "model_sha256": model_sha256, **about, "provenance": header["provenance"],
            "lines": [line.to_json() for line in lines], "points": points,
        },
    )  # fmt: skip
    write_text(out / PAGE, _page(lines, points, header, model_sha256, about))


def summary(lines: Sequence[Line]) -> str:
    counted = {verdict: sum(line.verdict == verdict for line in lines) for verdict in (PASS, FAIL, NOT_APPLICABLE)}
    return f"{counted[PASS]} lines pass, {counted[FAIL]} fail, {counted[NOT_APPLICABLE]} do not apply"


def _page(
    lines: Sequence[Line], points: list[dict[str, Any]], header: dict[str, Any], model_sha256: str, about: dict[str, Any]
) -> str:
    versions = ", ".join(f"{name} {value}" for name, value in about["versions"].items() if value)
    parts = [
        f"# Check of {header['name']}",
        model_line(model_sha256),
        f"{summary(lines)}. Reference of the parity: {about['parity_reference'] or 'none'}. "
        f"Machine: {about['machine']}. "
        f"Versions: {versions}. {header['provenance']['statement']}.",
        f"To report something, send `{FIGURES}`: it holds every figure of this page and nothing of you.",
        "## Lines",
        table(
            ("part", "line", "verdict", "measured", "expected", "if it fails or does not apply"),
            [_cells(line) for line in lines],
        ),
        "## Milliseconds against distance from the best tier",
        f"![Distance from the best tier over milliseconds]({CHART})",
        table(
            ("point", "steps", "hot ms", "paced ms", "paced p99", "difference / level", "LSD dB"),
            [
                (
                    each["name"], str(each["steps"] or "-"), f"{each['hot_ms']['p50']:.3g}",
                    f"{each['paced_ms']['p50']:.3g}", f"{each['paced_ms']['p99']:.3g}", f"{each['difference']:.3g}",
                    f"{each['lsd_db']:.2f}",
                )
                for each in points
            ],
        ),
        "## Spectra by category",
        f"![Spectra of all labels by category]({SPECTRA})",
    ]  # fmt: skip
    return "\n\n".join(parts) + "\n"


def _cells(line: Line) -> list[str]:
    """Without what ends a cell."""
    words = (line.part, line.name, line.verdict, line.measured, line.expected, line.remedy)
    return [word.replace("|", "/").replace("\n", " ") for word in words]


_COLUMNS = 3


def draw_chart(found: list[Measured], path: Path, model_sha256: str) -> None:
    """Distance from the best tier over milliseconds at the live pace; the best one is at 0 and only marks its time."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(11.0, 4.4))
    best = found[-1]
    panels = (("difference", "RMS of the difference / level"), ("lsd_db", "log-spectral distance, dB"))
    for axis, (key, title) in zip(figure.subplots(1, 2), panels, strict=True):
        for family in dict.fromkeys(each.point.family for each in found):
            rows = sorted((each for each in found if each.point.family == family), key=lambda each: each.point.steps)
            times = [each.paced.p50 for each in rows]
            axis.plot(times, [getattr(each, key) for each in rows], marker="o", label=family)
            for each in rows:
                words = str(each.point.steps) if each.point.steps else each.point.name
                place = (each.paced.p50, getattr(each, key))
                axis.annotate(words, place, xytext=(4, 4), textcoords="offset points", fontsize=8)
        axis.axvline(BUDGET_MS, color="0.6", linestyle=":", label=f"budget of auto, {BUDGET_MS:.2g} ms")
        axis.set_xlim(left=0.0)
        axis.set_xlabel("ms a segment, one core, paced at 72 Hz, median")
        axis.set_title(f"{title}, from {best.point.name}", fontsize=10)
        axis.grid(alpha=0.25)
        axis.legend(fontsize=8)
    figure.tight_layout()
    figure.savefig(path, dpi=100, metadata=picture_metadata(model_sha256))


def draw_spectra(found: LabelWaves, path: Path, model_sha256: str) -> None:
    """Every label's mean spectrum at 40 mm/s and .75 N, a panel a category, with their median."""
    from matplotlib.figure import Figure

    categories = list(dict.fromkeys(sorted(found.categories)))
    rows = -(-len(categories) // _COLUMNS)
    figure = Figure(figsize=(4.0 * _COLUMNS, 2.7 * rows))
    axes = figure.subplots(rows, _COLUMNS, squeeze=False, sharex=True, sharey=True)
    frequency = np.fft.rfftfreq(256, 1.0 / SAMPLE_RATE_HZ)
    for axis, category in zip(axes.flat, categories, strict=False):
        places = [place for place, own in enumerate(found.categories) if own == category]
        decibels = 10.0 * np.log10(np.array([found.spectrum(place) for place in places]) + 1e-9)
        axis.semilogx(frequency[2:], decibels[:, 2:].T, color="0.7", linewidth=0.8)
        axis.semilogx(frequency[2:], np.median(decibels, axis=0)[2:], color="#d1495b", linewidth=1.6)
        axis.set_title(f"{category}: {len(places)}", fontsize=10)
        axis.grid(alpha=0.25)
    for axis in list(axes.flat)[len(categories) :]:
        axis.set_axis_off()
    figure.supxlabel("Hz", fontsize=9)
    figure.supylabel("dB", fontsize=9)
    figure.tight_layout()
    figure.savefig(path, dpi=100, metadata=picture_metadata(model_sha256))
