"""Bands of speed, force and direction that are held out of training for the evaluation. Training batches, level
calibration, seed bank and exponents all exclude them through this module."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.training.config import BatchConfig

# Below this speed the tip counts as resting: its direction would be sensor noise.
_MINIMUM_MOVING_SPEED_MPS = 0.002


@dataclass(frozen=True)
class HeldOut:
    """Bands [from, to), empty for none. direction_degrees: counter-clockwise from the surface's first axis, as the
    velocity (vx, vy) itself; `from` may be negative for a band around 0. A resting tip has no direction."""

    speed_mps: tuple[float, ...] = ()
    force_newtons: tuple[float, ...] = ()
    direction_degrees: tuple[float, ...] = ()

    @classmethod
    def of(cls, config: BatchConfig) -> HeldOut:
        return cls(
            config.held_out_speed_mps, config.held_out_force_newtons, config.held_out_direction_degrees
        )

    def holds(self, motion: NDArray[np.floating]) -> NDArray[np.bool_]:
        """Which motions [..., 3] (vx, vy in m/s, force in N) lie in a band."""
        speed = np.hypot(motion[..., 0], motion[..., 1])
        held = np.zeros(speed.shape, dtype=np.bool_)
        for values, band in ((speed, self.speed_mps), (motion[..., 2], self.force_newtons)):
            if band:
                held |= (values >= band[0]) & (values < band[1])
        if self.direction_degrees:
            low, high = self.direction_degrees
            direction = np.degrees(np.arctan2(motion[..., 1], motion[..., 0]))
            held |= (np.mod(direction - low, 360.0) < high - low) & (speed >= _MINIMUM_MOVING_SPEED_MPS)
        return held


@dataclass(frozen=True)
class ClearSpans:
    """Stretches of recordings outside all bands: their starts in the store, their lengths, and the indices of their
    recordings in the given list (ascending)."""

    starts: NDArray[np.int64]
    lengths: NDArray[np.int64]
    owners: NDArray[np.int64]


def clear_spans(
    motion: NDArray[np.float32], starts: NDArray[np.int64], lengths: NDArray[np.int64], held_out: HeldOut
) -> ClearSpans:
    """The clear spans of recordings that begin at `starts` in the store's motion [n, 3] and are `lengths` long."""
    found: list[tuple[NDArray[np.int64], NDArray[np.int64]]] = []
    for start, length in zip(starts, lengths, strict=True):
        held = held_out.holds(motion[start : start + length])
        edges = np.flatnonzero(np.diff(np.concatenate([[True], held, [True]]).astype(np.int8)))
        found.append((start + edges[::2], edges[1::2] - edges[::2]))
    owners = np.repeat(np.arange(len(found)), [len(begin) for begin, _ in found])
    nothing = np.zeros(0, dtype=np.int64)
    return ClearSpans(
        np.concatenate([begin for begin, _ in found] or [nothing]).astype(np.int64),
        np.concatenate([long for _, long in found] or [nothing]).astype(np.int64),
        owners.astype(np.int64),
    )
