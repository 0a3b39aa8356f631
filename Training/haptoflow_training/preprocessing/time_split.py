"""Cuts one recording by time into training, validation and test, with gaps between the parts.

For labels with too few recordings to leave whole ones out. A recording is cut into rounds of about 10 s, each with a
part for training, one for validation and one for test, so that every split covers the whole recording. The gap between
two parts is as long as the previous waveform of a training pair: no sample belongs to two splits.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import dataclass

from haptoflow_training.preprocessing.pipeline import PreparedRecording
from haptoflow_training.preprocessing.settings import PreprocessingSettings
from haptoflow_training.preprocessing.split import SPLITS, Split, split_of
from haptoflow_training.recordings.recording import RecordingIdentity

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
) -> Collection[str]:
    """Labels for which the recordings' names alone leave a split empty."""
    splits = ((label, split_of(identity, settings, seed)) for label, identity in identities)
    return labels_without_a_split(splits, settings)
