"""A recording of one material in the form that is fitted: one axis at 2 kHz with the motion and place of every sample,
in the material's own frame.

A surface may have any orientation in its recording. The first axis of a ruled material is put across its clearest ribs,
as in the labels that the networks know; without ribs, the frame is that of the recording.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.models.label_embedding import WAVE_NUMBERS, WAVE_VECTORS
from haptoflow_training.recordings.material_recording import MaterialRecording
from haptoflow_training.waveform import SAMPLE_RATE_HZ


_Floats = NDArray[np.float32]


@dataclass(frozen=True)
class Frame:
    """turn_radians: from the recording's first axis to the material's. wave_numbers [4]: k1x, k1y, k2x, k2y in
    cycles per millimetre in the material's frame, 0 for none."""

    turn_radians: float
    wave_numbers: _Floats

    @classmethod
    def of(cls, wave_vectors_per_mm: Sequence[tuple[float, float]]) -> Frame:
        """The frame of up to two wave vectors in the recording's frame, the clearest first."""
        vectors = np.array(wave_vectors_per_mm[:WAVE_VECTORS], dtype=np.float64).reshape(-1, 2)
        turn = float(np.arctan2(vectors[0, 1], vectors[0, 0])) if len(vectors) else 0.0
        turned = _turned(vectors, turn)
        # A wave vector and its negative describe the same ribs; the second one gets the sign that labels use.
        turned[turned[:, 1] < -1e-9] *= -1.0
        turned[np.abs(turned) < 1e-9] = 0.0
        numbers = np.zeros(WAVE_NUMBERS, dtype=np.float32)
        numbers[: turned.size] = turned.reshape(-1)
        return cls(turn, numbers)

    @property
    def is_ruled(self) -> bool:
        return bool(self.wave_numbers.any())

    def turned(self, vectors: NDArray[np.floating]) -> _Floats:
        """Vectors [n, 2] of the recording in the material's frame."""
        return _turned(vectors, self.turn_radians).astype(np.float32)

    def turned_motion(self, motion: NDArray[np.floating]) -> _Floats:
        """Motion [n, 3] in the material's frame: the force stays as it is."""
        return np.column_stack([self.turned(motion[:, :2]), motion[:, 2]]).astype(np.float32)


def _turned(vectors: NDArray[np.floating], radians: float) -> NDArray[np.float64]:
    cosine, sine = math.cos(radians), math.sin(radians)
    return np.asarray(vectors, dtype=np.float64) @ np.array([[cosine, -sine], [sine, cosine]])


@dataclass(frozen=True)
class StrokeRecording:
    """wave_mps2 [n]; motion [n, 3]: vx, vy in m/s and force in N; position_mm [n, 2], relative to the recording's
    first sample. All values are finite."""

    wave_mps2: _Floats
    motion: _Floats
    position_mm: _Floats

    @classmethod
    def of(cls, recording: MaterialRecording, frame: Frame) -> StrokeRecording:
        velocity = frame.turned(recording.velocity_mps)
        position = np.cumsum(velocity, axis=0, dtype=np.float64) * (1000.0 / SAMPLE_RATE_HZ)
        return cls(
            recording.vibration_mps2,
            np.column_stack([velocity, recording.force_newtons]).astype(np.float32),
            position.astype(np.float32),
        )

    def __len__(self) -> int:
        return len(self.wave_mps2)


@dataclass(frozen=True)
class Windows:
    """Stretches of recordings: waves [n, samples]; motion [n, samples, 3]; position_mm [n, samples, 2]."""

    waves: _Floats
    motion: _Floats
    position_mm: _Floats

    def __len__(self) -> int:
        return len(self.waves)

    @property
    def speed_mps(self) -> _Floats:
        """[n]: mean of the samples' speeds, so that a turn does not count as rest."""
        return np.hypot(self.motion[..., 0], self.motion[..., 1]).mean(axis=1)

    @property
    def force_newtons(self) -> _Floats:
        return self.motion[..., 2].mean(axis=1)

    @property
    def unsteadiness(self) -> _Floats:
        """[n]: standard deviation of the logarithm of the speed."""
        speed = np.hypot(self.motion[..., 0], self.motion[..., 1])
        return np.log(speed + 0.002).std(axis=1)

    def chosen(self, mask: NDArray[np.bool_]) -> Windows:
        return Windows(self.waves[mask], self.motion[mask], self.position_mm[mask])


def windows_of(recordings: Sequence[StrokeRecording], samples: int, hop: int) -> Windows:
    """Every stretch of `samples` that starts a multiple of `hop` after a recording's first sample."""
    waves, motions, places = [], [], []
    for recording in recordings:
        for start in range(0, len(recording) - samples + 1, hop):
            stretch = slice(start, start + samples)
            waves.append(recording.wave_mps2[stretch])
            motions.append(recording.motion[stretch])
            places.append(recording.position_mm[stretch])
    if not waves:
        empty = np.zeros((0, samples), dtype=np.float32)
        return Windows(empty, np.zeros((0, samples, 3), np.float32), np.zeros((0, samples, 2), np.float32))
    return Windows(np.stack(waves), np.stack(motions), np.stack(places))
