"""The labels file of the generated recordings: the teacher's labels, with wave vectors where its output has ribs."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from pathlib import Path

from haptoflow_paper.distil.rendering import Rendering
from haptoflow_training.preprocessing.wave_vectors import WaveVector, estimate_wave_vectors
from haptoflow_paper.distil.generated_files import generated_path
from haptoflow_training.recordings.generated_dataset import read_generated
from haptoflow_training.recordings.material_recording import MaterialRecording
from haptoflow_training.whole_file import write_whole


def write_labels(rendering: Rendering, recordings: Path, out: Path, advance: Callable[[int], object]) -> None:
    """Wave vectors are stated, in the teacher's own axes: training would turn a label of which it has to find them, and a
    surface that is turned for the teacher should stay so. advance: told of each label."""
    entries = []
    for number, label in enumerate(rendering.teacher.labels):
        vectors = _wave_vectors(rendering, recordings, number)
        lines = [
            "[[label]]",
            f"name = {_quoted(label.name)}",
            f"category = {_quoted(label.category)}",
            f"textures = [{number}]",
            f"stiffness_newtons_per_metre = {float(label.stiffness_newtons_per_metre)!r}",
            f"friction_coefficient = {float(label.friction_coefficient)!r}",
            *(f"wavelength_metres = {1e-3 / math.hypot(*vector):.6g}" for vector in vectors[:1]),
            f"wave_vectors_per_mm = [{', '.join(f'[{x:.6f}, {y:.6f}]' for x, y in vectors)}]",
        ]
        entries.append("\n".join(lines))
        advance(1)
    heading = f"# Labels of {rendering.teacher.name}; a texture is a label's number in the names of the recordings."
    write_whole(out, ("\n\n".join([heading, *entries]) + "\n").encode())


def _wave_vectors(rendering: Rendering, recordings: Path, label: int) -> tuple[WaveVector, ...]:
    read = []
    for stroke in rendering.strokes_of_label(label):
        waveform, motion = read_generated(generated_path(recordings, stroke.identity))
        read.append(MaterialRecording(stroke.identity.name, "", waveform, motion[:, :2], motion[:, 2], "", ""))
    return estimate_wave_vectors(read)


def _quoted(text: str) -> str:
    """A TOML string: JSON's escapes are a part of TOML's."""
    return json.dumps(text, ensure_ascii=False)
