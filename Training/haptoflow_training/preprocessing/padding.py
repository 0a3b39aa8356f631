"""Adds silence before and after a recording, so that a network learns what happens without vibration.

Three states without vibration: `rest` touches without moving, at the recording's force; `contact` touches down or lifts
off without moving, its force rising from or falling to zero; `air` has neither velocity nor force.
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from typing import Literal, TypeVar

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.preprocessing.pipeline import PreparedRecording
from haptoflow_training.preprocessing.settings import PreprocessingSettings

PaddingState = Literal["rest", "contact", "air"]
_Float = TypeVar("_Float", np.float32, np.float64)
PADDING_STATES: tuple[PaddingState, ...] = ("rest", "contact", "air")
# Largest share of a recording's length at each end, so that silence does not outweigh the recording.
_MAXIMUM_SHARE = 1.0 / 3.0


@dataclass(frozen=True)
class PaddedRecording:
    """`prepared` with silence at its ends; padding_before and padding_after count samples of it."""

    prepared: PreparedRecording
    padding_before: int
    padding_after: int


def pad_recording(
    prepared: PreparedRecording, name: str, settings: PreprocessingSettings, seed: int
) -> PaddedRecording:
    """Each end is padded with `padding_probability`; the draw depends on `seed` and `name` only, and the padding at
    an end is at most a third of the recording's length."""
    digest = hashlib.blake2b(f"padding/{seed}/{name}".encode(), digest_size=8).digest()
    generator = np.random.default_rng(int.from_bytes(digest, "little"))
    longest = int(_MAXIMUM_SHARE * len(prepared.waveform_mps2))
    before = _draw(generator, settings, longest)
    after = _draw(generator, settings, longest)
    if before is not None:
        prepared = _pad_front(prepared, *before, settings)
    if after is not None:
        prepared = _reversed(_pad_front(_reversed(prepared), *after, settings))
    return PaddedRecording(prepared, before[1] if before else 0, after[1] if after else 0)


def _draw(
    generator: np.random.Generator, settings: PreprocessingSettings, longest: int
) -> tuple[PaddingState, int] | None:
    wanted = generator.random() < settings.padding_probability
    state = PADDING_STATES[int(generator.integers(len(PADDING_STATES)))]
    segments = int(generator.integers(1, settings.padding_segments_max + 1))
    return (state, min(segments * settings.segment_samples, longest)) if wanted else None


def _pad_front(
    prepared: PreparedRecording, state: PaddingState, samples: int, settings: PreprocessingSettings
) -> PreparedRecording:
    fade = min(round(settings.padding_fade_seconds * settings.sample_rate_hz), len(prepared.waveform_mps2))
    gain = (0.5 - 0.5 * np.cos(np.pi * (np.arange(fade) + 0.5) / max(fade, 1))).astype(np.float32)
    waveform = prepared.waveform_mps2.copy()
    waveform[:fade] *= gain
    motion = prepared.motion.copy()
    motion[:fade, :2] *= gain[:, None]
    force = float(motion[0, 2])
    silence = np.zeros((samples, 3), dtype=np.float32)
    if state == "rest":
        silence[:, 2] = force
    elif state == "contact":
        silence[:, 2] = force * np.linspace(0.0, 1.0, samples, dtype=np.float32)
    else:
        motion[:fade, 2] *= gain
    return PreparedRecording(
        np.concatenate([np.zeros(samples, dtype=np.float32), waveform]),
        np.concatenate([silence, motion]),
        _held_before(prepared.position_mm, samples),
        _held_before(prepared.wander_turns, samples),
    )


def _held_before(values: NDArray[_Float], samples: int) -> NDArray[_Float]:
    return np.concatenate([np.repeat(values[:1], samples, axis=0), values])


def _reversed(prepared: PreparedRecording) -> PreparedRecording:
    waveform: NDArray[np.float32] = prepared.waveform_mps2[::-1]
    return PreparedRecording(
        waveform, prepared.motion[::-1], prepared.position_mm[::-1], prepared.wander_turns[::-1]
    )
