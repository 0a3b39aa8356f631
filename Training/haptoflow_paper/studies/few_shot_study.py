"""The few-shot study: materials that the library learns from seconds of recording, beside rivals fitted to the same.

One file of cells for each material, so that an interrupted study can be resumed.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from haptoflow_benchmark.engine_render import render_motion
from haptoflow_paper.studies.unseen_materials import CLOSE, relative_error
from haptoflow_paper.studies.few_shot_cases import SECONDS, FewShotCase, FilteredSurface, make_case, make_filtered_case
from haptoflow_paper.studies.few_shot_report import condition_figures
from haptoflow_paper.studies.few_shot_rivals import LabelPrior, fit_autoregressive, fit_level, windows_of
from haptoflow_training.errors import InputError
from haptoflow_training.export.model_file import ModelFile, read_model_file
from haptoflow_training.export.learning import joined, learn_material
from haptoflow_training.recordings.native_recording import MaterialRecording
from haptoflow_training.recordings.synthetic.materials import Material
from haptoflow_training.training.found_wave_vectors import turned_vectors
from haptoflow_training.waveform import SAMPLE_RATE_HZ
from haptoflow_training.whole_file import write_whole

# The length of recording at which the other tiers are measured too.
MAIN_SECONDS = 10.0
# Learning ends by its budget of segments, so that the result does not depend on the machine's load.
_SECONDS_LIMIT = 3600.0
_LEVEL_WINDOW_SAMPLES, _LEVEL_HOP_SAMPLES = 200, 100


@dataclass(frozen=True)
class StudyPlan:
    """engine: the built command line. work: folder of cells. seconds: of the curve."""

    model: Path
    engine: Path
    work: Path
    seed: int
    seconds: tuple[float, ...] = SECONDS
    seconds_limit: float = _SECONDS_LIMIT


def cells_of(
    plan: StudyPlan, model: ModelFile, material: Material | FilteredSurface, advance: Callable[[], None]
) -> dict[str, Any]:
    """By row and seconds ("learn 10"), the figures of every condition; computed or read from the plan's folder."""
    path = plan.work / f"{material.label}.json"
    if path.exists():
        stored: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
        advance()
        return stored
    made = _measured(plan, model, case_of(plan, material))
    write_whole(path, json.dumps(made).encode("utf-8"))
    advance()
    return made


def case_of(plan: StudyPlan, material: Material | FilteredSurface) -> FewShotCase:
    """The case of a material, with recordings for the plan's longest length."""
    if isinstance(material, FilteredSurface):
        return make_filtered_case(material, plan.seed, max(plan.seconds))
    return make_case(material, plan.seed, max(plan.seconds))


def _measured(plan: StudyPlan, model: ModelFile, case: FewShotCase) -> dict[str, Any]:
    rows: dict[str, list[dict[str, float]]] = {}
    spent: dict[str, float] = {}
    notes: dict[str, Any] = {}
    ribs: dict[str, list[int]] = {}
    default = model.header["default_tier"]
    for seconds in plan.seconds:
        recordings = case.recordings(seconds)
        text, report = learn_material(
            plan.model, joined(recordings), case.material.label, seed=plan.seed, seconds_limit=plan.seconds_limit
        )
        spent[f"learn {seconds:g}"] = report["seconds"]
        material = plan.work / f"{case.material.label}-{seconds:g}.haptomaterial"
        write_whole(material, text.encode())
        turn = report["turn_degrees"]
        learnt_options = ("--material", str(material))
        rows[f"learn {seconds:g}"] = engine_figures(plan, case, turn, default, plan.model, learnt_options)
        ribs[f"{seconds:g}"] = list(rib_counts(case.material, report["wave_vectors"], turn))
        if seconds == MAIN_SECONDS:
            notes = {key: report[key] for key in ("start_label", "nearest_label", "wave_vectors")}
            notes["ribs_found"], notes["ribs_wrong"] = ribs[f"{seconds:g}"]
            for tier in model.header["tiers"]:
                if tier["name"] != default:
                    rows[f"{tier['name']} {seconds:g}"] = engine_figures(
                        plan, case, turn, tier["name"], plan.model, learnt_options
                    )
        level = fit_level(windows_of(recordings, _LEVEL_WINDOW_SAMPLES, _LEVEL_HOP_SAMPLES), LabelPrior.of(model))
        for bins in (1, 3):
            rival = fit_autoregressive(recordings, level, bins)
            rows[f"autoregressive-{bins} {seconds:g}"] = [
                condition_figures(condition, rival.render(condition.motion, number))
                for number, condition in enumerate(case.conditions)
            ]
    rows["other draw"] = [condition_figures(each, each.other_draw) for each in case.conditions]
    return {
        "material": case.material.label,
        "filtered": isinstance(case.material, FilteredSurface),
        "ruled": bool(case.material.rulings),
        "impacts": case.material.impact_strength > 0.0,
        "rows": rows,
        "core_seconds": {name: round(value, 2) for name, value in spent.items()},
        "notes": {"families": len(case.material.rulings), "ribs": ribs, **notes},
    }


