"""Seeds of a material: steady stretches of its recording, before tone."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from haptoflow_training.export.material_file import SEED_SAMPLES, MaterialSeed
from haptoflow_training.export.material_sound import KERNEL_SAMPLES, ToneTable
from haptoflow_training.fewshot.level_law import MINIMUM_SPEED_MPS
from haptoflow_training.fewshot.stroke_recording import StrokeRecording, windows_of
from haptoflow_training.fewshot.voice import apply_tone

MAXIMUM_SEEDS = 8
_HOP_SAMPLES = 100


def choose_seeds(
    recordings: Sequence[StrokeRecording],
    tone: ToneTable | None,
    turns: Sequence[np.ndarray],
    *,
    ruled: bool,
) -> tuple[MaterialSeed, ...]:
    """At most eight seeds, spread evenly over the log of the recorded speeds, the steadiest near each. turns: rib
    phase [n, 2] of each recording's samples."""
    undone = tone
    if tone is not None:
        undone = replace(tone, gains_db=tuple(tuple(-gain for gain in row) for row in tone.gains_db))
    # Each seed is filtered together with the samples before it, which fill the filter's memory and are then cut off.
    windows = windows_of(recordings, SEED_SAMPLES + KERNEL_SAMPLES, _HOP_SAMPLES)
    phases = [
        phase[start + KERNEL_SAMPLES + SEED_SAMPLES // 2]
        for recording, phase in zip(recordings, turns, strict=True)
        for start in range(0, len(recording) - SEED_SAMPLES - KERNEL_SAMPLES + 1, _HOP_SAMPLES)
    ]
    speed = windows.speed_mps
    moving = np.flatnonzero(speed > MINIMUM_SPEED_MPS)
    if not len(moving):
        return ()
    low, high = np.quantile(speed[moving], [0.05, 0.95])
    chosen: dict[int, None] = {}
    for wanted in np.geomspace(low, high, MAXIMUM_SEEDS):
        distance = np.abs(np.log(speed[moving] / wanted)) + 2.0 * windows.unsteadiness[moving]
        chosen[int(moving[int(np.argmin(distance))])] = None
    seeds = []
    for index in sorted(chosen, key=lambda each: float(speed[each])):
        motion = windows.motion[index]
        wave = apply_tone(windows.waves[index], np.hypot(motion[:, 0], motion[:, 1]), undone)[KERNEL_SAMPLES:]
        rms = float(np.sqrt(np.square(wave, dtype=np.float64).mean()))
        if rms <= 0.0:
            continue
        mean = motion[KERNEL_SAMPLES:].mean(axis=0)
        turned = phases[index]
        seeds.append(
            MaterialSeed(
                (round(float(mean[0]), 5), round(float(mean[1]), 5)),
                round(float(max(mean[2], 0.0)), 4),
                (wave / rms).astype(np.float32),
                (round(float(turned[0]), 5) % 1.0, round(float(turned[1]), 5) % 1.0) if ruled else None,
            )
        )
    return tuple(seeds)
