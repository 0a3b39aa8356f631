"""Assigns a recording to a split by its identity alone, so that adding or removing others does not move it.

Within one texture and protocol the conditions are spread over [0, 1) by an additive recurrence with irrational steps (a
low-discrepancy sequence) from a hashed offset, so that even a few recordings come close to the requested shares.
Repeats of one machine pass cross the same bumps of the same surface, so they share a split. Hand strokes all differ;
they are numbered by repeat.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

from haptoflow_training.preprocessing.pipeline import PreparedRecording
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


_ROUND_SECONDS = 10.0
# A training pair needs two segments; a split cannot use fewer.
_MINIMUM_SEGMENTS = {"train": 4, "validation": 2, "test": 2}


@dataclass(frozen=True)
class TimePart:
    """Samples [start, stop) of a prepared recording."""

    split: Split
    start: int
    stop: int


def time_parts(samples: int, settings: PreprocessingSettings) -> list[TimePart]:
    """The parts of a recording with so many samples; empty if it is too short to be cut."""
    guard = settings.segment_samples
    rounds = max(1, round(samples / (_ROUND_SECONDS * settings.sample_rate_hz)))
    shares = (settings.train_share, settings.validation_share, 1.0 - settings.train_share - settings.validation_share)
    parts: list[TimePart] = []
    for number in range(rounds):
        first, last = number * samples // rounds, (number + 1) * samples // rounds
        wanted = dict(zip(SPLITS, (max(0.0, share) * (last - first) for share in shares), strict=True))
        wanted = {split: length for split, length in wanted.items() if length > 0.0}
        for split, length in wanted.items():
            # The minimum for validation and test is taken from training.
            wanted[split] = max(length, _fewest(split, settings) + guard)
        wanted["train"] = last - first - sum(length for split, length in wanted.items() if split != "train")
        start = float(first)
        for split, length in wanted.items():
            stop = int(start + length) - guard
            if stop - int(start) < _fewest(split, settings):
                return []
            parts.append(TimePart(split, int(start), stop))
            start += length
    return parts


def _fewest(split: Split, settings: PreprocessingSettings) -> int:
    return _MINIMUM_SEGMENTS[split] * settings.segment_samples + 1


def cut(prepared: PreparedRecording, part: TimePart) -> PreparedRecording:
    """The samples of a part."""
    return prepared.part(slice(part.start, part.stop))


def labels_without_a_split(
    recordings: Iterable[tuple[str, Split]], settings: PreprocessingSettings
) -> list[str]:
    """From (label, split) of every recording: the labels that lack a split with a share above 0, in order."""
    wanted = {"train"}
    if settings.validation_share > 0.0:
        wanted.add("validation")
    if settings.train_share + settings.validation_share < 1.0 - 1e-9:
        wanted.add("test")
    found: dict[str, set[str]] = {}
    for label, split in recordings:
        found.setdefault(label, set()).add(split)
    return [label for label, splits in found.items() if wanted - splits]


def labels_to_cut(
    identities: Iterable[tuple[str, RecordingIdentity]], settings: PreprocessingSettings, seed: int
) -> list[str]:
    """Labels for which the recordings' names alone leave a split empty."""
    splits = ((label, split_of(identity, settings, seed)) for label, identity in identities)
    return labels_without_a_split(splits, settings)
