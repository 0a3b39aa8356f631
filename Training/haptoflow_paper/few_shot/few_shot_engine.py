"""The few-shot study's main row in the engine: its fitted material files, rendered by the command line."""

from __future__ import annotations

import json
import tempfile
from pathlib import Path

from haptoflow_benchmark.engine.engine_render import render_motion
from haptoflow_benchmark.few_shot.few_shot_cases import make_case
from haptoflow_benchmark.few_shot.few_shot_figures import condition_figures
from haptoflow_paper.few_shot.few_shot_study import MAIN_SECONDS, StudyPlan
from haptoflow_training.errors import InputError
from haptoflow_training.export.material_file import SUFFIX
from haptoflow_training.fewshot.material_fit import prepared
from haptoflow_training.recordings.synthetic.materials import Material
from haptoflow_training.whole_file import write_whole


def engine_cells(plan: StudyPlan, engine: Path, surface: Material) -> list[dict[str, float]]:
    """Figures of every condition, computed or read from the plan's folder; InputError if the study has not fitted
    the material yet, or the engine fails."""
    path = plan.work / f"{surface.label}.engine.json"
    if path.exists():
        stored: list[dict[str, float]] = json.loads(path.read_text(encoding="utf-8"))
        return stored
    material = plan.work / f"{surface.label}{SUFFIX}"
    if not material.exists():
        raise InputError(f"{material} does not exist: run the study for this material first")
    case = make_case(surface, plan.seed, MAIN_SECONDS)
    frame, _ = prepared(case.recordings(MAIN_SECONDS), None)
    cells = []
    with tempfile.TemporaryDirectory() as folder:
        for number, condition in enumerate(case.conditions):
            made = render_motion(
                engine,
                surface.label,
                frame.turned_motion(condition.motion),
                Path(folder),
                model=plan.model,
                seed=plan.seed + number,
                options=("--material", str(material), "--quiet"),
            )
            cells.append(condition_figures(condition, made.waveform_mps2[: len(condition.recorded)], None))
    write_whole(path, json.dumps(cells).encode("utf-8"))
    return cells
