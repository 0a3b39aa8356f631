"""A recording of one material as it is fitted to: one axis at 2 kHz with the motion and the place of every sample."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

SAMPLE_RATE_HZ = 2000

_Floats = NDArray[np.float32]


@dataclass(frozen=True)
class MaterialRecording:
    """wave_mps2 [n]; motion [n, 3]: vx, vy in m/s and force in N; position_mm [n, 2]. All finite."""

    wave_mps2: _Floats
    motion: _Floats
    position_mm: _Floats

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
        """[n]: of the mean velocity's samples, so that a turn is not taken for rest."""
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


def seconds_of(recordings: Sequence[MaterialRecording]) -> float:
    return sum(len(recording) for recording in recordings) / SAMPLE_RATE_HZ


def windows_of(recordings: Sequence[MaterialRecording], samples: int, hop: int) -> Windows:
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
