"""Windows of the training recordings with their conditions, from which seeds and exponents are computed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.preprocessing.store import SegmentStore
from haptoflow_training.training.held_out import HeldOut, clear_spans


@dataclass(frozen=True)
class RecordedWindows:
    """waves [n, samples] in m/s^2; motion [n, 3]: mean vx, vy (m/s) and force (N); unsteadiness [n]: standard
    deviation of log speed over the window; position_mm [n, 2]: the place on the surface at the window's middle
    sample."""

    waves: NDArray[np.float32]
    motion: NDArray[np.float32]
    unsteadiness: NDArray[np.float32]
    position_mm: NDArray[np.float32]

    @property
    def speed_mps(self) -> NDArray[np.float32]:
        return np.hypot(self.motion[:, 0], self.motion[:, 1])

    @property
    def rms_mps2(self) -> NDArray[np.float32]:
        return np.sqrt(np.square(self.waves).mean(axis=1))


def draw_windows(
    store: SegmentStore, label_index: int, *, samples: int, count: int, seed: int, held_out: HeldOut
) -> RecordedWindows:
    """`count` random windows of the label's training recordings, each within one recording and outside the held-out
    bands."""
    recordings = [
        recording
        for recording in store.recordings
        if recording.split == "train" and recording.label_index == label_index and recording.length > samples
    ]
    if not recordings:
        raise ValueError(f"label '{store.labels[label_index]}' has no training recording of {samples} samples")
    spans = clear_spans(
        store.motion,
        np.array([recording.start for recording in recordings], dtype=np.int64),
        np.array([recording.length for recording in recordings], dtype=np.int64),
        held_out,
    )
    room = np.maximum(spans.lengths - samples, 0)
    if not room.any():
        raise ValueError(f"label '{store.labels[label_index]}' has no {samples} samples outside the held-out bands")
    generator = np.random.default_rng([seed, label_index])
    chosen = generator.choice(len(room), size=count, p=room / room.sum())
    starts = spans.starts[chosen] + (generator.random(count) * room[chosen]).astype(np.int64)
    windows = starts[:, None] + np.arange(samples)[None, :]
    motion = store.motion[windows]
    speed = np.hypot(motion[..., 0], motion[..., 1])
    return RecordedWindows(
        waves=(store.waveform[windows] * np.float32(store.peak_mps2)).astype(np.float32),
        motion=motion.mean(axis=1).astype(np.float32),
        unsteadiness=np.log(speed + 0.002).std(axis=1).astype(np.float32),
        position_mm=store.position_mm[starts + samples // 2],
    )
