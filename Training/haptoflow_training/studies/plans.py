"""The order of a study's trials, from participant and seed; identical to the Unity package's HaptoFlow.Studies."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

PRACTICE = "practice"
MAIN = "main"
TURN_ON = "turn-on"
TURN_OFF = "turn-off"
CONDITIONS = (TURN_ON, TURN_OFF)
_MASK = (1 << 64) - 1


class SplitMix64:
    """Steele, Lea and Flood (2014), Fast splittable pseudorandom number generators: 64 bits a step."""

    def __init__(self, seed: int) -> None:
        self._state = seed & _MASK

    def next(self) -> int:
        """From 0 to 2^64 - 1."""
        self._state = (self._state + 0x9E3779B97F4A7C15) & _MASK
        value = self._state
        value = ((value ^ (value >> 30)) * 0xBF58476D1CE4E5B9) & _MASK
        value = ((value ^ (value >> 27)) * 0x94D049BB133111EB) & _MASK
        return value ^ (value >> 31)


def shuffled(count: int, seed: int) -> list[int]:
    """A permutation of 0 to count - 1, determined by the seed (Fisher and Yates, from the end)."""
    random = SplitMix64(seed)
    order = list(range(count))
    for index in range(count - 1, 0, -1):
        other = random.next() % (index + 1)
        order[index], order[other] = order[other], order[index]
    return order


def williams_design(count: int) -> list[list[int]]:
    """Rows in which each treatment occurs once at each place and follows each other treatment equally often.

    Williams (1949), Experimental designs balanced for the estimation of residual effects of treatments: `count` rows
    for an even count, twice as many for an odd one.
    """
    if count < 1:
        raise ValueError(f"count {count}: expected 1 or more")
    zigzag = [(step + 1) // 2 if step % 2 else (count - step // 2) % count for step in range(count)]
    rows = [[(entry + shift) % count for entry in zigzag] for shift in range(count)]
    return rows if count % 2 == 0 or count == 1 else rows + [row[::-1] for row in rows]


@dataclass(frozen=True)
class LatencyTrial:
    """delay_ms: the planned total delay, from the hand's movement to the vibration's."""

    trial: int
    block: str
    condition: str
    delay_ms: float


@dataclass(frozen=True)
class SimilarityTrial:
    trial: int
    block: str
    material: str
    method: str


def latency_plan(participant: int, seed: int, levels_ms: Sequence[float]) -> list[LatencyTrial]:
    """Four practice trials, then every level under one condition and every level under the other.

    participant: from 1. Odd participants begin with turn-on, even ones with turn-off. Each level occurs equally often
    at each place of each condition once every row of the levels' design has been used.
    """
    names = shuffled(len(levels_ms), seed)
    rows = williams_design(len(levels_ms))
    first_row = (participant - 1) % len(rows)
    # Participants who begin with the same condition share a parity, so they take every second row; an even step leaves
    # the others to the other participants.
    half = len(rows) // 2
    step = half + half % 2
    conditions = CONDITIONS if participant % 2 == 1 else CONDITIONS[::-1]
    order = [(PRACTICE, condition, level) for condition in conditions for level in (min(levels_ms), max(levels_ms))]
    for block, condition in enumerate(conditions):
        row = rows[(first_row + block * step) % len(rows)]
        order += [(MAIN, condition, levels_ms[names[entry]]) for entry in row]
    return [LatencyTrial(place, *entry) for place, entry in enumerate(order, start=1)]


def similarity_plan(
    participant: int, seed: int, materials: Sequence[str], methods: Sequence[str]
) -> list[SimilarityTrial]:
    """Each method once on the first material for practice, then each material with all methods one after another.

    participant: from 1. The order of materials changes with each participant. The order of methods changes once the
    participants have used every order of materials, so that each method comes equally often at each place of each
    material.
    """
    material_rows = williams_design(len(materials))
    method_rows = williams_design(len(methods))
    material_names = shuffled(len(materials), seed)
    order = [(PRACTICE, materials[0], method) for method in methods]
    round_of_materials, material_row = divmod(participant - 1, len(material_rows))
    for place, entry in enumerate(material_rows[material_row]):
        material = material_names[entry]
        method_names = shuffled(len(methods), seed + 1 + material)
        row = method_rows[(round_of_materials + place) % len(method_rows)]
        order += [(MAIN, materials[material], methods[method_names[method]]) for method in row]
    return [SimilarityTrial(place, *words) for place, words in enumerate(order, start=1)]


FORMAT = "haptoflow study plans"
VERSION = 1
PARTICIPANTS = (1, 2, 7, 24)
SEEDS = (1, 2**63 + 5)
LEVELS_MS = (tuple(range(50, 251, 20)), (50, 110, 170, 230))
MATERIALS_AND_METHODS = (
    (("ceramic", "jute", "wood", "plastic", "fur", "metal"), ("haptoflow", "transformer", "dstn", "spsi")),
    (("jute", "wood", "fur"), ("haptoflow", "dstn", "spsi")),
    (("wood", "metal"), ("draft", "standard", "sketch", "transformer", "dstn", "spsi")),
)
_RANDOM_VALUES = 8
_SHUFFLES = (1, 2, 4, 11)
_DESIGNS = (1, 2, 3, 4, 5, 6, 11)


def golden_plans() -> dict[str, list[dict[str, Any]]]:
    """The plans of several participants, seeds and sizes."""
    return {
        "random": [{"seed": seed, "values": _random(seed)} for seed in SEEDS],
        "shuffles": [
            {"count": count, "seed": seed, "order": shuffled(count, seed)} for count in _SHUFFLES for seed in SEEDS
        ],
        "williams": [{"count": count, "rows": williams_design(count)} for count in _DESIGNS],
        "latency": [
            {
                "participant": participant,
                "seed": seed,
                "levels_ms": list(levels),
                "plan": [asdict(trial) for trial in latency_plan(participant, seed, levels)],
            }
            for levels in LEVELS_MS
            for seed in SEEDS
            for participant in PARTICIPANTS
        ],
        "similarity": [
            {
                "participant": participant,
                "seed": seed,
                "materials": list(materials),
                "methods": list(methods),
                "plan": [asdict(trial) for trial in similarity_plan(participant, seed, materials, methods)],
            }
            for materials, methods in MATERIALS_AND_METHODS
            for seed in SEEDS
            for participant in PARTICIPANTS
        ],
    }


def golden_text() -> str:
    """JSON with one case a line, so that a diff shows which cases changed."""
    lists = [
        f'  "{name}": [\n' + ",\n".join("    " + json.dumps(entry) for entry in entries) + "\n  ]"
        for name, entries in golden_plans().items()
    ]
    return f'{{"format": "{FORMAT}", "version": {VERSION},\n' + ",\n".join(lists) + "\n}\n"


def _random(seed: int) -> list[int]:
    random = SplitMix64(seed)
    return [random.next() for _ in range(_RANDOM_VALUES)]
