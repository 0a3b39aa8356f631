"""The distilled tiers beside their teacher, on strokes that neither training nor choice of labels saw."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from haptoflow_benchmark.engine_library import default_engine
from haptoflow_benchmark.waveform_metrics import power_spectrum
from haptoflow_paper.runs.distil_rendering import SETTLING_SAMPLES, Rendering, generated_path, render_all
from haptoflow_paper.runs.distil_teacher import Stroke, Teacher
from haptoflow_paper.report.cell_figures import measure_cell
from haptoflow_paper.report.told_apart import told_apart_percent
from haptoflow_paper.rows.reference_conditions import Condition
from haptoflow_paper.rows.reference_set import ReferencePair
from haptoflow_paper.rows.closed_loop import closed_loop
from haptoflow_paper.rows.engine_generator import EngineGenerator
from haptoflow_paper.rows.timing import TimedSource, time_sources
from haptoflow_training.training.closed_loop import UPDATE_RATE_HZ
from haptoflow_training.model_stamp import model_line, picture_metadata, table
from haptoflow_training.recordings.open_recordings import read_generated
from haptoflow_training.waveform import SAMPLE_RATE_HZ
from haptoflow_training.whole_file import write_json, write_text

# Of the teacher's two draws; the training's seed is another.
_SEEDS = (7001, 7002)
_BATCH = 24
_BLOCKS, _RUNS = 4, 25
AGAIN = "teacher, drawn again"
TEACHER = "teacher"

_Floats = NDArray[np.float32]
_Cell = dict[str, Any]


@dataclass(frozen=True)
class ComparedRow:
    """cells: figures of every stroke. hot_ms, paced_ms: {p50, p99} of one segment, None for what has no time of its
    own."""

    name: str
    cells: list[_Cell]
    hot_ms: dict[str, float] | None
    paced_ms: dict[str, float] | None

    def summary(self) -> dict[str, Any]:
        """Over strokes; told apart over labels."""
        level, lsd, gfc = (
            np.array([cell[key] for cell in self.cells]) for key in ("level_error_db", "lsd_db", "gfc_recording")
        )
        apart: dict[str, list[float]] = {}
        for cell in self.cells:
            if (percent := cell.get("told_apart_percent")) is not None:
                apart.setdefault(cell["label"], []).append(percent)
        by_label = [float(np.mean(values)) for values in apart.values()]
        return {
            "level_error_db": float(np.median(np.abs(level))),
            "level_error_p90_db": float(np.quantile(np.abs(level), 0.9)),
            "level_bias_db": float(np.median(level)),
            "lsd_db": float(np.median(lsd)),
            "lsd_p90_db": float(np.quantile(lsd, 0.9)),
            "gfc": float(np.median(gfc)),
            "gfc_p10": float(np.quantile(gfc, 0.1)),
            "told_apart_percent": float(np.mean(by_label)) if by_label else None,
            "told_apart_worst_percent": max(by_label, default=None),
            "hot_ms": self.hot_ms,
            "paced_ms": self.paced_ms,
        }


@dataclass(frozen=True)
class HeldOut:
    """pairs: two draws of the teacher for each stroke."""

    strokes: list[Stroke]
    pairs: list[ReferencePair]


def render_held_out(
    root: Path, teacher: Teacher, out: Path, count: int, update_rate_hz: float, workers: int, advance: Callable[[int], object]
) -> HeldOut:
    """Render `count` strokes of each label twice, into folders below `out`, where finished ones are found again."""
    waves = []
    for number, seed in enumerate(_SEEDS, 1):
        folder = out / f"draw-{number}"
        rendering = Rendering(teacher, count, update_rate_hz, seed, _SEEDS[0])
        render_all(root, rendering, folder, workers, advance)
        strokes = rendering.strokes()
        waves.append([read_generated(generated_path(folder, stroke.identity))[0] for stroke in strokes])
    pairs = [
        ReferencePair(_condition(teacher, stroke), one, other, stroke.motion[SETTLING_SAMPLES:])
        for stroke, one, other in zip(strokes, *waves, strict=True)
    ]
    return HeldOut(strokes, pairs)


def _condition(teacher: Teacher, stroke: Stroke) -> Condition:
    label, identity = stroke.identity.texture_id, stroke.identity
    kind = "constant" if stroke.kind == "pass" else "varying"
    return Condition(
        teacher.labels[label].name, label, kind, 1e-3 * identity.speed_mmps, 1e-3 * identity.force_millinewtons,
        float(identity.direction_degrees or 0), len(stroke.motion) / SAMPLE_RATE_HZ, identity.repeat,
    )  # fmt: skip


def compare(
    root: Path, teacher: Teacher, distilled: Path, tiers: Sequence[str], held_out: HeldOut, advance: Callable[[int], object]
) -> tuple[list[ComparedRow], dict[str, list[_Floats]]]:
    """The teacher's second draw, and every tier of the distilled file, all beside the teacher's first draw; with the waves
    of each row. advance: told of each finished row, and of each timed block."""
    engine = default_engine(root)
    again = [pair.independent for pair in held_out.pairs]
    waves = {AGAIN: again}
    generators = {name: EngineGenerator(engine, distilled, name, maximum_batch=_BATCH) for name in tiers}
    for name, generator in generators.items():
        waves[name] = _closed_loop(generator, teacher, held_out.strokes)
        advance(1)
    with teacher.open(engine, 1) as taught:
        timed = [TimedSource(TEACHER, taught), *(TimedSource(name, each) for name, each in generators.items())]
        hot, paced = (
            time_sources(timed, blocks=_BLOCKS, runs_per_block=_RUNS, period_seconds=period, seed=5, advance=advance)
            for period in (0.0, 1.0 / UPDATE_RATE_HZ)
        )
    for generator in generators.values():
        generator.close()
    rows = [ComparedRow(TEACHER, [], asdict(hot[TEACHER]), asdict(paced[TEACHER]))]
    for name, made in waves.items():
        times = (asdict(hot[name]), asdict(paced[name])) if name in hot else (None, None)
        rows.append(ComparedRow(name, _cells(held_out.pairs, made), *times))
    return rows, waves


def steps_of_comparison(tiers: int) -> int:
    """How many steps `compare` reports to `advance`, for a progress bar."""
    return tiers + 2 * _BLOCKS * (tiers + 1)


def _cells(pairs: Sequence[ReferencePair], waves: Sequence[_Floats]) -> list[_Cell]:
    apart = told_apart_percent(pairs, waves)
    none = np.zeros(0, dtype=np.float32)
    cells = [measure_cell(pair, wave, none, np.zeros(0, dtype=np.int64)) for pair, wave in zip(pairs, waves, strict=True)]
    return [{**cell, "told_apart_percent": percent} for cell, percent in zip(cells, apart, strict=True)]


def _closed_loop(generator: EngineGenerator, teacher: Teacher, strokes: Sequence[Stroke]) -> list[_Floats]:
    """As a stylus hears it: each segment knows the motion before it."""
    names = [entry["name"] for entry in generator.header["labels"]]
    index = [names.index(teacher.labels[stroke.identity.texture_id].name) for stroke in strokes]
    waves: list[_Floats] = []
    for first in range(0, len(strokes), _BATCH):
        some = slice(first, first + _BATCH)
        motions = np.stack([stroke.motion for stroke in strokes[some]])
        run = closed_loop(generator, motions, np.array(index[some]), update_rate_hz=UPDATE_RATE_HZ, seed=31 + first)
        waves += [wave[SETTLING_SAMPLES:] for wave in run.waves]
    return waves


PAGE, FIGURES, SPECTRA = "distil.md", "distil.json", "spectra.png"
_COLUMNS = 5
_WINDOW = 256
# What a distilled tier should reach: errors against its teacher, and how many times faster it is.
GOALS = {"level_error_db": 0.5, "lsd_db": 1.2, "gfc": 0.985, "told_apart_percent": 60.0, "times_faster": 20.0}


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
