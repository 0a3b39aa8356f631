"""Tone and level of a fitted embedding, from its own closed-loop output along the recording's motion.

Neither is heard by the network: the level is divided out of its past and the tone comes after it. So one rendering serves
all rounds, and both are fitted to it without rendering again.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.export.material_sound import LevelTable, ToneTable
from haptoflow_training.fewshot.label_prior import LabelPrior
from haptoflow_training.fewshot.level_law import SLOWEST_MPS, LevelLaw, fit_level
from haptoflow_training.fewshot.material_recording import MaterialRecording, Windows, windows_of
from haptoflow_training.fewshot.tone_fit import (
    WINDOW_SAMPLES,
    ToneOptions,
    band_powers,
    fit_tone,
    speed_knots,
)
from haptoflow_training.fewshot.voice import Voice, apply_tone, render
from haptoflow_training.models.file_model import FileTier

CHUNK_SAMPLES = 4000
SETTLING_SAMPLES = 400
_RENDERED_CHUNKS, _DRAWS = 24, 3
_ROUNDS = 2
LEVEL_WINDOW_SAMPLES, LEVEL_HOP_SAMPLES = 200, 100

_Floats = NDArray[np.float32]


@dataclass(frozen=True)
class Rendered:
    """chunks [n] of the recording and what the voice makes of each, without tone: draws [draws][n]."""

    chunks: tuple[MaterialRecording, ...]
    draws: tuple[tuple[MaterialRecording, ...], ...]


def chunks_of(recordings: Sequence[MaterialRecording], most: int, seed: int) -> tuple[MaterialRecording, ...]:
    """At most `most` stretches of 2 s (all of a shorter recording), spread over the recordings."""
    found = []
    for recording in recordings:
        count = max(1, len(recording) // CHUNK_SAMPLES)
        length = min(len(recording), CHUNK_SAMPLES)
        if length < SETTLING_SAMPLES + WINDOW_SAMPLES:
            continue
        for start in np.linspace(0, len(recording) - length, count).astype(int):
            part = slice(int(start), int(start) + length)
            found.append(
                MaterialRecording(recording.wave_mps2[part], recording.motion[part], recording.position_mm[part])
            )
    if len(found) > most:
        chosen = np.random.default_rng(seed).permutation(len(found))[:most]
        found = [found[index] for index in sorted(chosen)]
    return tuple(found)


def render_chunks(tier: FileTier, voice: Voice, chunks: tuple[MaterialRecording, ...], seed: int) -> Rendered:
    length = max(len(chunk) for chunk in chunks)
    motions = np.stack([_padded(chunk.motion, length) for chunk in chunks])
    rows = np.concatenate([motions] * _DRAWS)
    run = render(tier, [replace(voice, tone=None)] * len(rows), rows, seed)
    draws = tuple(
        tuple(
            replace(chunk, wave_mps2=run.waves[draw * len(chunks) + index, : len(chunk)])
            for index, chunk in enumerate(chunks)
        )
        for draw in range(_DRAWS)
    )
    return Rendered(chunks, draws)


def fit_sound(
    rendered: Rendered,
    recordings: Sequence[MaterialRecording],
    level: LevelLaw,
    prior: LabelPrior,
    seconds: float,
    options: ToneOptions = ToneOptions(),
) -> tuple[ToneTable, LevelLaw]:
    """The tone, and the level before it with which both together are as loud as recorded."""
    recorded = _settled(rendered.chunks, WINDOW_SAMPLES)
    speed = recorded.speed_mps
    # A tone is heard while the tip moves; at rest there is none to be known.
    moving = speed > SLOWEST_MPS
    knots = speed_knots(speed[moving], seconds)
    powers, centres, counts = band_powers(recorded.waves[moving])
    tone: ToneTable | None = None
    for _ in range(_ROUNDS):
        made = np.mean(
            [
                band_powers(_settled(_toned(draw, tone), WINDOW_SAMPLES).waves[moving])[0]
                for draw in rendered.draws
            ],
            axis=0,
        )
        more = fit_tone(powers, made, centres, counts, speed[moving], knots, options)
        tone = more if tone is None else _added(tone, more)
    assert tone is not None
    tone = _centred(tone)
    return tone, calibrated(rendered, recordings, level, prior, tone)


def calibrated(
    rendered: Rendered,
    recordings: Sequence[MaterialRecording],
    level: LevelLaw,
    prior: LabelPrior,
    tone: ToneTable | None,
) -> LevelLaw:
    """The level with which what is rendered is as loud as what was recorded: the same law is fitted to both, and the
    difference is taken back."""
    made = [chunk for draw in rendered.draws for chunk in _toned(draw, tone)]
    heard = fit_level(_settled(made, LEVEL_WINDOW_SAMPLES), prior)
    wanted = fit_level(_settled(rendered.chunks, LEVEL_WINDOW_SAMPLES), prior)
    whole = fit_level(windows_of(recordings, LEVEL_WINDOW_SAMPLES, LEVEL_HOP_SAMPLES), prior)
    table = whole.table
    middle = table.force_newtons
    speeds = np.array(table.speeds_mps)
    shift = wanted.table.log_level(speeds, middle, wanted.speed_exponent) - heard.table.log_level(
        speeds, middle, heard.speed_exponent
    )
    shift += level.table.log_level(speeds, middle, level.speed_exponent) - whole.table.log_level(
        speeds, middle, whole.speed_exponent
    )
    moved = whole.shifted(speeds, np.clip(shift, -1.5, 1.5))
    exponent = table.force_exponent + wanted.force_exponent - heard.force_exponent
    exponent += level.force_exponent - whole.force_exponent
    exponent = round(float(np.clip(exponent, -4.0, 4.0)), 4)
    return LevelLaw(
        LevelTable(moved.table.speeds_mps, moved.table.log_levels, middle, exponent), moved.speed_exponent
    )


def _padded(motion: _Floats, length: int) -> _Floats:
    return np.concatenate([motion, np.repeat(motion[-1:], length - len(motion), axis=0)])


def _settled(chunks: Sequence[MaterialRecording], samples: int) -> Windows:
    """Windows that begin after the loop has swung in."""
    later = [
        MaterialRecording(
            chunk.wave_mps2[SETTLING_SAMPLES:], chunk.motion[SETTLING_SAMPLES:], chunk.position_mm[SETTLING_SAMPLES:]
        )
        for chunk in chunks
    ]
    return windows_of(later, samples, samples // 2)


def _toned(chunks: Sequence[MaterialRecording], tone: ToneTable | None) -> list[MaterialRecording]:
    return [
        replace(chunk, wave_mps2=apply_tone(chunk.wave_mps2, np.hypot(*chunk.motion[:, :2].T), tone)) for chunk in chunks
    ]


def _added(tone: ToneTable, more: ToneTable) -> ToneTable:
    gains = np.clip(np.array(tone.gains_db) + np.array(more.gains_db), -30.0, 30.0)
    return replace(tone, gains_db=tuple(tuple(round(float(value), 2) for value in row) for row in gains))


def _centred(tone: ToneTable) -> ToneTable:
    """Each row about 0 dB on average, so that a level is a level and a tone a tone."""
    gains = np.array(tone.gains_db)
    gains = np.clip(gains - gains.mean(axis=1, keepdims=True), -30.0, 30.0)
    return replace(tone, gains_db=tuple(tuple(round(float(value), 2) for value in row) for row in gains))
