"""How often the ribs of a surface are found from seconds of strokes, on surfaces of the synthetic recorder."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from haptoflow_benchmark.few_shot.unseen import RIDE_SECONDS, make_rides, unseen_materials
from haptoflow_training.preprocessing.wave_vectors import WaveVector, estimate_wave_vectors
from haptoflow_training.recordings.synthetic import Material, load_materials

SECONDS = (10.0, 30.0)
CLOSE, NEAR = 0.02, 0.05
# The share of guided strokes (straight and even) against free ones; the labels are recorded with both.
_GUIDED, _FREE, _LABELS = 1.0, 0.3, 0.6
_GUIDED_SEEDS, _FREE_SEEDS, _PLAIN_SEEDS = (2026, 7, 8, 9, 10, 11), (2026, 8, 10), (2026, 7)
_MATERIALS_A_SEED = 10


@dataclass(frozen=True)
class StudySurface:
    """guided_share: of the strokes, 0 to 1."""

    name: str
    material: Material
    seed: int
    guided_share: float

    @property
    def vectors(self) -> NDArray[np.float64]:
        """[n, 2] in cycles per millimetre."""
        return np.array(self.material.wave_vectors_per_mm).reshape(-1, 2)


def study_surfaces() -> Iterator[StudySurface]:
    """30 ruled surfaces and 38 without ribs: unseen materials with guided and with free strokes, and every label."""
    labels = load_materials()
    for seed in _GUIDED_SEEDS:
        for material in unseen_materials(labels, _MATERIALS_A_SEED, seed):
            if material.rulings or seed in _PLAIN_SEEDS:
                yield StudySurface(f"{material.label}, draw {seed}, guided", material, seed, _GUIDED)
    for seed in _FREE_SEEDS:
        for material in unseen_materials(labels, _MATERIALS_A_SEED, seed):
            if material.rulings or seed == _FREE_SEEDS[1]:
                yield StudySurface(f"{material.label}, draw {seed}, free", material, seed + 1, _FREE)
    for material in labels:
        yield StudySurface(material.label, material, 5, _LABELS)


def measured(surfaces: Sequence[StudySurface], advance: Callable[[], None] = lambda: None) -> dict[str, Any]:
    """For each length of recording: families of ribs, how many are found within 2 and 5 %, and how many found
    vectors are wrong."""
    totals = {
        f"{seconds:g}": {"ruled_surfaces": 0, "families": 0, "within_2_percent": 0, "within_5_percent": 0,
                         "wrong_on_ruled": 0, "unruled_surfaces": 0, "wrong_on_unruled": 0}
        for seconds in SECONDS
    }  # fmt: skip
    found_by_surface = []
    for surface in surfaces:
        rides = make_rides(
            surface.material, surface.seed, round(max(SECONDS) / RIDE_SECONDS), guided_share=surface.guided_share
        )
        row: dict[str, Any] = {"name": surface.name, "wave_vectors_per_mm": np.round(surface.vectors, 4).tolist()}
        for seconds in SECONDS:
            found = estimate_wave_vectors(rides[: round(seconds / RIDE_SECONDS)])
            row[f"found_{seconds:g}"] = [list(each) for each in found]
            total = totals[f"{seconds:g}"]
            errors = [min((relative_error(each, vector) for each in found), default=np.inf) for vector in surface.vectors]
            wrong = sum(all(relative_error(each, vector) >= NEAR for vector in surface.vectors) for each in found)
            kind = "ruled" if len(surface.vectors) else "unruled"
            total[f"{kind}_surfaces"] += 1
            total[f"wrong_on_{kind}"] += wrong
            total["families"] += len(errors)
            total["within_2_percent"] += sum(error < CLOSE for error in errors)
            total["within_5_percent"] += sum(error < NEAR for error in errors)
        found_by_surface.append(row)
        advance()
    return {"totals": totals, "surfaces": found_by_surface}


def relative_error(found: WaveVector | NDArray[np.float64], vector: NDArray[np.float64]) -> float:
    """The distance from `found` to `vector` over the length of `vector`; opposite vectors describe the same ribs."""
    distance = min(float(np.linalg.norm(np.asarray(found) - sign * vector)) for sign in (1.0, -1.0))
    return distance / float(np.linalg.norm(vector))
