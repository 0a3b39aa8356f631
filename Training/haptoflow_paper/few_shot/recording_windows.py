"""Windows of recordings at 2 kHz, from which the rivals are fitted."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.recordings.material_recording import MaterialRecording

_Floats = NDArray[np.float32]


@dataclass(frozen=True)
class Windows:
    """Stretches of recordings: waves [n, samples]; motion [n, samples, 3] (vx, vy in m/s and force in N)."""

    waves: _Floats
    motion: _Floats

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
        return Windows(self.waves[mask], self.motion[mask])


def windows_of(recordings: Sequence[MaterialRecording], samples: int, hop: int) -> Windows:
    """Every stretch of `samples` that starts a multiple of `hop` after a recording's first sample."""
    waves, motions = [np.zeros((0, samples), dtype=np.float32)], [np.zeros((0, samples, 3), dtype=np.float32)]
    for recording in recordings:
        motion = np.column_stack([recording.velocity_mps, recording.force_newtons]).astype(np.float32)
        for start in range(0, len(motion) - samples + 1, hop):
            waves.append(recording.vibration_mps2[None, start : start + samples])
            motions.append(motion[None, start : start + samples])
    return Windows(np.concatenate(waves), np.concatenate(motions))
