"""A small in-memory store: two labels with known waveforms and levels, so that tests need no recordings."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.cli import main
from haptoflow_training.training.level_calibration import closed_loop_levels, offsets_db
from haptoflow_training.training.closed_loop import SurfaceStatistics
from haptoflow_training.training.batches import HeldOut
from haptoflow_training.training.processes import Job

RATE_HZ = 2000


@dataclass(frozen=True)
class FakeRecording:
    label_index: int
    protocol: str
    split: str
    start: int
    length: int
    specimen: int | None = None


@dataclass(frozen=True)
class FakeStore:
    waveform: NDArray[np.float32]
    motion: NDArray[np.float32]
    position_mm: NDArray[np.float32]
    peak_mps2: float
    labels: list[str]
    recordings: list[FakeRecording]
    skipped: tuple[object, ...] = ()
    notes: tuple[str, ...] = ()
    wander_turns: NDArray[np.float32] = field(default_factory=lambda: np.zeros((0, 3), np.float32))
    ribs_followed: bool = False

    def __post_init__(self) -> None:
        if not len(self.wander_turns):
            object.__setattr__(self, "wander_turns", np.zeros((len(self.waveform), 3), np.float32))


def travelled_mm(motion: NDArray[np.floating]) -> NDArray[np.float32]:
    """The position of a tip that starts at 0, [n, 2], from its motion [n, 3] in m/s."""
    return (1000.0 / RATE_HZ * np.cumsum(motion[:, :2], axis=0, dtype=np.float64)).astype(np.float32)


def make_store(*, seconds: float = 4.0, recordings_per_split: int = 2, seed: int = 3) -> FakeStore:
    """Label `tone`: 150 Hz, RMS = 2 v^1 F^0.3; label `noise`: white, RMS = 5 v^0.5. Speeds 0.02-0.6 m/s, 0.3-3 N."""
    generator = np.random.default_rng(seed)
    waves, motions, recordings, start = [], [], [], 0
    length = int(seconds * RATE_HZ)
    time = np.arange(length) / RATE_HZ
    for split in ("train", "validation", "test"):
        for label in range(2):
            for number in range(recordings_per_split):
                speed = np.exp(np.linspace(np.log(0.02), np.log(0.6), length))[:: (1 if number % 2 == 0 else -1)]
                force = 0.3 * 10.0 ** generator.random() * np.ones(length)
                angle = generator.random() * 2.0 * np.pi
                if label == 0:
                    wave = np.sqrt(2.0) * np.sin(2.0 * np.pi * 150.0 * time + angle) * 2.0 * speed * force**0.3
                else:
                    wave = generator.normal(size=length) * 5.0 * np.sqrt(speed)
                waves.append(wave)
                motions.append(np.stack([speed * np.cos(angle), speed * np.sin(angle), force], axis=1))
                protocol = "machine" if number % 2 == 0 else "hand"
                recordings.append(FakeRecording(label, protocol, split, start, length))
                start += length
    peak = 10.0
    return FakeStore(
        (np.concatenate(waves) / peak).astype(np.float32),
        np.concatenate(motions).astype(np.float32),
        np.concatenate([travelled_mm(motion) for motion in motions]),
        peak,
        ["tone", "noise"],
        recordings,
    )


def run_here(jobs: Sequence[Job], lanes: int, progress: Callable[[int], None]) -> None:
    """`run_jobs` of `train-tiers` without processes of their own, each of which imports PyTorch."""
    for finished, job in enumerate(jobs, start=1):
        assert main(list(job.words)) == 0, job.name
        progress(finished)


def still_surfaces(labels: int) -> SurfaceStatistics:
    """Surfaces whose ribs do not wander and that do not slip."""
    return SurfaceStatistics.of_entries([{}] * labels)


def level_offsets_db(
    source: Any,
    embeddings: NDArray[np.float32],
    store: FakeStore,
    held_out: HeldOut,
    advance: Callable[[int], None] = lambda count: None,
) -> list[float]:
    """For each label, the level that the source generates over the recorded one in dB, in closed loop."""
    still = still_surfaces(len(store.labels))
    levels = closed_loop_levels(source, embeddings, store, still, held_out, advance)  # type: ignore[arg-type]
    return offsets_db(levels, len(store.labels))
