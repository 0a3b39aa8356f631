"""Opens the recordings of a path: the published data set's layout, those that a model generated, or own files."""

from __future__ import annotations

from pathlib import Path

from haptoflow_training.recordings.cluster_dataset import RecordingFiles, open_dataset
from haptoflow_training.recordings.dataset import Dataset
from haptoflow_training.recordings.dataset_layout import SENSOR_FOLDER
from haptoflow_training.recordings.generated_dataset import GENERATED_FILE, GeneratedFile, open_generated
from haptoflow_training.recordings.labels import LabelMap, load_labels
from haptoflow_training.recordings.own_dataset import open_own_dataset
from haptoflow_training.recordings.own_files import OwnRecordingFile

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
