"""The few-shot study: materials fitted to seconds of recording, beside rivals fitted to the same.

One file of cells for each material, so that an interrupted study can be resumed.
"""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from haptoflow_benchmark.few_shot.few_shot_cases import SECONDS, FewShotCase, make_case
from haptoflow_benchmark.few_shot.few_shot_figures import condition_figures
from haptoflow_benchmark.few_shot.few_shot_rivals import fit_autoregressive
from haptoflow_training.export.material_file import Material, MaterialProvenance, write_material
from haptoflow_training.fewshot.embedding_fit import FitOptions
from haptoflow_training.fewshot.level_law import fit_level
from haptoflow_training.fewshot.material_fit import FittedMaterial, as_material, fit_material
from haptoflow_training.fewshot.sound_fit import LEVEL_HOP_SAMPLES, LEVEL_WINDOW_SAMPLES, calibrated, render_chunks
from haptoflow_training.fewshot.stroke_recording import Frame, windows_of
from haptoflow_training.fewshot.voice import Voice, render
from haptoflow_training.models.file_model import FileModel, FileTier
from haptoflow_training.recordings.synthetic.materials import Material as Surface
from haptoflow_training.whole_file import write_whole

# The length of recording at which the other tier, the trained network and the engine are measured too.
MAIN_SECONDS = 10.0
NETWORK_STEPS, NETWORK_LEARNING_RATE = 80, 5e-4
_RENDER_SEED = 23


@dataclass(frozen=True)
class StudyPlan:
    """work: folder of cells. seconds: of the curve."""

    model: Path
    work: Path
    seed: int
    seconds: tuple[float, ...] = SECONDS
    options: FitOptions = FitOptions()
    network_steps: int = NETWORK_STEPS


def cells_of(plan: StudyPlan, model: FileModel, material: Surface, advance: Callable[[], None]) -> dict[str, Any]:
    """By row and seconds ("fit 10"), the figures of every condition; computed or read from the plan's folder."""
    path = plan.work / f"{material.label}.json"
    if path.exists():
        stored: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
        advance()
        return stored
    made = _measured(plan, model, make_case(material, plan.seed, max(plan.seconds)))
    write_whole(path, json.dumps(made).encode("utf-8"))
    advance()
    return made


def _measured(plan: StudyPlan, model: FileModel, case: FewShotCase) -> dict[str, Any]:
    tier = model.tier()
    rows: dict[str, list[dict[str, float]]] = {}
    spent: dict[str, float] = {}
    notes: dict[str, Any] = {}
    voices: list[tuple[str, Voice, Frame]] = []
    for seconds in plan.seconds:
        recordings = case.recordings(seconds)
        begun = time.process_time()
        fitted = fit_material(model, recordings, seed=plan.seed, options=plan.options, compare_tiers=False)
        spent[f"fit {seconds:g}"] = time.process_time() - begun
        voices.append((f"fit {seconds:g}", fitted.voice, fitted.frame))
        voices.append((f"embedding {seconds:g}", fitted.plain, fitted.frame))
        voices.append((f"nearest {seconds:g}", nearest_voice(model, tier, fitted, plan.seed), fitted.frame))
        if seconds == MAIN_SECONDS:
            notes["nearest"] = model.labels[fitted.fit.nearest]["name"]
            notes["wave_numbers"] = [round(float(value), 4) for value in fitted.frame.wave_numbers]
            for entry in model.file.header["tiers"]:
                if entry["name"] != tier.name and entry["representation"] == "raw":
                    rows[f"{entry['name']} {seconds:g}"] = _figures_of_voices(
                        case, model.tier(entry["name"]), [fitted.voice], [fitted.frame]
                    )[0]
            write_material(plan.work / f"{case.material.label}.haptomaterial", _as_material(model, case, fitted))
            begun = time.process_time()
            moved, wrapped = _network_moved(plan, model, case, seconds)
            spent[f"network {seconds:g}"] = time.process_time() - begun
            rows[f"network {seconds:g}"] = _figures_of_voices(case, wrapped, [moved.voice], [moved.frame])[0]
        begun = time.process_time()
        level = fit_level(
            windows_of(fitted.recordings, LEVEL_WINDOW_SAMPLES, LEVEL_HOP_SAMPLES), fitted.prior
        )
        for bins in (1, 3):
            rival = fit_autoregressive(fitted.recordings, level, bins)
            rows[f"autoregressive-{bins} {seconds:g}"] = [
                condition_figures(condition, rival.render(fitted.frame.turned_motion(condition.motion), number), None)
                for number, condition in enumerate(case.conditions)
            ]
        spent[f"autoregressive {seconds:g}"] = time.process_time() - begun
    figures = _figures_of_voices(case, tier, [voice for _, voice, _ in voices], [frame for _, _, frame in voices])
    rows |= {name: cells for (name, _, _), cells in zip(voices, figures, strict=True)}
    rows["other draw"] = [condition_figures(each, each.other_draw, None) for each in case.conditions]
    return {
        "material": case.material.label,
        "ruled": bool(case.material.rulings),
        "impacts": case.material.impact_strength > 0.0,
        "rows": rows,
        "core_seconds": {name: round(value, 2) for name, value in spent.items()},
        "notes": notes,
    }


def _as_material(model: FileModel, case: FewShotCase, fitted: FittedMaterial) -> Material:
    provenance = MaterialProvenance("fitted by the few-shot study", "synthetic recorder", "MIT", fitted.seconds)
    return as_material(
        model, fitted, name=case.material.label, category=case.material.category, description="", provenance=provenance
    )


def nearest_voice(model: FileModel, tier: FileTier, fitted: FittedMaterial, seed: int) -> Voice:
    """The label that the fit began from, with the material's wave vectors and a level fitted as the material's."""
    embedding = np.concatenate([model.label_embeddings[fitted.fit.nearest, :-4].numpy(), fitted.frame.wave_numbers])
    level = fit_level(windows_of(fitted.recordings, LEVEL_WINDOW_SAMPLES, LEVEL_HOP_SAMPLES), fitted.prior)
    plain = Voice(embedding.astype(np.float32), level)
    rendered = render_chunks(tier, plain, fitted.rendered.chunks, seed)
    return Voice(plain.embedding, calibrated(rendered, fitted.recordings, level, fitted.prior, None))


def _network_moved(
    plan: StudyPlan, model: FileModel, case: FewShotCase, seconds: float
) -> tuple[FittedMaterial, FileTier]:
    """A fit of the embedding together with all weights of the network, then of level and tone as for the others."""
    tier = model.trainable_tier()
    options = FitOptions(steps=plan.network_steps)
    fitted = fit_material(
        model,
        case.recordings(seconds),
        seed=plan.seed,
        options=options,
        tier=tier,
        weights_learning_rate=NETWORK_LEARNING_RATE,
        compare_tiers=False,
    )
    return fitted, tier


def _figures_of_voices(
    case: FewShotCase, tier: FileTier, voices: list[Voice], frames: list[Frame]
) -> list[list[dict[str, float]]]:
    """Figures of every voice in every condition, rendered in one batch."""
    length = min(len(condition.motion) for condition in case.conditions)
    motions: list[NDArray[np.float32]] = [
        frame.turned_motion(condition.motion[:length]) for frame in frames for condition in case.conditions
    ]
    repeated = [voice for voice in voices for _ in case.conditions]
    run = render(tier, repeated, np.stack(motions), _RENDER_SEED)
    count = len(case.conditions)
    return [
        [
            condition_figures(condition, run.waves[index * count + place], run.hop_starts)
            for place, condition in enumerate(case.conditions)
        ]
        for index in range(len(voices))
    ]
