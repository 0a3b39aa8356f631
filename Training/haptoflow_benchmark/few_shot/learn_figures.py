"""Measures `haptoflow learn` on ten seconds of a material unknown to the model: fitted and rendered by the command
line, compared with reference recordings of other motions."""

from __future__ import annotations

import json
import math
import subprocess
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from haptoflow_benchmark.engine.engine_render import render_motion
from haptoflow_benchmark.few_shot.few_shot_cases import FewShotCase
from haptoflow_benchmark.few_shot.few_shot_figures import condition_figures
from haptoflow_benchmark.few_shot.few_shot_rivals import fit_autoregressive
from haptoflow_benchmark.few_shot.unseen import unseen_materials
from haptoflow_benchmark.few_shot.wave_vector_study import CLOSE, relative_error
from haptoflow_training.errors import InputError
from haptoflow_training.fewshot.label_prior import LabelPrior
from haptoflow_training.fewshot.level_law import fit_level
from haptoflow_training.fewshot.sound_fit import LEVEL_HOP_SAMPLES, LEVEL_WINDOW_SAMPLES
from haptoflow_training.fewshot.stroke_recording import Frame, StrokeRecording, windows_of
from haptoflow_training.models.file_model import FileModel
from haptoflow_training.recordings.material_recording import MaterialRecording
from haptoflow_training.recordings.synthetic import load_materials
from haptoflow_training.recordings.synthetic.materials import Material
from haptoflow_training.waveform import SAMPLE_RATE_HZ

SECONDS = 10.0
LEARNT, AUTOREGRESSIVE, OTHER_DRAW = "learn", "autoregressive", "other draw"
# Samples left out between two rides, so that the step from one to the next is not learnt.
_MISSING_SAMPLES = 20
_DRAWN_MATERIALS = 60


@dataclass(frozen=True)
class LearnFigures:
    """rows: figures of each condition, by row. found: how many of the surface's families of ribs were found within 2
    %; wrong: how many of the found ones do not exist."""

    material: str
    families: int
    found: int
    wrong: int
    core_seconds: float
    rows: dict[str, list[dict[str, float]]]


def chosen_materials(plain: int, ruled: int, seed: int) -> tuple[Material, ...]:
    """The first materials without ribs and the first with ribs."""
    drawn = unseen_materials(load_materials(), _DRAWN_MATERIALS, seed)
    without, across = ([each for each in drawn if bool(each.rulings) == known] for known in (False, True))
    return (*without[:plain], *across[:ruled])


def measured(engine: Path, model: FileModel, path: Path, case: FewShotCase, folder: Path, seed: int) -> LearnFigures:
    """path: of the model. folder: for intermediate files. InputError if the engine fails."""
    recordings = case.recordings(SECONDS)
    material, report = _learnt(engine, path, recordings, case.material.label, folder, seed)
    turn = Frame(math.radians(report["turn_degrees"]), np.zeros(4, dtype=np.float32))
    rows: dict[str, list[dict[str, float]]] = {LEARNT: [], AUTOREGRESSIVE: [], OTHER_DRAW: []}
    strokes = [StrokeRecording.of(each, Frame.of(())) for each in recordings]
    level = fit_level(windows_of(strokes, LEVEL_WINDOW_SAMPLES, LEVEL_HOP_SAMPLES), LabelPrior.of(model.file))
    rival = fit_autoregressive(strokes, level, 3)
    for number, condition in enumerate(case.conditions):
        made = render_motion(
            engine, case.material.label, turn.turned_motion(condition.motion), folder, model=path, seed=seed + number,
            options=("--material", str(material), "--quiet"),
        )  # fmt: skip
        rows[LEARNT].append(condition_figures(condition, made.waveform_mps2[: len(condition.recorded)], None))
        rows[AUTOREGRESSIVE].append(condition_figures(condition, rival.render(condition.motion, number), None))
        rows[OTHER_DRAW].append(condition_figures(condition, condition.other_draw, None))
    found, wrong = _families(case.material, report, turn.turn_radians)
    return LearnFigures(case.material.label, len(case.material.rulings), found, wrong, report["seconds"], rows)


