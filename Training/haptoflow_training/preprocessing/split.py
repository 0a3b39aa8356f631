"""Assigns a recording to a split by its identity alone, so that adding or removing others does not move it.

Within one texture and protocol the conditions are spread over [0, 1) by an additive recurrence with irrational steps (a
low-discrepancy sequence) from a hashed offset, so that even a few recordings come close to the requested shares.
Repeats of one machine pass cross the same bumps of the same surface, so they share a split. Hand strokes all differ;
they are numbered by repeat.
"""

from __future__ import annotations

import hashlib
from typing import Literal

from haptoflow_training.preprocessing.settings import PreprocessingSettings
from haptoflow_training.recordings.recording import RecordingIdentity

Split = Literal["train", "validation", "test"]
SPLITS: tuple[Split, ...] = ("train", "validation", "test")

_GOLDEN = 0.6180339887498949
_DIRECTION_DEGREES, _SPEED_MMPS, _FORCE_MILLINEWTONS = 45, 10, 500
_SPEEDS_IN_GRID, _FORCES_IN_GRID = 5, 2


def split_of(identity: RecordingIdentity, settings: PreprocessingSettings, seed: int) -> Split:
    """Held-out directions and speeds (machine protocol) are always `test`."""
    if identity.protocol == "machine" and (
        identity.direction_degrees in settings.held_out_directions
        or identity.speed_mmps in settings.held_out_speeds_mmps
    ):
        return "test"
    place = (_hashed_offset(identity, seed) + _GOLDEN * _condition_number(identity)) % 1.0
    if place < settings.train_share:
        return "train"
    return "validation" if place < settings.train_share + settings.validation_share else "test"


def _hashed_offset(identity: RecordingIdentity, seed: int) -> float:
    stratum = f"split/{seed}/{identity.texture_id}/{identity.protocol}"
    if identity.protocol == "hand" and identity.repeat == 0:
        # Without a number in their names, all strokes would otherwise fall into the same place.
        stratum = f"split/{seed}/{identity.name}"
    digest = hashlib.blake2b(stratum.encode(), digest_size=8).digest()
    return int.from_bytes(digest, "little") / 2.0**64


def _condition_number(identity: RecordingIdentity) -> float:
    """A consecutive number over the published grid of directions, speeds and forces, or over hand strokes."""
    if identity.direction_degrees is None:
        return float(identity.repeat)
    direction = identity.direction_degrees / _DIRECTION_DEGREES
    speed = identity.speed_mmps / _SPEED_MMPS
    force = identity.force_millinewtons / _FORCE_MILLINEWTONS
    return (direction * _SPEEDS_IN_GRID + speed) * _FORCES_IN_GRID + force
