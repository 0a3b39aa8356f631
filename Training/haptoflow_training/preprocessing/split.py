"""Assigns a recording to a split by its identity alone, so that adding or removing others does not move it.

Within one texture and protocol the conditions are spread over [0, 1) by an additive recurrence with irrational steps (a
low-discrepancy sequence) from a hashed offset, so that even a few recordings come close to the requested shares.
Repeats of one machine pass cross the same bumps of the same surface, so they share a split. Hand strokes all differ;
they are numbered by repeat.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from typing import Literal

from haptoflow_training.preprocessing.settings import SETTINGS
from haptoflow_training.recordings.recording import RecordingIdentity

Split = Literal["train", "validation", "test"]
SPLITS: tuple[Split, ...] = ("train", "validation", "test")

_GOLDEN = 0.6180339887498949
_DIRECTION_DEGREES, _SPEED_MMPS, _FORCE_MILLINEWTONS = 45, 10, 500
_SPEEDS_IN_GRID, _FORCES_IN_GRID = 5, 2


def split_of(identity: RecordingIdentity, seed: int) -> Split:
    place = (_hashed_offset(identity, seed) + _GOLDEN * _condition_number(identity)) % 1.0
    if place < SETTINGS.train_share:
        return "train"
    return "validation" if place < SETTINGS.train_share + SETTINGS.validation_share else "test"


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


_ROUND_SECONDS = 10.0
# A training pair needs two segments; a split cannot use fewer.
_MINIMUM_SEGMENTS = {"train": 4, "validation": 2, "test": 2}


def time_parts(samples: int) -> list[tuple[Split, slice]]:
    """The parts of a prepared recording with so many samples; empty if it is too short to be cut."""
    guard = SETTINGS.segment_samples
    rounds = max(1, round(samples / (_ROUND_SECONDS * SETTINGS.sample_rate_hz)))
    shares: dict[Split, float] = {
        "train": SETTINGS.train_share,
        "validation": SETTINGS.validation_share,
        "test": 1.0 - SETTINGS.train_share - SETTINGS.validation_share,
    }
    parts: list[tuple[Split, slice]] = []
    for number in range(rounds):
        first, last = number * samples // rounds, (number + 1) * samples // rounds
        # The minimum for validation and test is taken from training.
        wanted = {split: max(share * (last - first), _fewest(split) + guard) for split, share in shares.items()}
        wanted["train"] = last - first - sum(length for split, length in wanted.items() if split != "train")
        start = float(first)
        for split, length in wanted.items():
            stop = int(start + length) - guard
            if stop - int(start) < _fewest(split):
                return []
            parts.append((split, slice(int(start), stop)))
            start += length
    return parts


def _fewest(split: Split) -> int:
    return _MINIMUM_SEGMENTS[split] * SETTINGS.segment_samples + 1


def labels_without_a_split(recordings: Iterable[tuple[str, Split]]) -> list[str]:
    """From (label, split) of every recording: the labels that lack a split, in order."""
    found: dict[str, set[Split]] = {}
    for label, split in recordings:
        found.setdefault(label, set()).add(split)
    return [label for label, splits in found.items() if len(splits) < len(SPLITS)]
