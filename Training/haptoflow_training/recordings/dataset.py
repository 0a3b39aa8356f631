"""The recordings of a folder or a file, with their labels and origin; samples are read on demand."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from haptoflow_training.recordings.cluster_dataset_files import DatasetFileError
from haptoflow_training.recordings.dataset_layout import PUBLISHED_SOURCE

if TYPE_CHECKING:
    from haptoflow_training.recordings.open_recordings import RecordingFile

UNKNOWN = "unknown"


@dataclass(frozen=True)
class Dataset:
    """The contents of `root`. unlabelled: complete recordings that no label names. problems: files that are missing or
    unusable; the rest stays usable. provenance: source, licence, synthetic. left_out: one printable line about the
    unlabelled recordings, empty if there are none. notes: a line for each thing that was ignored. textures: id to name,
    in the published layout. is_own: in no published layout."""

    root: Path
    recordings: tuple[RecordingFile, ...]
    unlabelled: tuple[RecordingFile, ...]
    problems: tuple[DatasetFileError, ...]
    provenance: dict[str, Any]
    left_out: str = ""
    notes: tuple[str, ...] = ()
    textures: dict[int, str] = field(default_factory=dict)
    audio_files: int = 0
    is_own: bool = False

    @property
    def synthetic(self) -> bool:
        return bool(self.provenance.get("synthetic"))

    @property
    def published(self) -> bool:
        """Whether these are recordings of the Cluster Haptic Texture Dataset, whose ids its labels file uses."""
        return is_published(self.provenance) and not self.is_own

    @property
    def labels(self) -> list[str]:
        """The labels that occur, in the order of the recordings."""
        return list(dict.fromkeys(entry.label for entry in self.recordings))

    @property
    def said(self) -> list[str]:
        """A printable line for each file and recording that is not used, and for each thing that was ignored."""
        left_out = [self.left_out] if self.left_out else []
        return [*(f"skipped: {problem}" for problem in self.problems), *self.notes, *left_out]

    def __iter__(self) -> Iterator[RecordingFile]:
        return iter(self.recordings)

    def __len__(self) -> int:
        return len(self.recordings)


def is_published(provenance: dict[str, Any]) -> bool:
    """Whether a folder's provenance is that of the published data set."""
    return bool(provenance.get("source") == PUBLISHED_SOURCE)
