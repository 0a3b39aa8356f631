"""Measures which acceleration should be full scale: the level of recorded strokes on every label, in the engine."""

from __future__ import annotations

import json
import math
import tempfile
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from haptoflow_benchmark.engine.engine_render import read_wav, run_engine, write_rows, write_scene
from haptoflow_benchmark.full_scale.recorded_strokes import evenly_on_table
from haptoflow_training.closed_loop.render import UPDATE_RATE_HZ
from haptoflow_training.errors import InputError
from haptoflow_training.markdown import table

# The limiter is linear up to this share of the full scale (SoftLimiter::knee).
KNEE = 0.7
# Less than one sample in a thousand may exceed the knee.
ALLOWED_SHARE = 0.001
# Of a hand that strokes or presses with a tool: the recordings' range (0.5 and 1 N) and what hands do beyond it.
FORCES_NEWTONS = (0.5, 1.0, 2.0, 3.0)
# Far above any texture, so that the limiter does not change the waveform.
_UNBENT_FULL_SCALE_MPS2 = 1000.0
_RATE_HZ = 48000
# Keeps the pen in contact despite some millimetres of tracking error and uneven tables.
_TIP_RADIUS_METRES = 0.005


@dataclass(frozen=True)
class StrokeLevel:
    """magnitudes_mps2: of all samples above 0, ascending, before the limiter."""

    label: str
    stroke: str
    force_newtons: float
    magnitudes_mps2: NDArray[np.float32]


def model_labels(engine: Path, model: Path) -> list[str]:
    """The labels of a model file, as the engine reads it."""
    described = json.loads(run_engine([str(engine), "inspect", str(model), "--json"]))
    return [label["name"] for label in described["header"]["labels"]]


def measure_levels(
    engine: Path,
    model: Path,
    strokes: Mapping[str, NDArray[np.float64]],
    labels: Sequence[str],
    forces_newtons: Sequence[float] = FORCES_NEWTONS,
    *,
    workers: int = 1,
    advance: Callable[[int], object] = lambda _: None,
) -> list[StrokeLevel]:
    """Render every stroke on a plane of every label with every force, constant over the stroke."""

    def measure(case: tuple[str, str, float]) -> StrokeLevel:
        label, stroke, force = case
        with tempfile.TemporaryDirectory() as folder:
            magnitudes = _render(engine, model, Path(folder), label, strokes[stroke], force)
        advance(1)
        return StrokeLevel(label, stroke, force, magnitudes)

    cases = [(label, stroke, force) for label in labels for stroke in strokes for force in forces_newtons]
    with ThreadPoolExecutor(max_workers=workers) as pool:
        return list(pool.map(measure, cases))


def _render(
    engine: Path, model: Path, folder: Path, label: str, stroke: NDArray[np.float64], force_newtons: float
) -> NDArray[np.float32]:
    scene, table, wav = (folder / name for name in ("scene.json", "stroke.csv", "out.wav"))
    write_scene(scene, label, UPDATE_RATE_HZ, _TIP_RADIUS_METRES)
    path = evenly_on_table(stroke)
    write_rows(table, np.c_[path, np.full(len(path), force_newtons)], digits=7)
    command = [str(engine), "render", str(scene), "--stroke", str(table), "-o", str(wav), "--model", str(model)]
    run_engine([*command, "--rate", str(_RATE_HZ), "--full-scale", str(_UNBENT_FULL_SCALE_MPS2), "--quiet"])
    magnitudes = np.abs(read_wav(wav))
    if magnitudes.max() > KNEE:
        raise InputError(f"label '{label}' passes {KNEE * _UNBENT_FULL_SCALE_MPS2:.0f} m/s^2: too loud to be measured")
    return np.sort(magnitudes[magnitudes > 0.0]) * np.float32(_UNBENT_FULL_SCALE_MPS2)


