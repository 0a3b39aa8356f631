"""Materials unknown to every model, and rides over them: between two labels of the recorder, with tool modes and ribs of their own.

Drawn from a seed and used as drawn. The kinds of surface (ribs, impacts, stick-slip, a nap) alternate, so that a dozen
materials contain each.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import fields, replace

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.preprocessing.pipeline import preprocess_recording
from haptoflow_training.preprocessing.settings import SETTINGS
from haptoflow_training.recordings.native_recording import MaterialRecording, WaveVector
from haptoflow_training.recordings.recording import RecordingIdentity
from haptoflow_training.recordings.synthetic import record_condition_of
from haptoflow_training.recordings.synthetic.materials import Calibrated, Material
from haptoflow_training.recordings.synthetic.surface import TRAINING_SPECIMENS

# The first of the two labels that a material lies between; the other one is drawn.
_SORTS = (
    "wood", "concrete", "corduroy", "rubber", "ceramic", "metal mesh",
    "cardboard", "sandpaper", "jute", "leather", "metal", "stone", "carpet", "glass",
)  # fmt: skip
_SHARE = (0.3, 0.7)
# Median speed (mm/s) and force (mN) of each ride in turn, so that even few seconds hold slow and fast motion.
_RIDES = ((35, 800), (100, 1200), (22, 1400), (70, 600), (150, 1000), (48, 900))
RIDE_SECONDS = 5.0
# A wave vector that is found within this share of its length is right.
CLOSE = 0.02
_MODE_HZ, _MODE_DB, _MODE_Q = (110.0, 850.0), (-8.0, 9.0), (1.2, 6.0)


def unseen_materials(materials: Sequence[Material], count: int, seed: int) -> tuple[Material, ...]:
    """`count` materials, named `unseen-01` on, with texture ids from 1000 on, so that no recording's seed recurs."""
    known = {material.label: material for material in materials}
    made = []
    for number in range(count):
        rng = np.random.default_rng([seed, number])
        first = known[_SORTS[number % len(_SORTS)]]
        plain = [other for other in materials if other.label != first.label and not other.rulings]
        made.append(_between(rng, number, first, plain[int(rng.integers(len(plain)))]))
    return tuple(made)


def _between(rng: np.random.Generator, number: int, first: Material, other: Material) -> Material:
    share = float(rng.uniform(*_SHARE))

    def mixed(one: float, two: float) -> float:
        if one > 0.0 and two > 0.0:
            return math.exp((1.0 - share) * math.log(one) + share * math.log(two))
        return (1.0 - share) * one + share * two

    calibrated = Calibrated(
        **{
            each.name: mixed(getattr(first.calibrated, each.name), getattr(other.calibrated, each.name))
            for each in fields(Calibrated)
        }
    )
    modes = tuple(
        (float(np.exp(rng.uniform(*np.log(_MODE_HZ)))), float(rng.uniform(*_MODE_DB)), float(rng.uniform(*_MODE_Q)))
        for _ in range(int(rng.integers(1, 3)))
    )
    turned, stretched = float(rng.uniform(0.0, 180.0)), float(np.exp(rng.uniform(-0.4, 0.4)))
    rulings = tuple(
        replace(
            each,
            direction_degrees=(each.direction_degrees + turned) % 180.0,
            wavelength_mm=each.wavelength_mm * stretched,
        )
        for each in first.rulings
    )
    return replace(
        first,
        label=f"unseen-{number + 1:02d}",
        texture_id=1000 + number,
        category="unseen",
        friction=mixed(first.friction, other.friction),
        stiffness_newtons_per_metre=mixed(first.stiffness_newtons_per_metre, other.stiffness_newtons_per_metre),
        calibrated=calibrated,
        surface_seed=50_000 + number,
        tip_patch_mm=mixed(first.tip_patch_mm, other.tip_patch_mm),
        contact_damping=mixed(first.contact_damping, other.contact_damping),
        tool_modes=modes,
        rulings=rulings,
        impact_strength=first.impact_strength * float(rng.uniform(0.7, 1.3)),
        impact_spacing_mm=first.impact_spacing_mm * float(rng.uniform(0.7, 1.5)),
        stick_slip_length_mm=first.stick_slip_length_mm * float(rng.uniform(0.7, 1.4)),
    )


def make_rides(
    material: Material, seed: int, count: int, *, guided_share: float = 1.0
) -> tuple[MaterialRecording, ...]:
    """`count` rides of 5 s in the recorder's frame, alternately slow and fast, light and firm."""
    rides = []
    for number in range(count):
        speed, force = _RIDES[number % len(_RIDES)]
        ride = record_condition_of(
            material,
            RecordingIdentity(material.texture_id, None, speed, force, number),
            seed=seed,
            duration_seconds=RIDE_SECONDS + 2.0 * SETTINGS.trim_seconds + 0.05,
            guided_share=guided_share,
            specimen=TRAINING_SPECIMENS[number % len(TRAINING_SPECIMENS)],
        )
        prepared = preprocess_recording(ride)
        rides.append(MaterialRecording(prepared.waveform_mps2, prepared.motion))
    return tuple(rides)


def relative_error(found: WaveVector | NDArray[np.float64], vector: NDArray[np.float64]) -> float:
    """The distance from `found` to `vector` over the length of `vector`; opposite vectors describe the same ribs."""
    distance = min(float(np.linalg.norm(np.asarray(found) - sign * vector)) for sign in (1.0, -1.0))
    return distance / float(np.linalg.norm(vector))
