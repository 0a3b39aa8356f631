"""Opens the recordings of a path: the published data set's layout, own files, or those that a model generated (one .npz for
each, already one axis at 2 kHz, so that preparation filters nothing)."""

from __future__ import annotations

import json
import zipfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.errors import InputError
from haptoflow_training.recordings.cluster_dataset import RecordingFiles, open_dataset
from haptoflow_training.recordings.cluster_dataset_files import DatasetFileError
from haptoflow_training.recordings.dataset import Dataset
from haptoflow_training.recordings.dataset_layout import SENSOR_FOLDER
from haptoflow_training.recordings.labels import LabelMap, load_labels
from haptoflow_training.recordings.own_files import OwnRecordingFile, open_own_dataset
from haptoflow_training.recordings.recording import STANDARD_GRAVITY_MPS2, Recording, RecordingIdentity
from haptoflow_training.waveform import SAMPLE_RATE_HZ

GENERATED_FILE = "generated.json"
_KEYS = ("source", "licence", "labels")

_Floats = NDArray[np.float32]


@dataclass(frozen=True)
class GeneratedOrigin:
    """What all recordings of a folder state. labels: by texture id, which is the number in a recording's name."""

    source: str
    licence: str
    labels: tuple[str, ...]


@dataclass(frozen=True)
class GeneratedFile:
    """One generated recording on disk; `load` reads it. Can be passed to another process."""

    path: Path
    identity: RecordingIdentity
    label: str
    licence: str
    source: str

    @property
    def paths(self) -> tuple[Path, ...]:
        return (self.path,)

    def path_of(self, sensor: str) -> Path:
        """The one file of all sensors."""
        return self.path

    def load(self) -> Recording:
        """Read the recording. DatasetFileError (an InputError) names a file that is damaged."""
        waveform_mps2, motion = read_generated(self.path)
        time = np.arange(len(waveform_mps2)) / SAMPLE_RATE_HZ
        velocity = motion[:, :2].astype(np.float64)
        steps = velocity * (1000.0 / SAMPLE_RATE_HZ)
        return Recording(
            self.identity, self.label, time, waveform_mps2[:, None] / STANDARD_GRAVITY_MPS2, time, motion[:, 2], time,
            np.cumsum(steps, axis=0) - steps, velocity_mps=velocity, is_generated=True,
        )  # fmt: skip


def read_generated(path: Path) -> tuple[_Floats, _Floats]:
    """Waveform [n] and motion [n, 3] of a file; DatasetFileError if they are not there."""
    expected = "waveform_mps2 [n] and motion [n, 3], finite"
    try:
        with np.load(path) as stored:
            waveform, motion = stored["waveform_mps2"], stored["motion"]
    except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile) as error:
        raise DatasetFileError(path, f"no generated recording ({error})", expected) from error
    if waveform.ndim != 1 or motion.shape != (len(waveform), 3) or not len(waveform):
        raise DatasetFileError(path, f"arrays {waveform.shape} and {motion.shape}", expected)
    if not (np.isfinite(waveform).all() and np.isfinite(motion).all()):
        raise DatasetFileError(path, "values that are not finite", expected)
    return waveform, motion


def open_generated(root: Path, labels: LabelMap | None = None) -> Dataset:
    """Index a folder of generated recordings, sorted by name; recordings that no label of `labels` names are left out."""
    origin = origin_of(root)
    complete: list[GeneratedFile] = []
    unlabelled: list[GeneratedFile] = []
    problems: list[DatasetFileError] = []
    for path in sorted(root.glob("[!.]*.npz")):
        try:
            identity = RecordingIdentity.parse(path.stem)
            name = origin.labels[identity.texture_id]
        except (ValueError, IndexError):
            problems.append(DatasetFileError(path, "a name of another form", "<label's number>_<direction>_<velocity>_…"))
            continue
        label = name if labels is None else labels.label_of(identity.texture_id, name)
        file = GeneratedFile(path, identity, label or name, origin.licence, origin.source)
        (complete if label else unlabelled).append(file)
    if not complete and not unlabelled:
        raise InputError(f"{root}: no generated recording in it")
    nameless = ", ".join(dict.fromkeys(file.label for file in unlabelled))
    return Dataset(
        root, tuple(complete), tuple(unlabelled), tuple(problems),
        {"source": origin.source, "licence": origin.licence, "synthetic": False},
        f"{root}: {len(unlabelled)} recordings are left out: no label names {nameless}" if unlabelled else "", is_own=True,
    )  # fmt: skip


def origin_of(root: Path) -> GeneratedOrigin:
    path = root / GENERATED_FILE
    try:
        document = json.loads(path.read_text(encoding="utf-8"))
        source, licence, labels = (document[key] for key in _KEYS)
        return GeneratedOrigin(str(source), str(licence), tuple(str(label) for label in labels))
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise InputError(f"{path}: cannot be read ({error}); expected {', '.join(_KEYS)}") from error


RecordingFile = RecordingFiles | OwnRecordingFile | GeneratedFile


def open_recordings(path: Path | str, labels: LabelMap | None = None) -> Dataset:
    """Index a folder that holds sensor_data, a folder of CSV, Parquet or WAV files, or one such file.

    Without `labels` every texture's name is its label, or what its sidecar states. InputError if the path holds no
    recording.
    """
    root = Path(path)
    if (root / SENSOR_FOLDER).is_dir():
        return open_dataset(root, labels)
    if (root / GENERATED_FILE).is_file():
        return open_generated(root, labels)
    return open_own_dataset(root, labels)


def open_with_labels(path: Path, labels_path: Path | None) -> Dataset:
    """As `open_recordings`, with the labels of a file; without one, the published data set has its own."""
    dataset = open_recordings(path, load_labels(labels_path) if labels_path else None)
    return open_recordings(path, load_labels()) if labels_path is None and dataset.published else dataset