def table(figures: Sequence[LearnFigures], *, ruled: bool) -> str:
    """Markdown: median, and in brackets the 90th percentile (of the GFC the 10th)."""
    chosen = [each for each in figures if bool(each.families) == ruled]
    kind = "ruled surfaces" if ruled else "surfaces without ribs"
    words = {
        LEARNT: f"{len(chosen)} {kind}: `haptoflow learn`",
        AUTOREGRESSIVE: "AR model of order 20 in three speed bins",
        OTHER_DRAW: "another draw of the surface",
    }
    lines = ["| from 10 s | level dB | GFC | LSD dB |", "|---|---|---|---|"]
    for row, said in words.items():
        cells = [cell for each in chosen for cell in each.rows[row]]
        level, gfc, distance = (np.array([cell[key] for cell in cells]) for key in ("level_error_db", "gfc", "lsd_db"))
        level = np.abs(level)
        lines.append(
            f"| {said} | {np.median(level):.2f} ({np.quantile(level, 0.9):.2f}) | {np.median(gfc):.3f} "
            f"({np.quantile(gfc, 0.1):.3f}) | {np.median(distance):.2f} ({np.quantile(distance, 0.9):.2f}) |"
        )
    return "\n".join(lines)


def _learnt(
    engine: Path, model: Path, recordings: Sequence[MaterialRecording], name: str, folder: Path, seed: int
) -> tuple[Path, dict[str, Any]]:
    recording, material, report = (folder / f"{name}.{end}" for end in ("csv", "haptomaterial", "report.json"))
    recording.write_text(_as_table(recordings), encoding="utf-8")
    recording.with_suffix(".json").write_text(json.dumps({"rate_hz": SAMPLE_RATE_HZ}), encoding="utf-8")
    command = [str(engine), "learn", str(recording), "-o", str(material), "--report", str(report), "--name", name]
    # The limit of seconds is set out of reach, so that the result does not depend on the machine's load.
    command += ["--model", str(model), "--seed", str(seed), "--seconds-limit", "3600", "--quiet"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    except OSError as error:
        raise InputError(f"{engine}: cannot be run ({error.strerror}); build it with `npm run build`") from error
    if done.returncode != 0:
        raise InputError(f"{engine} learn failed: {done.stderr.strip()}")
    return material, json.loads(report.read_text(encoding="utf-8"))


def _as_table(recordings: Sequence[MaterialRecording]) -> str:
    lines = ["acceleration_mps2,velocity_x_mps,velocity_y_mps,force_newtons"]
    for recording in recordings:
        if len(lines) > 1:
            lines += ["nan," + lines[-1].partition(",")[2]] * _MISSING_SAMPLES
        columns = zip(recording.vibration_mps2, recording.velocity_mps, recording.force_newtons, strict=True)
        lines += [f"{wave:.6g},{velocity[0]:.6g},{velocity[1]:.6g},{force:.5g}" for wave, velocity, force in columns]
    return "\n".join(lines) + "\n"


def _families(material: Material, report: dict[str, Any], turn_radians: float) -> tuple[int, int]:
    cosine, sine = math.cos(turn_radians), math.sin(turn_radians)
    vectors = [
        np.array([cosine * x - sine * y, sine * x + cosine * y])
        for x, y in ((each["x_cycles_per_mm"], each["y_cycles_per_mm"]) for each in report["wave_vectors"])
    ]
    true = [np.array(vector) for vector in material.wave_vectors_per_mm]
    found = sum(any(relative_error(vector, each) < CLOSE for vector in vectors) for each in true)
    return found, sum(not any(relative_error(vector, each) < CLOSE for each in true) for vector in vectors)
