"""Renders strokes with the teacher in closed loop, several processes at a time, into a folder of generated recordings."""

from __future__ import annotations

import dataclasses
import functools
import json
import math
import os
import time
from collections.abc import Callable, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from haptoflow_benchmark.engine_library import default_engine
from haptoflow_paper.runs.distil_teacher import STROKE_SECONDS, Stroke, Teacher, strokes_of
from haptoflow_paper.rows.closed_loop import closed_loop
from haptoflow_paper.rows.engine_generator import EngineGenerator
from haptoflow_training.training.closed_loop import hop_positions
from haptoflow_training.errors import InputError
from haptoflow_training.export.model_file import read_model_file, write_model_file
from haptoflow_training.recordings.native_recording import WaveVector, estimate_wave_vectors
from haptoflow_training.recordings.open_recordings import GENERATED_FILE, GeneratedOrigin, origin_of, read_generated
from haptoflow_training.recordings.native_recording import MaterialRecording
from haptoflow_training.recordings.recording import RecordingIdentity
from haptoflow_training.stopping import end_if_stopped
from haptoflow_training.waveform import SAMPLE_RATE_HZ, SEGMENT_SAMPLES
from haptoflow_training.whole_file import write_whole

_Floats = NDArray[np.float32]


def start_generated(root: Path, origin: GeneratedOrigin) -> None:
    """Create the folder, or go on with one of the same origin; InputError if it holds recordings of another."""
    document = {"source": origin.source, "licence": origin.licence, "labels": list(origin.labels)}
    if (root / GENERATED_FILE).is_file() and origin_of(root) != origin:
        raise InputError(f"{root}: holds recordings of another origin; remove the folder or choose another")
    root.mkdir(parents=True, exist_ok=True)
    (root / GENERATED_FILE).write_text(json.dumps(document, indent=2, ensure_ascii=False) + "\n", encoding="utf-8")


def generated_path(root: Path, identity: RecordingIdentity) -> Path:
    return root / f"{identity.name}.npz"


def write_generated(path: Path, waveform_mps2: _Floats, motion: _Floats) -> None:
    """Write waveform [n] and motion [n, 3] (vx, vy in m/s, force in N), both at 2 kHz; the file appears whole or not at
    all."""
    unfinished = path.with_name(f".{os.getpid()}.{path.name}")
    try:
        np.savez(unfinished, waveform_mps2=waveform_mps2.astype(np.float32), motion=motion.astype(np.float32))
        unfinished.replace(path)
    finally:
        unfinished.unlink(missing_ok=True)


# The closed loop begins in silence, which is no part of the material.
SETTLING_SAMPLES = 2 * SEGMENT_SAMPLES
_BATCH = 24
_TRIED_SECONDS = 0.5


@dataclass(frozen=True)
class Rendering:
    """What is rendered: strokes_per_label of STROKE_SECONDS each, at update_rate_hz segments a second. seed: of strokes
    and noise; strokes_seed: of the strokes alone, for several draws of the same ones."""

    teacher: Teacher
    strokes_per_label: int
    update_rate_hz: float
    seed: int
    strokes_seed: int | None = None

    @property
    def origin(self) -> GeneratedOrigin:
        labels = tuple(label.name for label in self.teacher.labels)
        return GeneratedOrigin(self.teacher.origin, self.teacher.licence, labels)

    def strokes(self) -> list[Stroke]:
        """All of them, label by label."""
        return [stroke for label in range(len(self.teacher.labels)) for stroke in self.strokes_of_label(label)]

    def strokes_of_label(self, label: int) -> list[Stroke]:
        seed = self.seed if self.strokes_seed is None else self.strokes_seed
        return list(strokes_of(label, self.strokes_per_label, self.teacher.within, seed))


def rendered(
    generator: EngineGenerator, teacher: Teacher, strokes: Sequence[Stroke], update_rate_hz: float, seed: int
) -> list[_Floats]:
    """The waves of strokes in m/s^2, without the first 0.2 s of each. Each segment knows the motion that it plays, because
    nobody waits for it: a recording's motion and vibration belong together."""
    index = np.array([teacher.labels[stroke.identity.texture_id].index for stroke in strokes])
    longest = max(len(stroke.motion) for stroke in strokes)
    ahead = round(SAMPLE_RATE_HZ / update_rate_hz)
    motions = np.stack(
        [np.pad(stroke.motion[ahead:], ((0, ahead + longest - len(stroke.motion)), (0, 0)), mode="edge") for stroke in strokes]
    )
    run = closed_loop(generator, motions, index, update_rate_hz=update_rate_hz, seed=seed)
    return [wave[SETTLING_SAMPLES : len(stroke.motion)] for wave, stroke in zip(run.waves, strokes, strict=True)]


