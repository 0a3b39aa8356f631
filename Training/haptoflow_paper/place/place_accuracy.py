"""Accuracy of whole renders on the reference recordings, for one engine and for two beside each other."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from haptoflow_benchmark.engine.engine_render import FULL_SCALE_MPS2, read_wav, render_motion
from haptoflow_paper.metrics.cell_figures import measure_cell
from haptoflow_paper.metrics.judged_figures import JUDGED, spread
from haptoflow_paper.metrics.told_apart import told_apart_percent
from haptoflow_paper.reference.reference_set import ReferencePair
from haptoflow_paper.report.verdicts import verdict

_Cell = dict[str, Any]
_Floats = NDArray[np.float32]

_CONTINUOUS_SHARE = 0.98


def steady_pairs(pairs: Sequence[ReferencePair]) -> list[ReferencePair]:
    """All pairs but those that change the label under the tip, which a plane of one label cannot."""
    return [pair for pair in pairs if pair.condition.kind != "change"]


def measure_cells(
    engine: Path, model: Path, pairs: Sequence[ReferencePair], workers: int, advance: Callable[[], object]
) -> list[_Cell]:
    """The cells of every pair, rendered with contact model and voice."""

    def rendered(pair: ReferencePair) -> _Floats:
        wave = _rendered(engine, model, pair)
        advance()
        return wave

    with ThreadPoolExecutor(workers) as pool:
        waves = list(pool.map(rendered, pairs))
    none = np.zeros(0, dtype=np.float32)
    cells = [
        measure_cell(pair, wave, none, np.zeros(0, dtype=np.int64)) for pair, wave in zip(pairs, waves, strict=True)
    ]
    for cell, percent in zip(cells, told_apart_percent(pairs, waves), strict=True):
        cell["told_apart_percent"] = percent
    return cells


def _rendered(engine: Path, model: Path, pair: ReferencePair) -> _Floats:
    """The voice's own 2 kHz waveform, from the onset on; where the pen stops in between, the output brought back to
    2 kHz, whose highest 100 Hz depend on where its samples lie between the waveform's."""
    length = len(pair.recorded)
    with tempfile.TemporaryDirectory() as name:
        path = Path(name) / "waveform.wav"
        options = ("--waveform", str(path))
        render = render_motion(engine, pair.condition.label, pair.motion, Path(name), model=model, options=options)
        waveform = read_wav(path) * FULL_SCALE_MPS2
    has_pauses = len(waveform) < _CONTINUOUS_SHARE * length
    if has_pauses:
        wave = render.waveform_mps2[:length].astype(np.float32)
        return np.pad(wave, (0, length - len(wave)))
    return np.pad(waveform, (max(0, length - len(waveform)), 0))[-length:].astype(np.float32)


def accuracy_report(now: Sequence[_Cell], before: Sequence[_Cell] | None) -> dict[str, Any]:
    """Spread of every judged figure of each engine, and the verdict between them: ahead, even or behind."""
    report: dict[str, Any] = {"now": _spreads(now)}
    if before is not None:
        report |= {"before": _spreads(before), "verdict": verdict(now, before)}
    return report


def _spreads(cells: Sequence[_Cell]) -> dict[str, Any]:
    return {figure.key: found for figure in JUDGED if (found := spread(cells, figure)) is not None}