def share_in_knee(levels: Sequence[StrokeLevel], full_scale_mps2: float) -> float:
    """The share of samples above the knee."""
    knee_mps2 = KNEE * full_scale_mps2
    bent = sum(len(level.magnitudes_mps2) - _count_up_to(level, knee_mps2) for level in levels)
    return bent / max(1, sum(len(level.magnitudes_mps2) for level in levels))


def _count_up_to(level: StrokeLevel, mps2: float) -> int:
    return int(np.searchsorted(level.magnitudes_mps2, mps2, side="right"))


def smallest_full_scale(levels: Sequence[StrokeLevel]) -> float:
    """In m/s^2, the smallest multiple of 10 with less than the allowed share of samples above the knee."""
    everything = np.concatenate([level.magnitudes_mps2 for level in levels])
    full_scale = 10.0 * max(1, math.floor(float(np.quantile(everything, 1.0 - ALLOWED_SHARE)) / KNEE / 10.0))
    while share_in_knee(levels, full_scale) >= ALLOWED_SHARE:
        full_scale += 10.0
    return full_scale


def summarise(levels: Sequence[StrokeLevel], full_scales_mps2: Sequence[float]) -> dict[str, Any]:
    """Pooled over everything, by label and by force; shares of samples in the knee are fractions, levels m/s^2."""
    by_label = {label: [level for level in levels if level.label == label] for label in _distinct(levels, "label")}
    forces = _distinct(levels, "force_newtons")
    return {
        "renders": len(levels),
        "strokes": len(_distinct(levels, "stroke")),
        "forces_newtons": forces,
        "knee": KNEE,
        "allowed_share": ALLOWED_SHARE,
        "smallest_full_scale_mps2": smallest_full_scale(levels),
        "smallest_full_scale_of_loudest_label_mps2": max(smallest_full_scale(own) for own in by_label.values()),
        "full_scales": [_at(levels, by_label, full_scale) for full_scale in full_scales_mps2],
        "labels": [
            {"label": label, **_level_figures(own), "smallest_full_scale_mps2": smallest_full_scale(own)}
            for label, own in by_label.items()
        ],
        "forces": [
            {"force_newtons": force, **_level_figures([level for level in levels if level.force_newtons == force])}
            for force in forces
        ],
    }


def full_scale_table(report: Mapping[str, Any]) -> str:
    """A Markdown table: the share of samples above the knee at each full scale."""
    rows = []
    for entry in report["full_scales"]:
        label, share = max(entry["share_in_knee_by_label"].items(), key=lambda item: item[1])
        rows.append([f"{entry['full_scale_mps2']:.0f}", f"{entry['share_in_knee']:.3%}", f"{share:.2%} ({label})"])
    return table(("full scale, m/s^2", "samples in the knee, all labels", "of the loudest label"), rows)


def _distinct(levels: Sequence[StrokeLevel], field: str) -> list[Any]:
    return list(dict.fromkeys(getattr(level, field) for level in levels))


def _at(levels: Sequence[StrokeLevel], by_label: Mapping[str, list[StrokeLevel]], full_scale: float) -> dict[str, Any]:
    shares = [share_in_knee([level], full_scale) for level in levels]
    return {
        "full_scale_mps2": full_scale,
        "share_in_knee": share_in_knee(levels, full_scale),
        "share_in_knee_by_label": {label: share_in_knee(own, full_scale) for label, own in by_label.items()},
        "renders_with_a_sample_in_knee": sum(share > 0.0 for share in shares),
        "largest_share_of_a_render": max(shares),
    }


def _level_figures(levels: Sequence[StrokeLevel]) -> dict[str, float]:
    everything = np.concatenate([level.magnitudes_mps2 for level in levels]).astype(np.float64)
    p50, p99, p999 = (float(value) for value in np.quantile(everything, [0.5, 0.99, 0.999]))
    return {
        "rms_mps2": float(np.sqrt(np.mean(np.square(everything)))),
        "p50_mps2": p50,
        "p99_mps2": p99,
        "p99_9_mps2": p999,
        "peak_mps2": float(everything.max()),
    }
