"""Plans as a file of test vectors, which the Unity package must reproduce."""

from __future__ import annotations

import json
from dataclasses import asdict
from typing import Any

from haptoflow_training.studies.plans import SplitMix64, latency_plan, shuffled, similarity_plan, williams_design

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
