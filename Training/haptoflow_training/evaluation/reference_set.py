"""What the evaluation compares with: recordings that nobody trained on, each with a second, independent one.

Both of a pair follow the same motion on different places of the surface: the second, an independent draw of the true
process, is the ceiling that no generator can pass.
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

from haptoflow_training.preprocessing.pipeline import preprocess_recording
from haptoflow_training.preprocessing.settings import PreprocessingSettings
from haptoflow_training.recordings.synthetic import (
    Material,
    hand_conditions,
    load_materials,
    record_condition,
    record_hand_condition,
)

_Floats = NDArray[np.float32]

# Neither the seeds nor, for the marked ones, the conditions are in any training store: 0.275 m/s and 1.35 N lie
# inside the bands that training leaves out, 225 degrees is the direction that it leaves out.
CONSTANT_SPEEDS_MPS = (0.03, 0.08, 0.15, 0.275, 0.5, 1.0, 1.5)
_FORCES_NEWTONS = (0.5, 1.35, 2.5)
_DIRECTIONS_DEGREES = (0.0, 225.0, 110.0)
# At 8 s, two recordings of the same condition agree to a GFC of 0.988 only: too low a ceiling.
_SECONDS = 24.0
_TRIM_SECONDS = 0.3
# The recorder's surfaces are periodic tiles. A line that is straight for metres meets the same few thousand waves again
# and again: both recordings of a pair would have the same lines, every few hertz, that no real surface has. A slow turn
# spreads them. Ruled surfaces are crossed straight, since there the direction is the pitch.
_TURN_DEGREES = 30.0
_HAND_SEED = 4003
_SEED = 9000


@dataclass(frozen=True)
class Condition:
    """kind: `constant` or `varying`. turn_degrees: how far the direction turns over the recording, half before and half
    after direction_degrees. expected_fundamental_hz: 0 where the label is not periodic or its fundamental lies outside
    20-800 Hz."""

    label: str
    label_index: int
    kind: str
    speed_mps: float
    force_newtons: float
    direction_degrees: float
    turn_degrees: float
    expected_fundamental_hz: float
    seed: int


@dataclass(frozen=True)
class ReferencePair:
    """recorded and independent [n] in m/s^2; motion [n, 3] of the recorded one."""

    condition: Condition
    recorded: _Floats
    independent: _Floats
    motion: _Floats


def conditions(materials: tuple[Material, ...], strokes_per_label: int = 1) -> list[Condition]:
    """Seven constant conditions and `strokes_per_label` hand strokes for each label."""
    chosen = []
    for index, material in enumerate(materials):
        for number, speed in enumerate(CONSTANT_SPEEDS_MPS):
            force = _FORCES_NEWTONS[(index + number) % len(_FORCES_NEWTONS)]
            direction = _DIRECTIONS_DEGREES[number % len(_DIRECTIONS_DEGREES)]
            fundamental, turn = 0.0, _TURN_DEGREES
            if ruling := material.dominant_ruling:
                # Across the ribs, where a fundamental can be told at all.
                direction, turn = ruling.direction_degrees, 0.0
                fundamental = 1000.0 * speed / ruling.wavelength_mm
            in_band = 20.0 < fundamental < 800.0
            chosen.append(
                Condition(
                    material.label, index, "constant", speed, force, direction, turn,
                    fundamental if in_band else 0.0, _SEED + number,
                )
            )  # fmt: skip
        for stroke in range(strokes_per_label):
            chosen.append(Condition(material.label, index, "varying", 0.0, 0.0, 0.0, 0.0, 0.0, stroke))
    return chosen


def _prepared(recording: Any) -> tuple[_Floats, _Floats]:
    prepared = preprocess_recording(recording, PreprocessingSettings())
    return prepared.waveform_mps2, prepared.motion


def _velocity_mps(condition: Condition, count: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """(vx, vy) of a constant condition at `count` moments, evenly spaced over the recording."""
    half = 0.5 * condition.turn_degrees
    heading = np.radians(condition.direction_degrees + np.linspace(-half, half, count))
    return condition.speed_mps * np.cos(heading), condition.speed_mps * np.sin(heading)


def _record_pair(task: tuple[Material, Condition, int]) -> tuple[_Floats, _Floats, _Floats]:
    material, condition, strokes = task
    if condition.kind == "varying":
        identity = hand_conditions(material, seed=_HAND_SEED, recordings=strokes)[condition.seed]
        stroke = record_hand_condition(material, identity, seed=_HAND_SEED, duration_seconds=_SECONDS)
        recorded, motion = _prepared(stroke)
        again = record_condition(
            material,
            velocity_mps=(motion[:, 0], motion[:, 1]),
            force_newtons=np.maximum(motion[:, 2], 0.0),
            duration_seconds=len(motion) / 2000.0,
            seed=condition.seed,
        )
        # The same trim as any recording's, so the second is shorter; both are cut to what they share.
        independent, _ = _prepared(again)
        lead = round(_TRIM_SECONDS * 2000)
        recorded, motion = recorded[lead : lead + len(independent)], motion[lead : lead + len(independent)]
        return recorded, independent[: len(recorded)], motion
    velocity = _velocity_mps(condition, round(1000.0 * _SECONDS))
    pair = [
        _prepared(
            record_condition(
                material,
                velocity_mps=velocity,
                force_newtons=condition.force_newtons,
                duration_seconds=_SECONDS + 2 * _TRIM_SECONDS,
                seed=condition.seed + 100 * repeat,
            )
        )
        for repeat in range(2)
    ]
    length = min(len(pair[0][0]), len(pair[1][0]))
    # The motion is known exactly here; the sensors' own noise on it is not what is asked about.
    force = np.full(length, condition.force_newtons)
    motion = np.stack([*_velocity_mps(condition, length), force], axis=1).astype(np.float32)
    return pair[0][0][:length], pair[1][0][:length], motion


def reference_set(
    cache: Path, workers: int, advance: Callable[[int], None] = lambda count: None, strokes_per_label: int = 1
) -> list[ReferencePair]:
    """Record all pairs, or read them from `cache` where they were made from the same materials and conditions."""
    materials = load_materials()
    wanted = conditions(materials, strokes_per_label)
    made_from = json.dumps([[asdict(entry) for entry in wanted], [asdict(entry) for entry in materials]])
    if cache.exists():
        with np.load(cache) as stored:
            if str(stored["made_from"]) == made_from:
                advance(len(wanted))
                return [
                    ReferencePair(entry, stored[f"recorded{i}"], stored[f"independent{i}"], stored[f"motion{i}"])
                    for i, entry in enumerate(wanted)
                ]
    by_label = {material.label: material for material in materials}
    pairs = []
    with ProcessPoolExecutor(max_workers=workers) as pool:
        tasks = [(by_label[entry.label], entry, strokes_per_label) for entry in wanted]
        for entry, waves in zip(wanted, pool.map(_record_pair, tasks), strict=True):
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
