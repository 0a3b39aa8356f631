"""The Cluster Haptic Texture Dataset and data sets in its layout: an index of the folder; samples are read on
demand."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from haptoflow_training.errors import InputError
from haptoflow_training.recordings.cluster_dataset_files import (
    DatasetFileError,
    TableReader,
    read_sensor,
    read_table,
)
from haptoflow_training.recordings.cluster_dataset_textures import read_texture_list, texture_names
from haptoflow_training.recordings.dataset_layout import (
    ACCELERATION,
    AUDIO_ENDINGS,
    AUDIO_FOLDERS,
    FORCE,
    POSITION,
    PROVENANCE_FILE,
    PUBLISHED_LICENCE,
    PUBLISHED_SOURCE,
    SENSOR_FOLDER,
    SENSOR_KINDS,
    is_published_list,
)
from haptoflow_training.recordings.file_names import ending_of
from haptoflow_training.recordings.labels import LabelMap
from haptoflow_training.recordings.recording import Recording, RecordingIdentity

UNKNOWN = "unknown"
_ENDINGS = (".csv", ".parquet")


@dataclass(frozen=True)
class DatasetProblem:
    """A file that is missing or does not follow the layout; the rest of the data set stays usable."""

    path: Path
    found: str
    expected: str

    def __str__(self) -> str:
        return f"{self.path}: {self.found}; expected {self.expected}"


@dataclass(frozen=True)
class RecordingFiles:
    """One recording on disk; `load` reads its three sensor files. Can be passed to another process."""

    identity: RecordingIdentity
    label: str
    acceleration_path: Path
    force_path: Path
    position_path: Path
    table_reader: TableReader = read_table

    @property
    def paths(self) -> tuple[Path, ...]:
        """Every file that the recording is made from."""
        return self.acceleration_path, self.force_path, self.position_path

    def path_of(self, sensor: str) -> Path:
        """The file of acceleration, force or position."""
        return dict(zip(("acceleration", "force", "position"), self.paths, strict=True))[sensor]

    def load(self) -> Recording:
        """Read the recording. DatasetFileError (an InputError) names a file that does not follow the layout."""
        acceleration = read_sensor(self.acceleration_path, ACCELERATION, self.table_reader)
        force = read_sensor(self.force_path, FORCE, self.table_reader)
        position = read_sensor(self.position_path, POSITION, self.table_reader)
        return Recording(self.identity, self.label, *acceleration, *force, *position)


@dataclass(frozen=True)
class ClusterDataset:
    """The contents of `root`. problems: those visible from the folder listing alone.

    textures: id to name. unlabelled: complete recordings whose texture no label lists.
    """

    root: Path
    recordings: tuple[RecordingFiles, ...]
    textures: dict[int, str]
    unlabelled: tuple[RecordingFiles, ...]
    audio_files: int
    provenance: dict[str, Any]
    problems: tuple[DatasetProblem, ...] = field(default=())

    @property
    def synthetic(self) -> bool:
        return bool(self.provenance.get("synthetic"))

    @property
    def published(self) -> bool:
        """Whether these are recordings of the Cluster Haptic Texture Dataset, whose ids its labels file uses."""
        return _is_published(self.provenance)

    @property
    def left_out(self) -> str:
        """One printable line about the recordings whose texture no label names; empty if there are none."""
        if not self.unlabelled:
            return ""
        textures = dict.fromkeys(self.textures[entry.identity.texture_id] for entry in self.unlabelled)
        return (
            f"{self.root}: {len(self.unlabelled)} recordings are left out: no label names their textures "
            f"({', '.join(textures)})"
        )

    def origin_of(self, entry: RecordingFiles) -> tuple[str, str]:
        """(licence, source) of one recording."""
        return str(self.provenance.get("licence") or UNKNOWN), str(self.provenance.get("source") or UNKNOWN)

    @property
    def notes(self) -> tuple[str, ...]:
        """Notes about ignored content; this layout has none."""
        return ()

    @property
    def labels(self) -> list[str]:
        """The labels that occur, ordered by their lowest texture id."""
        return list(dict.fromkeys(entry.label for entry in self.recordings))

    def __iter__(self) -> Iterator[RecordingFiles]:
        return iter(self.recordings)

    def __len__(self) -> int:
        return len(self.recordings)


def open_dataset(
    root: Path | str, labels: LabelMap | None = None, table_reader: TableReader = read_table
) -> ClusterDataset:
    """Index a folder of either release, sorted by identity; reads names and the texture list, but no samples.

    Without `labels` every texture's name is its label. With it, textures that no label lists are `unlabelled`; a
    synthetic root has texture ids of its own, so its labels are matched by name. Without provenance.json a folder
    counts as the published data set only if its texture list says so. InputError if the folder does not hold
    `sensor_data/accel`.
    """
    root = Path(root)
    sensors = root / SENSOR_FOLDER
    if not (sensors / ACCELERATION.folder).is_dir():
        raise InputError(
            f"{root}: no {SENSOR_FOLDER}/{ACCELERATION.folder} in it; "
            f"expected the folder that holds {SENSOR_FOLDER}"
        )
    problems: list[DatasetProblem] = []
    found = {kind.folder: _list_sensor(sensors / kind.folder, problems) for kind in SENSOR_KINDS}
    identities = sorted(set().union(*(set(files) for files in found.values())), key=_sort_key)
    try:
        listed = read_texture_list(root)
    except DatasetFileError as error:
        problems.append(DatasetProblem(error.path, error.found, error.expected))
        listed = {}
    provenance = _provenance(root, {number: entry.name for number, entry in listed.items()}, problems)
    synthetic = bool(provenance.get("synthetic"))
    texture_ids = {identity.texture_id for identity in identities}
    textures = texture_names(texture_ids, listed, published=_is_published(provenance))
    complete: list[RecordingFiles] = []
    unlabelled: list[RecordingFiles] = []
    for identity in identities:
        missing = [kind.folder for kind in SENSOR_KINDS if identity not in found[kind.folder]]
        if missing:
            present = next(files[identity] for files in found.values() if identity in files)
            problems.extend(_missing(sensors, present, folder) for folder in missing)
            continue
        name = textures[identity.texture_id]
        label = name if labels is None else _label(labels, identity.texture_id, name, synthetic)
        paths = (found[kind.folder][identity] for kind in SENSOR_KINDS)
        files = RecordingFiles(identity, label or name, *paths, table_reader)
        (unlabelled if label is None else complete).append(files)
    return ClusterDataset(
        root, tuple(complete), textures, tuple(unlabelled), _count_audio(sensors), provenance, tuple(problems)
    )


def _label(labels: LabelMap, texture_id: int, name: str, synthetic: bool) -> str | None:
    if synthetic:
        return name if name in labels.names else None
    return labels.label_of(texture_id, name)


def _sort_key(identity: RecordingIdentity) -> tuple[int, int, int, int, int]:
    direction = -1 if identity.direction_degrees is None else identity.direction_degrees
    return identity.texture_id, direction, identity.speed_mmps, identity.force_millinewtons, identity.repeat


def _list_sensor(folder: Path, problems: list[DatasetProblem]) -> dict[RecordingIdentity, Path]:
    files: dict[RecordingIdentity, Path] = {}
    if not folder.is_dir():
        return files
    paths = [path for pattern in ("*", "*/*") for path in folder.glob(pattern) if ending_of(path) in _ENDINGS]
    for path in sorted(paths):
        if path.name.startswith("."):
            continue
        try:
            identity = RecordingIdentity.parse(path.stem)
        except ValueError:
            problems.append(
                DatasetProblem(
                    path, "a name of another form", "<texture_id>_<direction>_<velocity>_<force>_<repeat>"
                )
            )
            continue
        if identity in files:
            problems.append(
                DatasetProblem(path, f"the same recording as {files[identity]}", "one file of a recording")
            )
            continue
        files[identity] = path
    return files


def _missing(sensors: Path, present: Path, folder: str) -> DatasetProblem:
    inside = present.relative_to(sensors)
    return DatasetProblem(
        sensors.joinpath(folder, *inside.parts[1:]), "missing file", f"the sibling of {inside.as_posix()}"
    )


def _is_published(provenance: dict[str, Any]) -> bool:
    return bool(provenance.get("source") == PUBLISHED_SOURCE)


def _provenance(root: Path, listed: dict[int, str], problems: list[DatasetProblem]) -> dict[str, Any]:
    path = root / PROVENANCE_FILE
    if not path.is_file():
        if is_published_list(listed):
            return {"source": PUBLISHED_SOURCE, "licence": PUBLISHED_LICENCE, "synthetic": False}
        return {"source": UNKNOWN, "licence": UNKNOWN, "synthetic": False}
    try:
        document = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        document = str(error)
    if isinstance(document, dict):
        return document
    expected = "a JSON object with source, licence and synthetic"
    problems.append(DatasetProblem(path, "not a JSON object", expected))
    return {"source": f"{UNKNOWN} ({PROVENANCE_FILE} is damaged)", "licence": UNKNOWN, "synthetic": False}


def _count_audio(sensors: Path) -> int:
    return sum(
        ending_of(path) in AUDIO_ENDINGS
        for folder in AUDIO_FOLDERS
        for pattern in ("*", "*/*")
        for path in (sensors / folder).glob(pattern)
    )
