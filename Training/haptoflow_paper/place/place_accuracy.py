"""Accuracy of whole renders on the reference recordings, for one engine and for two beside each other."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np

from haptoflow_benchmark.engine.engine_render import render_motion
from haptoflow_paper.metrics.cell_figures import measure_cell
from haptoflow_paper.metrics.judged_figures import JUDGED, spread
from haptoflow_paper.metrics.told_apart import told_apart_percent
from haptoflow_paper.reference.reference_set import ReferencePair
from haptoflow_paper.report.verdicts import verdict

_Cell = dict[str, Any]


def steady_pairs(pairs: Sequence[ReferencePair]) -> list[ReferencePair]:
    """All pairs but those that change the label under the tip, which a plane of one label cannot."""
    return [pair for pair in pairs if pair.condition.kind != "change"]


def measure_cells(
    engine: Path, model: Path, pairs: Sequence[ReferencePair], workers: int, advance: Callable[[], object]
) -> list[_Cell]:
    """The cells of every pair, rendered from end to end: contact model, voice, resampler."""

    def rendered(pair: ReferencePair) -> np.ndarray[Any, np.dtype[np.float32]]:
        with tempfile.TemporaryDirectory() as folder:
            render = render_motion(engine, pair.condition.label, pair.motion, Path(folder), model=model)
        advance()
        wave = render.waveform_mps2[: len(pair.recorded)].astype(np.float32)
        return np.pad(wave, (0, len(pair.recorded) - len(wave)))

    with ThreadPoolExecutor(workers) as pool:
        waves = list(pool.map(rendered, pairs))
    none = np.zeros(0, dtype=np.float32)
    cells = [
        measure_cell(pair, wave, none, np.zeros(0, dtype=np.int64)) for pair, wave in zip(pairs, waves, strict=True)
    ]
    for cell, percent in zip(cells, told_apart_percent(pairs, waves), strict=True):
        cell["told_apart_percent"] = percent
    return cells


def accuracy_report(now: Sequence[_Cell], before: Sequence[_Cell] | None) -> dict[str, Any]:
    """Spread of every judged figure of each engine, and the verdict between them: ahead, even or behind."""
    report: dict[str, Any] = {"now": _spreads(now)}
    if before is not None:
        report |= {"before": _spreads(before), "verdict": verdict(now, before)}
    return report


def _spreads(cells: Sequence[_Cell]) -> dict[str, Any]:
    return {figure.key: found for figure in JUDGED if (found := spread(cells, figure)) is not None}
