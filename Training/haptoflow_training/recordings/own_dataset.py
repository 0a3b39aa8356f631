"""A folder of a user's own recordings as a data set, with labels and origin."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from haptoflow_training.errors import InputError
from haptoflow_training.recordings.cluster_dataset import UNKNOWN, DatasetProblem
from haptoflow_training.recordings.cluster_dataset_files import DatasetFileError
from haptoflow_training.recordings.file_names import ending_of
from haptoflow_training.recordings.labels import LabelMap
from haptoflow_training.recordings.own_files import OWN_ENDINGS, OwnRecordingFile, is_motion_file, own_identity


@dataclass(frozen=True)
class OwnDataset:
    """The contents of `root`, with the members of ClusterDataset. textures: the names that sidecars use as labels.

    notes: a line for each thing that was ignored. problems: unusable files.
    """

    root: Path
    recordings: tuple[OwnRecordingFile, ...]
    unlabelled: tuple[OwnRecordingFile, ...]
    problems: tuple[DatasetProblem, ...] = field(default=())
    notes: tuple[str, ...] = field(default=())
    audio_files: int = 0
    synthetic: bool = False
    published: bool = False

    @property
    def provenance(self) -> dict[str, Any]:
        """The distinct values that the sidecars state."""
        files = [*self.recordings, *self.unlabelled]
        said = [self.origin_of(file)[::-1] for file in files]
        sources, licences = (list(dict.fromkeys(words)) for words in zip(*said, strict=True)) if said else ([], [])
        return {
            "source": ", ".join(sources) or UNKNOWN,
            "licence": ", ".join(licences) or UNKNOWN,
            "synthetic": False,
        }

    def origin_of(self, entry: OwnRecordingFile) -> tuple[str, str]:
        """(licence, source) of one recording."""
        return entry.description.licence or UNKNOWN, entry.description.source or UNKNOWN

    @property
    def left_out(self) -> str:
        """One printable line about the recordings that no label names; empty if there are none."""
        if not self.unlabelled:
            return ""
        nameless = [entry.identity.name for entry in self.unlabelled if not entry.label]
        named = dict.fromkeys(entry.label for entry in self.unlabelled if entry.label)
        reasons = [f"no sidecar has a key 'label' for {', '.join(nameless)}"] if nameless else []
        reasons += [f"no label of the labels file names {', '.join(named)}"] if named else []
        return f"{self.root}: {len(self.unlabelled)} recordings are left out: {'; '.join(reasons)}"

    @property
    def labels(self) -> list[str]:
        return list(dict.fromkeys(entry.label for entry in self.recordings))

    def __iter__(self) -> Iterator[OwnRecordingFile]:
        return iter(self.recordings)

    def __len__(self) -> int:
        return len(self.recordings)


def open_own_dataset(root: Path, labels: LabelMap | None = None) -> OwnDataset:
    """Index a folder with its subfolders, or one file; reads sidecars and headings, but no samples.

    Without `labels` a recording's label is the one in its sidecar. InputError if the path does not exist or holds no
    recording.
    """
    files = _files(root)
    complete: list[OwnRecordingFile] = []
    unlabelled: list[OwnRecordingFile] = []
    problems: list[DatasetProblem] = []
    notes: list[str] = []
    base = root.parent if root.is_file() else root
    motions = _named_motions(files)
    for path in files:
        if is_motion_file(path) or path.resolve() in motions:
            continue
        name = path.relative_to(base).as_posix()
        entry = OwnRecordingFile(path, own_identity(name), "")
        try:
            said = entry.description.label
            notes.extend(entry.description.notes)
        except DatasetFileError as error:
            problems.append(DatasetProblem(error.path, error.found, error.expected))
            continue
        label = said if labels is None else labels.label_of(-1, said) if said else None
        file = OwnRecordingFile(path, own_identity(name), label or said)
        (complete if label else unlabelled).append(file)
    return OwnDataset(root, tuple(complete), tuple(unlabelled), tuple(problems), tuple(notes))


def _files(root: Path) -> list[Path]:
    if root.is_file():
        if ending_of(root) not in OWN_ENDINGS:
            raise InputError(f"{root}: expected a recording that ends with {', '.join(OWN_ENDINGS)}")
        return [root]
    if not root.is_dir():
        raise InputError(
            f"{root}: does not exist; expected the folder that holds sensor_data, a folder of recordings, or one file"
        )
    found = [path for path in root.rglob("*") if ending_of(path) in OWN_ENDINGS and path.is_file()]
    visible = [path for path in found if not any(part.startswith(".") for part in path.relative_to(root).parts)]
    if not visible:
        raise InputError(
            f"{root}: no recording in it; expected files that end with {', '.join(OWN_ENDINGS)}, or the folder that "
            "holds sensor_data"
        )
    return sorted(visible)


def _named_motions(files: list[Path]) -> set[Path]:
    motions = set()
    for path in files:
        try:
            motion = OwnRecordingFile(path, own_identity(path.name), "").description.motion_path
        except DatasetFileError:
            continue
        if motion is not None:
            motions.add(motion.resolve())
    return motions