def engine_figures(
    plan: StudyPlan, case: FewShotCase, turn_degrees: float, tier: str, model: Path, options: tuple[str, ...] = ()
) -> list[dict[str, float]]:
    """Figures of every condition, rendered by the engine with the surface turned like the material or label."""
    cells = []
    with tempfile.TemporaryDirectory() as folder:
        for number, condition in enumerate(case.conditions):
            motion = np.column_stack([turned_vectors(condition.motion[:, :2], turn_degrees), condition.motion[:, 2]])
            made = render_motion(
                plan.engine, case.material.label, motion, Path(folder), model=model, seed=plan.seed + number,
                options=(*options, "--quality", tier, "--quiet"),
            )  # fmt: skip
            cells.append(condition_figures(condition, made.waveform_mps2[: len(condition.recorded)]))
    return cells


def rib_counts(
    material: Material | FilteredSurface, found: Sequence[dict[str, float]], turn_degrees: float
) -> tuple[int, int]:
    """How many of the surface's families of ribs were found within 2 %, and how many of the found ones do not exist.
    found: in the material's frame."""
    numbers = np.array([[each["x_cycles_per_mm"], each["y_cycles_per_mm"]] for each in found]).reshape(-1, 2)
    vectors = turned_vectors(numbers, -turn_degrees)
    true = [np.array(vector) for vector in material.wave_vectors_per_mm]
    hits = sum(any(relative_error(vector, each) < CLOSE for vector in vectors) for each in true)
    return hits, sum(not any(relative_error(vector, each) < CLOSE for each in true) for vector in vectors)


ROW = "trained"
_PACKAGES = Path(__file__).resolve().parents[2]
_HEADER = "time_s,acceleration_mps2,velocity_x_mps,velocity_y_mps,force_newtons"


def with_trained(
    plan: StudyPlan, materials: Sequence[Any], cells: Sequence[dict[str, Any]], advance: Callable[[], object]
) -> list[dict[str, Any]]:
    """The cells of every material with the rows "trained 10" and so on, computed or read from the plan's folder. advance:
    called after each length of recording."""
    trained: list[dict[str, Any]] = [{} for _ in materials]
    cases: list[FewShotCase] = []
    for seconds in plan.seconds:
        path = plan.work / f"trained-{seconds:g}.json"
        if not path.exists():
            cases = cases or [case_of(plan, material) for material in materials]
            write_whole(path, json.dumps(_trained(plan, cases, seconds)).encode())
        stored = json.loads(path.read_text(encoding="utf-8"))
        for rows, material in zip(trained, materials, strict=True):
            rows[f"{ROW} {seconds:g}"] = stored[material.label]
        advance()
    return [{**each, "rows": {**each["rows"], **rows}} for each, rows in zip(cells, trained, strict=True)]


def _trained(plan: StudyPlan, cases: Sequence[FewShotCase], seconds: float) -> dict[str, list[dict[str, float]]]:
    """The cells of every material, by name."""
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        for case in cases:
            for number, recording in enumerate(case.recordings(seconds)):
                _write(folder / "recordings", f"ride-{number + 1}", case.material.label, recording)
        (folder / "labels.toml").write_text("".join(_label(case.material.label) for case in cases), encoding="utf-8")
        model = _train(folder, plan)
        header = read_model_file(model).header
        return {
            case.material.label: engine_figures(
                plan, case, header["provenance"]["turned_degrees"].get(case.material.label, 0.0), header["default_tier"], model
            )
            for case in cases
        }


def _train(folder: Path, plan: StudyPlan) -> Path:
    model = folder / "grown.haptoflow"
    words = ["--recordings", str(folder / "recordings"), "--labels", str(folder / "labels.toml")]
    words += ["--out", str(folder / "run"), "--export", str(model), "--from", str(plan.model), "--workers", "1"]
    # In a process of its own, because this package changes how configurations are read.
    done = subprocess.run(
        [sys.executable, "-m", "haptoflow_training", "train", *words],
        env={**os.environ, "PYTHONPATH": str(_PACKAGES)}, capture_output=True, text=True, check=False,
    )  # fmt: skip
    if done.returncode != 0:
        raise InputError(f"haptoflow-training train failed: {done.stderr.strip()[-2000:]}")
    return model


def _write(folder: Path, name: str, label: str, recording: MaterialRecording) -> None:
    folder.mkdir(exist_ok=True)
    count = len(recording.vibration_mps2)
    columns = [np.arange(count) / SAMPLE_RATE_HZ, recording.vibration_mps2, recording.motion]
    path = folder / f"{label}-{name}.csv"
    np.savetxt(path, np.column_stack(columns), fmt="%.7g", delimiter=",", header=_HEADER, comments="")
    path.with_suffix(".json").write_text(json.dumps({"label": label, "licence": "MIT"}), encoding="utf-8")


def _label(name: str) -> str:
    return f'[[label]]\nname = "{name}"\ncategory = "study"\nstiffness_newtons_per_metre = 500\nfriction_coefficient = 0.4\n'
