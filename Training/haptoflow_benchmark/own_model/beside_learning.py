"""A trained model beside what `haptoflow learn` makes of the same recordings: whether the training was worth its time."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from haptoflow_benchmark.engine.engine_render import render_motion
from haptoflow_benchmark.own_model.own_accuracy import HeldOutPart, LabelAccuracy, RenderedPart
from haptoflow_training.fewshot.learning import MaterialWords, joined, learn_material
from haptoflow_training.recordings.material_recording import MaterialRecording
from haptoflow_training.training.found_wave_vectors import turned_vectors
from haptoflow_training.whole_file import write_whole


@dataclass(frozen=True)
class Verdict:
    """words: one line for a terminal. is_worse: the model is behind learning in at least two of level, GFC and LSD."""

    words: str
    is_worse: bool


def render_learnt(
    seen: Sequence[HeldOutPart], held_out: Sequence[HeldOutPart], turned_degrees: Mapping[str, float], *,
    base: Path, engine: Path, folder: Path, advance: Callable[[int], object],
) -> list[RenderedPart]:  # fmt: skip
    """Learns each label of the held-out parts from its seen ones, as materials of the model file `base`, and renders the
    held-out parts with them. turned_degrees: of the parts, by label; learning turns the recordings' own frame itself."""
    rendered = []
    for label in dict.fromkeys(part.label for part in held_out):
        back = -turned_degrees.get(label, 0.0)
        learnt = learn_material(
            base, joined([_recording(_turned(part, back)) for part in seen if part.label == label]), MaterialWords(label)
        )
        material = folder / "learnt.haptomaterial"
        write_whole(material, learnt.text.encode())
        for number, part in enumerate(each for each in held_out if each.label == label):
            moved = _turned(part, back + learnt.report["turn_degrees"])
            made = render_motion(
                engine, label, moved.motion, folder, model=base, seed=1 + number, options=("--material", str(material))
            )
            rendered.append(RenderedPart(part, made.waveform_mps2))
        advance(1)
    return rendered


def verdict(model: Sequence[LabelAccuracy], learnt: Sequence[LabelAccuracy]) -> Verdict:
    """model, learnt: the same labels."""
    ours, theirs = _figures(model), _figures(learnt)
    behind = sum(own > other for own, other in zip(ours, theirs, strict=True))
    words = "not worth using" if behind >= 2 else "worth using"
    shown = [f"level {level:.2f} dB, GFC {1.0 - gfc:.3f}, LSD {lsd:.2f} dB" for level, gfc, lsd in (ours, theirs)]
    return Verdict(f"{words}: {shown[0]}; `haptoflow learn` on the same recordings: {shown[1]}", behind >= 2)


def _figures(found: Sequence[LabelAccuracy]) -> tuple[float, float, float]:
    """Median over labels of the size of the level error, of what GFC lacks to 1, and of LSD: smaller is better."""
    return (
        float(np.median([np.median(np.abs(one.level_errors_db)) for one in found])),
        float(np.median([1.0 - one.gfc for one in found if one.gfc is not None] or [1.0])),
        float(np.median([one.lsd_db for one in found if one.lsd_db is not None] or [np.inf])),
    )


def _turned(part: HeldOutPart, degrees: float) -> HeldOutPart:
    return replace(part, motion=np.column_stack([turned_vectors(part.motion[:, :2], degrees), part.motion[:, 2]]))


def _recording(part: HeldOutPart) -> MaterialRecording:
    wave, velocity, force = (
        np.asarray(values, dtype=np.float32) for values in (part.recorded, part.motion[:, :2], part.motion[:, 2])
    )
    return MaterialRecording(part.name, part.label, wave, velocity, force, "", "")
