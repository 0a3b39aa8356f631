"""A folder of a user's own recordings as a data set, with labels and origin."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path

from haptoflow_training.errors import InputError
from haptoflow_training.recordings.cluster_dataset_files import DatasetFileError
from haptoflow_training.recordings.dataset import UNKNOWN, Dataset
from haptoflow_training.recordings.dataset_layout import ending_of
from haptoflow_training.recordings.labels import LabelMap
from haptoflow_training.recordings.own_files import OWN_ENDINGS, OwnRecordingFile, described_file, is_motion_file


def open_own_dataset(root: Path, labels: LabelMap | None = None) -> Dataset:
    """Index a folder with its subfolders, or one file; reads sidecars and headings, but no samples.

    Without `labels` a recording's label is the one in its sidecar. InputError if the path does not exist or holds no
    recording.
    """
    base = root.parent if root.is_file() else root
    broken: dict[Path, DatasetFileError] = {}
    described: list[OwnRecordingFile] = []
    for path in _files(root):
        try:
            described.append(described_file(path, _name(path.relative_to(base))))
        except DatasetFileError as error:
            broken[path] = error
    motions = {entry.motion_path.resolve() for entry in described if entry.motion_path is not None}
    complete: list[OwnRecordingFile] = []
    unlabelled: list[OwnRecordingFile] = []
    notes: list[str] = []
    for entry in described:
        if _is_motion(entry.path, motions):
            continue
        notes.extend(entry.notes)
        label = entry.label if labels is None else labels.label_of(-1, entry.label) if entry.label else None
        (complete if label else unlabelled).append(replace(entry, label=label or entry.label))
    problems = [error for path, error in broken.items() if not _is_motion(path, motions)]
    entries = [*complete, *unlabelled]
    provenance = {
        key: ", ".join(dict.fromkeys(getattr(entry, key) for entry in entries)) or UNKNOWN
        for key in ("source", "licence")
    }
    return Dataset(
        root, tuple(complete), tuple(unlabelled), tuple(problems), {**provenance, "synthetic": False},
        _left_out(root, unlabelled), tuple(notes), is_own=True,
    )  # fmt: skip


def _name(path: Path) -> str:
    """Also of bytes that are not UTF-8, which no report and no store could hold."""
    return os.fsencode(path.as_posix()).decode("utf-8", "backslashreplace")


def _is_motion(path: Path, named: set[Path]) -> bool:
    return is_motion_file(path) or path.resolve() in named


def _left_out(root: Path, unlabelled: list[OwnRecordingFile]) -> str:
    if not unlabelled:
        return ""
    nameless = [entry.identity.name for entry in unlabelled if not entry.label]
    named = dict.fromkeys(entry.label for entry in unlabelled if entry.label)
    reasons = [f"no sidecar has a key 'label' for {', '.join(nameless)}"] if nameless else []
    reasons += [f"no label of the labels file names {', '.join(named)}"] if named else []
    return f"{root}: {len(unlabelled)} recordings are left out: {'; '.join(reasons)}"


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
