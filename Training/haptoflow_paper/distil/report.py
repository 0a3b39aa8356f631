"""The table of a distillation, its pictures, and the JSON file with every figure."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from haptoflow_benchmark.metrics.waveform_metrics import power_spectrum
from haptoflow_paper.distil.comparison import AGAIN, TEACHER, ComparedRow, HeldOut
from haptoflow_paper.distil.teacher import Teacher
from haptoflow_training.markdown import table
from haptoflow_training.model_stamp import model_line, picture_metadata
from haptoflow_training.training.run_log import write_json, write_text
from haptoflow_training.waveform import SAMPLE_RATE_HZ

PAGE, FIGURES, SPECTRA = "distil.md", "distil.json", "spectra.png"
_COLUMNS = 5
_WINDOW = 256
# What a distilled tier should reach: errors against its teacher, and how many times faster it is.
GOALS = {"level_error_db": 0.5, "lsd_db": 1.2, "gfc": 0.985, "told_apart_percent": 60.0, "times_faster": 20.0}

_Floats = NDArray[np.float32]


def write_report(
    out: Path, teacher: Teacher, rows: Sequence[ComparedRow], about: dict[str, Any], model_sha256: str
) -> str:
    """Write page and figures; returns the table."""
    summaries = {row.name: row.summary() if row.cells else _times_of(row) for row in rows}
    teacher_ms = summaries[TEACHER]["hot_ms"]["p50"]
    for summary in summaries.values():
        if summary["hot_ms"]:
            summary["times_faster"] = teacher_ms / summary["hot_ms"]["p50"]
    words = _table(summaries)
    figures = {
        "model_sha256": model_sha256, **about, "teacher": teacher.origin, "goals": GOALS, "rows": summaries,
        "cells": {row.name: row.cells for row in rows},
    }  # fmt: skip
    write_json(out / FIGURES, figures)
    page = [
        f"# {teacher.name}, distilled",
        model_line(model_sha256),
        f"{about['strokes']} held-out strokes of {about['labels']} labels, {about['seconds']:.0f} s in all, beside the teacher "
        f"({teacher.solved_words}) on the same strokes. Machine: {about['machine']}.",
        words,
        f"`{AGAIN}` is the same model with other noise: what nobody can improve on.",
        f"![Spectra of the teacher and of the distilled file by label]({SPECTRA})",
    ]  # fmt: skip
    write_text(out / PAGE, "\n\n".join(page) + "\n")
    return words


def _times_of(row: ComparedRow) -> dict[str, Any]:
    return {"hot_ms": row.hot_ms, "paced_ms": row.paced_ms}


def _table(summaries: dict[str, dict[str, Any]]) -> str:
    headings = (
        "", "level, dB", "p90", "LSD, dB", "p90", "GFC", "p10", "told apart, %", "ms hot", "ms at 72 Hz", "times faster"
    )  # fmt: skip
    return table(headings, [_cells_of(name, summary) for name, summary in summaries.items()])


def _cells_of(name: str, summary: dict[str, Any]) -> list[str]:
    keys = ("level_error_db", "level_error_p90_db", "lsd_db", "lsd_p90_db", "gfc", "gfc_p10", "told_apart_percent")
    digits = (2, 2, 2, 2, 3, 3, 0)
    figures = [_shown(summary.get(key), count) for key, count in zip(keys, digits, strict=True)]
    times = [f"{summary[key]['p50']:.3g}" if summary.get(key) else "-" for key in ("hot_ms", "paced_ms")]
    return [name, *figures, *times, _shown(summary.get("times_faster"), 1)]


def _shown(value: float | None, digits: int) -> str:
    return "-" if value is None else f"{value:.{digits}f}"


def draw_spectra(
    path: Path, teacher: Teacher, held_out: HeldOut, waves: dict[str, list[_Floats]], model_sha256: str, most: int = 20
) -> None:
    """Mean spectra of all held-out strokes of a label: the teacher's and every tier's. At most so many labels, spread over
    all."""
    from matplotlib.figure import Figure

    labels = np.unique(np.linspace(0, len(teacher.labels) - 1, min(most, len(teacher.labels))).round().astype(int))
    columns = min(_COLUMNS, len(labels))
    rows = -(-len(labels) // columns)
    figure = Figure(figsize=(3.1 * columns, 2.4 * rows + 0.6))
    axes = figure.subplots(rows, columns, squeeze=False, sharex=True)
    owner = np.array([pair.condition.label_index for pair in held_out.pairs])
    shown = {TEACHER: [pair.recorded for pair in held_out.pairs], **{key: waves[key] for key in waves if key != AGAIN}}
    frequency = np.fft.rfftfreq(_WINDOW, 1.0 / SAMPLE_RATE_HZ)
    for axis, label in zip(axes.flat, labels, strict=False):
        for name, made in shown.items():
            power = np.mean([power_spectrum(made[place], _WINDOW) for place in np.flatnonzero(owner == label)], axis=0)
            style = {"color": "0.2", "linewidth": 2.2} if name == TEACHER else {"linewidth": 1.0}
            axis.semilogx(frequency[2:], 10.0 * np.log10(power[2:] + 1e-12), label=name, **style)
        axis.set_title(teacher.labels[label].name, fontsize=9)
        axis.grid(alpha=0.25)
    for axis in list(axes.flat)[len(labels) :]:
        axis.set_axis_off()
    axes.flat[0].legend(fontsize=7)
    figure.supxlabel("Hz", fontsize=9)
    figure.supylabel("dB", fontsize=9)
    figure.tight_layout()
    figure.savefig(path, dpi=90, metadata=picture_metadata(model_sha256))
