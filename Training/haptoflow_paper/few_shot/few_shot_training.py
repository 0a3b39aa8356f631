"""The study's materials as labels of one model: `haptoflow-training train` on the recordings of all of them."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from haptoflow_paper.few_shot.few_shot_cases import FewShotCase
from haptoflow_paper.few_shot.few_shot_study import StudyPlan, case_of, engine_figures
from haptoflow_training.errors import InputError
from haptoflow_training.export.model_file import read_model_file
from haptoflow_training.recordings.material_recording import MaterialRecording
from haptoflow_training.waveform import SAMPLE_RATE_HZ
from haptoflow_training.whole_file import write_whole

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
            for recording in case.recordings(seconds):
                _write(folder / "recordings", recording)
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


def _write(folder: Path, recording: MaterialRecording) -> None:
    folder.mkdir(exist_ok=True)
    count = len(recording.vibration_mps2)
    columns = [np.arange(count) / SAMPLE_RATE_HZ, recording.vibration_mps2, recording.velocity_mps, recording.force_newtons]
    path = folder / f"{recording.label}-{recording.name}.csv"
    np.savetxt(path, np.column_stack(columns), fmt="%.7g", delimiter=",", header=_HEADER, comments="")
    path.with_suffix(".json").write_text(json.dumps({"label": recording.label, "licence": "MIT"}), encoding="utf-8")


def _label(name: str) -> str:
    return f'[[label]]\nname = "{name}"\ncategory = "study"\nstiffness_newtons_per_metre = 500\nfriction_coefficient = 0.4\n'
