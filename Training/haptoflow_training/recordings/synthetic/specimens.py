"""Specimens of a material: pieces with the same label that differ in everything random.

Another specimen has another random surface, other asperities and another jitter of the ribs, and is a little louder or
softer, brighter or duller (SpecimenSpread). Calibrated values and ribs (wavelength, direction, profile, place) are the same.
One specimen is held out: its level and tilt are the label's, and no training protocol records it, only the evaluation
does. Further specimens are for figures between two pieces.
"""

from __future__ import annotations

from dataclasses import dataclass
from statistics import NormalDist

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.recordings.recording import RecordingIdentity
from haptoflow_training.recordings.synthetic.materials import Material
from haptoflow_training.recordings.synthetic.surface import RandomField

TRAINING_SPECIMENS = (0, 1, 2, 3, 4, 5, 6, 7)
HELD_OUT_SPECIMEN = 8
FURTHER_SPECIMENS = (9, 10, 11, 12)
# The steps of the machine protocol.
_DEGREES, _MMPS, _MILLINEWTONS = 45, 10, 500


def training_specimen(identity: RecordingIdentity) -> int:
    """The specimen that the training protocols record under this identity, one of TRAINING_SPECIMENS.

    Hand recordings cycle through the specimens by repeat; each cycle begins one earlier than the cycle before, so that
    conditions that recur every second, fourth or seventh time meet all specimens. Machine recordings move on by
    direction, speed, force and repeat together, so that each direction, speed and force meets several specimens, and
    repeats of a pass are on different ones.
    """
    count = len(TRAINING_SPECIMENS)
    if identity.direction_degrees is None:
        return TRAINING_SPECIMENS[(identity.repeat - identity.repeat // count) % count]
    place = identity.direction_degrees // _DEGREES + identity.speed_mmps // _MMPS
    place += 2 * (identity.force_millinewtons // _MILLINEWTONS) + 3 * identity.repeat
    return TRAINING_SPECIMENS[place % count]


# The number of the places' random field, beyond those of octaves and features.
_PLACE_LEVEL = 400
_PLACE_WAVELENGTH_MM = 60.0
_FURTHEST_SCORE = 2.0
# Numbers of the random draws, beyond those of the recorder's other generators.
_TRAINING_ORDER, _FURTHER_SCORES = 30, 31


@dataclass(frozen=True)
class SpecimenCharacter:
    """A specimen's difference from its label: level in dB, and spectral tilt in dB per octave around 100 Hz."""

    level_db: float
    tilt_db_per_octave: float


def character_of(material: Material, specimen: int) -> SpecimenCharacter:
    """The character of a specimen, 0 or more. That of the held-out specimen is typical: zero."""
    level, tilt = _scores(material.surface_seed, specimen)
    return SpecimenCharacter(material.specimen_spread_db * level, material.specimen_tilt_db_per_octave * tilt)


def _scores(surface_seed: int, specimen: int) -> tuple[float, float]:
    """Standard scores of level and tilt."""
    if specimen == HELD_OUT_SPECIMEN:
        return 0.0, 0.0
    count = len(TRAINING_SPECIMENS)
    if specimen in TRAINING_SPECIMENS:
        # Two orders, so that a louder specimen is not always a brighter one.
        rng = np.random.default_rng([surface_seed, _TRAINING_ORDER])
        level, tilt = (int(rng.permutation(count)[specimen]) for _ in range(2))
        return NormalDist().inv_cdf((level + 0.5) / count), NormalDist().inv_cdf((tilt + 0.5) / count)
    drawn = np.random.default_rng([surface_seed, specimen, _FURTHER_SCORES]).standard_normal(2)
    level_score, tilt_score = np.clip(drawn, -_FURTHEST_SCORE, _FURTHEST_SCORE)
    return float(level_score), float(tilt_score)


def surface_gain(material: Material, position_mm: NDArray[np.float64], specimen: int) -> NDArray[np.float64]:
    """The factor on the vibration at each position [n, 2]: the specimen's level, and its slow change with the place."""
    level_db = np.full(len(position_mm), character_of(material, specimen).level_db)
    if material.place_spread_db > 0.0:
        field = RandomField(material.surface_seed, specimen, _PLACE_LEVEL, _PLACE_WAVELENGTH_MM)
        level_db += material.place_spread_db * field.at(position_mm)
    return 10.0 ** (level_db / 20.0)
