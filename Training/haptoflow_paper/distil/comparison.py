"""The distilled tiers beside their teacher, on strokes that neither training nor choice of labels saw."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from haptoflow_benchmark.engine.engine_library import default_engine
from haptoflow_paper.distil.motions import Stroke
from haptoflow_paper.distil.rendering import SETTLING_SAMPLES, Rendering, render_all
from haptoflow_paper.distil.teacher import Teacher
from haptoflow_paper.metrics.cell_figures import measure_cell
from haptoflow_paper.metrics.told_apart import told_apart_percent
from haptoflow_paper.reference.reference_conditions import Condition
from haptoflow_paper.reference.reference_set import ReferencePair
from haptoflow_paper.rows.engine_generator import EngineGenerator
from haptoflow_paper.rows.timing import TimedSource, time_sources
from haptoflow_training.closed_loop.render import UPDATE_RATE_HZ, run_closed_loop
from haptoflow_paper.distil.generated_files import generated_path
from haptoflow_training.recordings.generated_dataset import read_generated
from haptoflow_training.waveform import SAMPLE_RATE_HZ

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
        run = run_closed_loop(
            generator, generator.embeddings, motions, np.array(index[some]), generator.statistics,
            update_rate_hz=UPDATE_RATE_HZ, seed=31 + first,
        )  # fmt: skip
        waves += [wave[SETTLING_SAMPLES:] for wave in run.waves]
    return waves
