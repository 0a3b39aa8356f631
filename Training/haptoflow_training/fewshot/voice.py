"""Renders a material: the model in closed loop with the material's own level, followed by its tone."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import torch
from numpy.typing import NDArray

from haptoflow_training.closed_loop.render import UPDATE_RATE_HZ, ClosedLoopRun, run_closed_loop
from haptoflow_training.export.material_sound import ToneTable
from haptoflow_training.fewshot.level_law import LevelLaw
from haptoflow_training.models.file_model import FileTier

_KERNELS = 24
_PREVIOUS_LIMIT = 16.0

_Floats = NDArray[np.float32]


@dataclass(frozen=True)
class Voice:
    """embedding [64] with the level and the tone that belong to it."""

    embedding: _Floats
    level: LevelLaw
    tone: ToneTable | None = None


@dataclass
class VoiceSource:
    """A source of segments for `run_closed_loop` in which each row of a batch has a voice of its own."""

    tier: FileTier
    voices: Sequence[Voice]

    @torch.no_grad()
    def generate(
        self, embeddings: _Floats, motions: _Floats, previous_mps2: _Floats, noise: _Floats, rib_phase: _Floats
    ) -> _Floats:
        asked = zip(self.voices, motions, strict=True)
        log_level = np.array([voice.level.log_level(motion) for voice, motion in asked])
        gain = np.exp(log_level).astype(np.float32)[:, None]
        previous = np.clip(previous_mps2 / gain, -_PREVIOUS_LIMIT, _PREVIOUS_LIMIT)
        made = self.tier.segment(
            torch.from_numpy(noise).unsqueeze(1),
            torch.from_numpy(previous.astype(np.float32)).unsqueeze(1),
            torch.from_numpy(np.ascontiguousarray(embeddings)),
            torch.from_numpy(motions),
            torch.from_numpy(rib_phase),
        )
        return np.asarray(made.squeeze(1).numpy() * gain)


def render(tier: FileTier, voices: Sequence[Voice], motions: _Floats, seed: int) -> ClosedLoopRun:
    """The output of each voice for motions [n, samples, 3], tone included; from silence, at 72 Hz."""
    run = run_closed_loop(
        VoiceSource(tier, voices),
        np.stack([voice.embedding for voice in voices]),
        motions,
        update_rate_hz=UPDATE_RATE_HZ,
        seed=seed,
    )
    toned = [
        apply_tone(wave, np.hypot(motion[:, 0], motion[:, 1]), voice.tone)
        for wave, motion, voice in zip(run.waves, motions, voices, strict=True)
    ]
    return ClosedLoopRun(np.stack(toned).astype(np.float32), run.hop_starts)


def apply_tone(wave: _Floats, speed_mps: NDArray[np.floating], tone: ToneTable | None) -> _Floats:
    """wave [n] filtered by the tone at speed_mps [n]: kernels at a grid of log speeds, mixed linearly."""
    if tone is None:
        return wave
    slow, fast = tone.speeds_mps[0], tone.speeds_mps[-1]
    grid = np.geomspace(slow, fast, _KERNELS) if fast > slow else np.array([slow])
    place = np.interp(np.log(np.maximum(speed_mps, 1e-6)), np.log(grid), np.arange(len(grid)))
    made = np.zeros(len(wave))
    for index, speed in enumerate(grid):
        share = np.clip(1.0 - np.abs(place - index), 0.0, 1.0)
        if share.any():
            made += share * np.convolve(wave, tone.kernel(float(speed)))[: len(wave)]
    return made.astype(np.float32)
