"""Fits the tone and the level of an embedding from its closed-loop output along the recording's motion.

Neither affects the network: its previous waveform is divided by the level, and the tone is applied after it. Therefore
one rendering serves all rounds of the fit.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.export.material_sound import LevelTable, ToneTable
from haptoflow_training.fewshot.label_prior import LabelPrior
from haptoflow_training.fewshot.level_law import MINIMUM_SPEED_MPS, LevelLaw, fit_level
from haptoflow_training.fewshot.stroke_recording import StrokeRecording, Windows, windows_of
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
_AUDIBLE_SHARE = 1e-3
_MINIMUM_SPEED_MPS, _MAXIMUM_UNSTEADINESS, _MINIMUM_WINDOWS = 0.01, 0.5, 6
LEVEL_WINDOW_SAMPLES, LEVEL_HOP_SAMPLES = 200, 100

_Floats = NDArray[np.float32]


@dataclass(frozen=True)
class Rendered:
    """chunks [n] of the recording and the voice's output for each, without tone: draws [draws][n]."""

    chunks: tuple[StrokeRecording, ...]
    draws: tuple[tuple[StrokeRecording, ...], ...]


def chunks_of(recordings: Sequence[StrokeRecording], most: int, seed: int) -> tuple[StrokeRecording, ...]:
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
                StrokeRecording(recording.wave_mps2[part], recording.motion[part], recording.position_mm[part])
            )
    if len(found) > most:
        chosen = np.random.default_rng(seed).permutation(len(found))[:most]
        found = [found[index] for index in sorted(chosen)]
    return tuple(found)


def render_chunks(tier: FileTier, voice: Voice, chunks: tuple[StrokeRecording, ...], seed: int) -> Rendered:
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
    recordings: Sequence[StrokeRecording],
    level: LevelLaw,
    prior: LabelPrior,
    seconds: float,
    options: ToneOptions = ToneOptions(),
) -> tuple[ToneTable, LevelLaw]:
    """The tone, and the level before it with which both together are as loud as the recording."""
    recorded = _settled(rendered.chunks, WINDOW_SAMPLES)
    speed = recorded.speed_mps
    # A tone matters only while the tip moves; at rest it cannot be estimated.
    moving = (speed > _MINIMUM_SPEED_MPS) & (recorded.unsteadiness < _MAXIMUM_UNSTEADINESS)
    if moving.sum() < _MINIMUM_WINDOWS:
        moving = speed > MINIMUM_SPEED_MPS
    if not moving.any():
        moving = np.ones_like(moving)
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
    recordings: Sequence[StrokeRecording],
    level: LevelLaw,
    prior: LabelPrior,
    tone: ToneTable | None,
) -> LevelLaw:
    """The level with which the rendering is as loud as the recording: the same law is fitted to both, and the
    difference is subtracted."""
    made = [chunk for draw in rendered.draws for chunk in _toned(draw, tone)]
    rendered_law = fit_level(_settled(made, LEVEL_WINDOW_SAMPLES), prior)
    wanted = fit_level(_settled(rendered.chunks, LEVEL_WINDOW_SAMPLES), prior)
    whole = fit_level(windows_of(recordings, LEVEL_WINDOW_SAMPLES, LEVEL_HOP_SAMPLES), prior)
    table = whole.table
    middle = table.force_newtons
    speeds = np.array(table.speeds_mps)
    shift = wanted.table.log_level(speeds, middle, wanted.speed_exponent) - rendered_law.table.log_level(
        speeds, middle, rendered_law.speed_exponent
    )
    shift += level.table.log_level(speeds, middle, level.speed_exponent) - whole.table.log_level(
        speeds, middle, whole.speed_exponent
    )
    moved = whole.shifted(speeds, np.clip(shift, -1.5, 1.5))
    exponent = table.force_exponent + wanted.force_exponent - rendered_law.force_exponent
    exponent += level.force_exponent - whole.force_exponent
    exponent = round(float(np.clip(exponent, -4.0, 4.0)), 4)
    return LevelLaw(
        LevelTable(moved.table.speeds_mps, moved.table.log_levels, middle, exponent), moved.speed_exponent
    )


def band_distance_db(rendered: Rendered, tone: ToneTable | None) -> float:
    """RMS over narrow bands and speeds of the difference in dB between the mean spectra of recording and rendering,
    level removed; the recorded speeds are divided into thirds. Bands below a thousandth of the mean power are left
    out."""
    recorded = _settled(rendered.chunks, WINDOW_SAMPLES)
    order = np.argsort(recorded.speed_mps)
    powers = band_powers(recorded.waves)[0]
    settled = [_settled(_toned(draw, tone), WINDOW_SAMPLES) for draw in rendered.draws]
    made = np.mean([band_powers(windows.waves)[0] for windows in settled], axis=0)
    errors = []
    for part in np.array_split(order, 3):
        if len(part):
            means = [values[part].mean(axis=0) for values in (made, powers)]
            floored = [values / values.mean() + _AUDIBLE_SHARE for values in means]
            difference = 10.0 * np.log10(floored[0] / floored[1])
            errors.append(np.square(difference - difference.mean()).mean())
    return float(np.sqrt(np.mean(errors)))


def _padded(motion: _Floats, length: int) -> _Floats:
    return np.concatenate([motion, np.repeat(motion[-1:], length - len(motion), axis=0)])


def _settled(chunks: Sequence[StrokeRecording], samples: int) -> Windows:
    """Windows that begin after the closed loop has settled."""
    later = [
        StrokeRecording(
            chunk.wave_mps2[SETTLING_SAMPLES:], chunk.motion[SETTLING_SAMPLES:], chunk.position_mm[SETTLING_SAMPLES:]
        )
        for chunk in chunks
    ]
    return windows_of(later, samples, samples // 2)


def _toned(chunks: Sequence[StrokeRecording], tone: ToneTable | None) -> list[StrokeRecording]:
    return [
        replace(chunk, wave_mps2=apply_tone(chunk.wave_mps2, np.hypot(*chunk.motion[:, :2].T), tone))
        for chunk in chunks
    ]


def _added(tone: ToneTable, more: ToneTable) -> ToneTable:
    gains = np.clip(np.array(tone.gains_db) + np.array(more.gains_db), -30.0, 30.0)
    return replace(tone, gains_db=tuple(tuple(round(float(value), 2) for value in row) for row in gains))


def _centred(tone: ToneTable) -> ToneTable:
    """Each row with mean 0 dB, so that the tone contains no level."""
    gains = np.array(tone.gains_db)
    gains = np.clip(gains - gains.mean(axis=1, keepdims=True), -30.0, 30.0)
    return replace(tone, gains_db=tuple(tuple(round(float(value), 2) for value in row) for row in gains))
