"""What the evaluation compares with: recordings that nobody trained on, each with a second, independent one.

Both of a pair follow the same motion on different places of a specimen that training never saw: the second, an
independent draw of the true process, is the ceiling that no generator can pass.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.evaluation.reference_conditions import Condition, conditions, is_on_other_label, motion_of
from haptoflow_training.preprocessing.pipeline import preprocess_recording
from haptoflow_training.preprocessing.settings import PreprocessingSettings
from haptoflow_training.recordings.synthetic import Material, load_materials, record_condition

_Floats = NDArray[np.float32]

_RATE_HZ = 2000
_INDEPENDENT_SEED = 100_000


@dataclass(frozen=True)
class ReferencePair:
    """recorded and independent [n] in m/s^2; motion [n, 3] of both."""

    condition: Condition
    recorded: _Floats
    independent: _Floats
    motion: _Floats


def _record(material: Material, motion: NDArray[np.float64], seed: int) -> _Floats:
    """One recording of the motion [n, 3] at 2 kHz, trimmed as every recording is."""
    recording = record_condition(
        material,
        velocity_mps=(motion[:, 0], motion[:, 1]),
        force_newtons=motion[:, 2],
        duration_seconds=len(motion) / _RATE_HZ,
        seed=seed,
    )
    return preprocess_recording(recording, PreprocessingSettings()).waveform_mps2


def record_pair(task: tuple[Condition, Material, Material]) -> tuple[_Floats, _Floats, _Floats]:
    """(recorded, independent, motion) of a condition on its material and, for a change, the other one."""
    condition, material, other = task
    trim = PreprocessingSettings().trim_seconds
    motion = motion_of(condition, material, trim)
    waves = [_record(material, motion, condition.seed + repeat) for repeat in (0, _INDEPENDENT_SEED)]
    lead = round(trim * _RATE_HZ)
    length = min(len(motion) - 2 * lead, *(len(wave) for wave in waves))
    if condition.kind == "change":
        elsewhere = is_on_other_label(length)
        for number, repeat in enumerate((0, _INDEPENDENT_SEED)):
            there = _record(other, motion, condition.seed + repeat)[:length]
            waves[number] = np.where(elsewhere, there, waves[number][:length])
    # The motion is known exactly here; the sensors' own noise on it is not what is asked about.
    return waves[0][:length], waves[1][:length], motion[lead : lead + length].astype(np.float32)


def reference_set(
    cache: Path, workers: int, advance: Callable[[int], None] = lambda count: None
) -> list[ReferencePair]:
    """Record all pairs, or read them from `cache` where they were made from the same materials and conditions."""
    materials = load_materials()
    wanted = conditions(materials)
    made_from = json.dumps([[asdict(entry) for entry in wanted], [asdict(entry) for entry in materials]])
    if cache.exists():
        with np.load(cache) as stored:
            if str(stored["made_from"]) == made_from:
                advance(len(wanted))
                return [
                    ReferencePair(entry, stored[f"recorded{i}"], stored[f"independent{i}"], stored[f"motion{i}"])
                    for i, entry in enumerate(wanted)
                ]
    pairs = []
    with ProcessPoolExecutor(max_workers=workers) as pool:
        tasks = [(entry, materials[entry.label_index], materials[entry.other_index]) for entry in wanted]
        for entry, waves in zip(wanted, pool.map(record_pair, tasks), strict=True):
            pairs.append(ReferencePair(entry, *waves))
            advance(1)
    cache.parent.mkdir(parents=True, exist_ok=True)
    arrays: dict[str, Any] = {"made_from": np.array(made_from)}
    for i, pair in enumerate(pairs):
        arrays |= {f"recorded{i}": pair.recorded, f"independent{i}": pair.independent, f"motion{i}": pair.motion}
    temporary = cache.with_suffix(".part.npz")
    np.savez(temporary, **arrays)
    temporary.replace(cache)
    return pairs