def seconds_of_a_stroke(root: Path, teacher: Teacher, update_rate_hz: float) -> float:
    """How long one process takes for one stroke, from a short one of each label in a batch."""
    length = round(_TRIED_SECONDS * SAMPLE_RATE_HZ)
    strokes = [next(strokes_of(place % len(teacher.labels), 1, teacher.within, place)) for place in range(_BATCH)]
    few = [dataclasses.replace(stroke, motion=stroke.motion[-length:]) for stroke in strokes]
    with teacher.open(default_engine(root), _BATCH) as generator:
        rendered(generator, teacher, few[:1], update_rate_hz, 0)
        begun = time.monotonic()
        rendered(generator, teacher, few, update_rate_hz, 0)
        seconds = time.monotonic() - begun
    hops = len(hop_positions(length, update_rate_hz))
    return seconds / hops / len(few) * len(hop_positions(round(STROKE_SECONDS * SAMPLE_RATE_HZ), update_rate_hz))


def render_all(
    root: Path, rendering: Rendering, out: Path, workers: int, advance: Callable[[int], object] = lambda strokes: None
) -> None:
    """Write every stroke that `out` does not hold yet. advance: told of finished strokes, those found included."""
    start_generated(out, rendering.origin)
    strokes = rendering.strokes()
    waiting = [stroke for stroke in strokes if not generated_path(out, stroke.identity).exists()]
    advance(len(strokes) - len(waiting))
    with ProcessPoolExecutor(workers, get_context("spawn")) as pool:
        running: set[Future[int]] = set()
        try:
            for first in range(0, len(waiting), _BATCH):
                running.add(pool.submit(_render_some, root, rendering, out, waiting[first : first + _BATCH]))
                while len(running) > workers:
                    running = _awaited(running, advance)
            while running:
                running = _awaited(running, advance)
        finally:
            pool.shutdown(wait=True, cancel_futures=True)


def _awaited(running: set[Future[int]], advance: Callable[[int], object]) -> set[Future[int]]:
    done, left = wait(running, timeout=1.0, return_when=FIRST_COMPLETED)
    for each in done:
        advance(each.result())
    end_if_stopped()
    return left


def _render_some(root: Path, rendering: Rendering, out: Path, strokes: Sequence[Stroke]) -> int:
    generator = _generator(root, rendering.teacher)
    first = strokes[0].identity
    seed = rendering.seed * 1_000_003 + first.texture_id * 1009 + first.repeat
    waves = rendered(generator, rendering.teacher, strokes, rendering.update_rate_hz, seed)
    for stroke, wave in zip(strokes, waves, strict=True):
        write_generated(generated_path(out, stroke.identity), wave, stroke.motion[SETTLING_SAMPLES:])
    return len(strokes)


@functools.cache
def _generator(root: Path, teacher: Teacher) -> EngineGenerator:
    """The generator of this worker process, opened once; nobody closes it, because it ends with the process."""
    return teacher.open(default_engine(root), _BATCH)


_OF_THE_OTHER = ("name", "category", "stiffness_newtons_per_metre", "friction_coefficient")


def complete(file: Path, teacher: Teacher) -> int:
    """Rewrite the file with them; returns its CRC-32."""
    model = read_model_file(file)
    header = model.header
    entries = {entry["name"]: entry for entry in header["labels"]}
    for label in teacher.labels:
        for other in label.others:
            header["labels"].append({**entries[label.name], **{key: other[key] for key in _OF_THE_OTHER}})
    header["name"] = f"{teacher.name}, distilled"
    header["description"] = f"{len(entries)} materials of {teacher.name}, learnt from what it generates."
    header["normalisation"]["assumed"] = teacher.level_is_assumed
    return write_model_file(file, model)


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
        read.append(MaterialRecording(waveform, motion))
    return estimate_wave_vectors(read)


def _quoted(text: str) -> str:
    """A TOML string: JSON's escapes are a part of TOML's."""
    return json.dumps(text, ensure_ascii=False)
