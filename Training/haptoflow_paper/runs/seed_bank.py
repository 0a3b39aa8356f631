"""The seed bank of a model without a skeleton: recorded waveforms from which the first previous waveform of a touch is
retrieved.

HaptoFlow (paper, section 4.1): when the buffer is empty, a waveform with matching conditions is retrieved from the
training recordings.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.export.recorded_windows import RecordedWindows, draw_windows
from haptoflow_training.preprocessing.store import SegmentStore
from haptoflow_training.training.held_out import HeldOut

SEED_SAMPLES = 400
_SPEEDS_MPS = (0.008, 0.02, 0.04, 0.07, 0.12, 0.2, 0.35, 0.6, 0.9, 1.3)
_FORCES_NEWTONS = (0.4, 1.2, 3.0)
_FARTHEST = 0.5


@dataclass(frozen=True)
class SeedBank:
    """waves [N, 400], each of RMS 1. entries: label, velocity_mps and force_newtons of each row, and for labels with
    ribs rib_phase: turns along each wave vector at sample 200, the first one that is played."""

    waves: NDArray[np.float32]
    entries: list[dict[str, object]]


def _condition_distance(windows: RecordedWindows, speed_mps: float, force_newtons: float) -> NDArray[np.float64]:
    return np.sqrt(
        np.square(np.log((windows.speed_mps + 0.002) / (speed_mps + 0.002)))
        + np.square(0.5 * np.log((windows.motion[:, 2] + 0.05) / (force_newtons + 0.05)))
        + np.square(windows.unsteadiness)
    )


def build_seed_bank(
    store: SegmentStore, wave_numbers: NDArray[np.float32], *, seed: int, held_out: HeldOut, candidates: int = 3000
) -> SeedBank:
    """For every label, the steadiest recorded window nearest to each point of a grid of speeds and forces.

    Grid points without a nearby window outside the held-out bands are left out; each label keeps at least its steadiest
    window. wave_numbers [labels, 4]: k1x, k1y, k2x, k2y of each label's ribs in cycles per millimetre, 0 for none.
    """
    waves: list[NDArray[np.float32]] = []
    entries: list[dict[str, object]] = []
    for index, label in enumerate(store.labels):
        windows = draw_windows(store, index, samples=SEED_SAMPLES, count=candidates, seed=seed, held_out=held_out)
        chosen: set[int] = set()
        for speed_mps in _SPEEDS_MPS:
            for force_newtons in _FORCES_NEWTONS:
                distance = _condition_distance(windows, speed_mps, force_newtons)
                nearest = int(distance.argmin())
                if distance[nearest] < _FARTHEST:
                    chosen.add(nearest)
        if not chosen:
            chosen.add(int(_condition_distance(windows, 0.06, 1.0).argmin()))
        for row in sorted(chosen):
            wave = windows.waves[row]
            rms = float(np.sqrt(np.square(wave, dtype=np.float64).mean()))
            if rms <= 0.0:
                continue
            waves.append((wave / rms).astype(np.float32))
            entry: dict[str, object] = {
                "label": label,
                "velocity_mps": [round(float(value), 5) for value in windows.motion[row, :2]],
                "force_newtons": round(float(windows.motion[row, 2]), 4),
            }
            wave_vectors = wave_numbers[index].astype(np.float64).reshape(2, 2)
            if wave_vectors.any():
                turns = np.mod(wave_vectors @ windows.position_mm[row].astype(np.float64), 1.0)
                # Rounding could lift a phase just below one turn to 1, which is out of range.
                entry["rib_phase"] = [round(float(turn), 5) % 1.0 for turn in turns]
            entries.append(entry)
    return SeedBank(np.stack(waves), entries)
