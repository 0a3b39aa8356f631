"""The Cluster Haptic Texture Dataset and data sets in its layout: an index of the folder; samples are read on
demand."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from haptoflow_training.errors import InputError
from haptoflow_training.recordings.cluster_dataset_files import DatasetFileError, read_sensor
from haptoflow_training.recordings.dataset import UNKNOWN, Dataset, is_published
from haptoflow_training.recordings.dataset_layout import (
    ACCELERATION, AUDIO_ENDINGS, AUDIO_FOLDERS, PROVENANCE_FILE, PUBLISHED_LICENCE,
    PUBLISHED_SOURCE, SENSOR_FOLDER, SENSOR_KINDS, TEXTURE_LIST_FILE, ending_of, is_published_list, published_group,
    published_name
)
from haptoflow_training.recordings.labels import LabelDefinition, LabelMap
from haptoflow_training.recordings.recording import Recording, RecordingIdentity

_ID_HEADINGS = ("id", "texture id", "texture_id", "no", "no.", "number", "index", "#")
_NAME_HEADINGS = (
    "name", "texture name", "texture_name", "texture", "material", "material name", "material_name"
)
_EXPECTED = "a sheet with headings id and name"
_SEARCHED_ROWS = 10


def read_texture_list(root: Path) -> dict[int, str]:
    """Names by id.

    The headings may stand below a title and be spelled in several ways. Empty if the file is missing; DatasetFileError
    if it cannot be understood.
    """
    import pandas

    path = Path(root) / TEXTURE_LIST_FILE
    if not path.is_file():
        return {}
    try:
        sheet = pandas.read_excel(path, header=None, engine="openpyxl")
    except Exception as error:  # a damaged workbook raises what zip, XML and openpyxl raise
        raise DatasetFileError(path, f"not a workbook ({error})", _EXPECTED) from error
    for row in range(min(_SEARCHED_ROWS, len(sheet))):
        plain = [str(cell).strip().casefold() for cell in sheet.iloc[row]]
        identifier = next((plain.index(heading) for heading in _ID_HEADINGS if heading in plain), None)
        name = next((plain.index(heading) for heading in _NAME_HEADINGS if heading in plain), None)
        if identifier is not None and name is not None:
            body = sheet.iloc[row + 1 :]
            break
    else:
        raise DatasetFileError(path, "no heading row with an id and a name", _EXPECTED)
    numbers = pandas.to_numeric(body.iloc[:, identifier], errors="coerce")
    return {
        int(number): str(text).strip()
        for number, text in zip(numbers, body.iloc[:, name], strict=True)
        if not (pandas.isna(number) or pandas.isna(text))
    }


_ENDINGS = (".csv", ".parquet")


@dataclass(frozen=True)
class RecordingFiles:
    """One recording on disk; `load` reads its three sensor files. Can be passed to another process. paths: of
    acceleration, force and position."""

    identity: RecordingIdentity
    label: str
    paths: tuple[Path, Path, Path]
    licence: str
    source: str

    def path_of(self, sensor: str) -> Path:
        """The file of acceleration, force or position."""
        return self.paths[("acceleration", "force", "position").index(sensor)]

    def load(self) -> Recording:
        """Read the recording. DatasetFileError (an InputError) names a file that does not follow the layout."""
        acceleration, force, position = map(read_sensor, self.paths, SENSOR_KINDS)
        # The sensor rests before and after each pass, so that its noise shows.
        return Recording(self.identity, self.label, *acceleration, *force, *position, has_sensor_noise=True)


def open_dataset(root: Path | str, labels: LabelMap | None = None) -> Dataset:
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
    problems: list[DatasetFileError] = []
    found = {kind.folder: _list_sensor(sensors / kind.folder, problems) for kind in SENSOR_KINDS}
    identities = sorted(set().union(*(set(files) for files in found.values())), key=_sort_key)
    try:
        listed = read_texture_list(root)
    except DatasetFileError as error:
        problems.append(error)
        listed = {}
    provenance = _provenance(root, listed, problems)
    licence, source = (str(provenance.get(key) or UNKNOWN) for key in ("licence", "source"))
    name_of = published_name if is_published(provenance) else "texture {}".format
    numbers = sorted({identity.texture_id for identity in identities})
    textures = {number: listed.get(number) or name_of(number) for number in numbers}
    complete: list[RecordingFiles] = []
    unlabelled: list[RecordingFiles] = []
    for identity in identities:
        missing = [kind.folder for kind in SENSOR_KINDS if identity not in found[kind.folder]]
        if missing:
            present = next(files[identity] for files in found.values() if identity in files)
            problems.extend(_missing(sensors, present, folder) for folder in missing)
            continue
        name = textures[identity.texture_id]
        label = name if labels is None else _label(labels, identity.texture_id, name, bool(provenance.get("synthetic")))
        acceleration, force, position = (found[kind.folder][identity] for kind in SENSOR_KINDS)
        files = RecordingFiles(identity, label or name, (acceleration, force, position), licence, source)
        (unlabelled if label is None else complete).append(files)
    nameless = dict.fromkeys(textures[entry.identity.texture_id] for entry in unlabelled)
    reason = f"no label names their textures ({', '.join(nameless)})"
    left_out = f"{root}: {len(unlabelled)} recordings are left out: {reason}" if unlabelled else ""
    return Dataset(
        root, tuple(complete), tuple(unlabelled), tuple(problems), provenance, left_out,
        textures=textures, audio_files=_count_audio(sensors),
    )  # fmt: skip


def _label(labels: LabelMap, texture_id: int, name: str, synthetic: bool) -> str | None:
    if synthetic:
        return name if name in labels.names else None
    return labels.label_of(texture_id, name)


def _sort_key(identity: RecordingIdentity) -> tuple[int, int, int, int, int]:
    direction = -1 if identity.direction_degrees is None else identity.direction_degrees
    return identity.texture_id, direction, identity.speed_mmps, identity.force_millinewtons, identity.repeat


def _list_sensor(folder: Path, problems: list[DatasetFileError]) -> dict[RecordingIdentity, Path]:
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
                DatasetFileError(
                    path, "a name of another form", "<texture_id>_<direction>_<velocity>_<force>_<repeat>"
                )
            )
            continue
        if identity in files:
            problems.append(
                DatasetFileError(path, f"the same recording as {files[identity]}", "one file of a recording")
            )
            continue
        files[identity] = path
    return files


def _missing(sensors: Path, present: Path, folder: str) -> DatasetFileError:
    inside = present.relative_to(sensors)
    return DatasetFileError(
        sensors.joinpath(folder, *inside.parts[1:]), "missing file", f"the sibling of {inside.as_posix()}"
    )


def _provenance(root: Path, listed: dict[int, str], problems: list[DatasetFileError]) -> dict[str, Any]:
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
    problems.append(DatasetFileError(path, "not a JSON object", expected))
    return {"source": f"{UNKNOWN} ({PROVENANCE_FILE} is damaged)", "licence": UNKNOWN, "synthetic": False}


def _count_audio(sensors: Path) -> int:
    return sum(
        ending_of(path) in AUDIO_ENDINGS
        for folder in AUDIO_FOLDERS
        for pattern in ("*", "*/*")
        for path in (sensors / folder).glob(pattern)
    )


def labels_of_textures(known: LabelMap, listed: Mapping[int, str], textures: Sequence[int]) -> LabelMap:
    """One label for each texture, in the order given; for none given, the textures of `known`.

    listed: the data set's names by id. A texture that `known` does not name is called as the data set calls it, with
    stiffness and friction of the first label of its category. InputError for an id that the data set does not have, or
    if a name of `known` is not listed.
    """
    for texture in textures:
        if published_group(texture) is None:
            raise InputError(f"--textures {texture}: the data set has no such texture; expected ids from 0 to 117")
    names = {texture: listed.get(texture) or published_name(texture) for texture in range(118)}
    label_of = {texture: known.label_of(texture, name) for texture, name in names.items()}
    if not textures:
        textures = [texture for texture, label in label_of.items() if label is not None]
        unlisted = [name for name in known.names if name not in label_of.values()]
        if unlisted:
            words = ", ".join(unlisted)
            raise InputError(f"{TEXTURE_LIST_FILE} lists no texture of the labels {words}; name ids in --textures")
    return LabelMap(tuple(_label_of_texture(known, texture, names[texture]) for texture in dict.fromkeys(textures)))


def _label_of_texture(known: LabelMap, texture: int, name: str) -> LabelDefinition:
    by_name = {definition.name: definition for definition in known.definitions}
    label = known.label_of(texture, name)
    if label is not None:
        return dataclasses.replace(by_name[label], textures=(texture,))
    category = published_group(texture)
    like = next(definition for definition in known.definitions if definition.category == category)
    own = name.strip().lower()
    own = f"{own} {texture}" if own in by_name else own
    return dataclasses.replace(
        like, name=own, textures=(texture,), wavelength_metres=None, wave_vectors_per_mm=None
    )


def as_toml(labels: LabelMap) -> str:
    """The text of a labels file."""
    return "\n".join(_entry(definition) for definition in labels.definitions)


def _entry(definition: LabelDefinition) -> str:
    # A JSON string is a TOML string, too.
    values = {
        "name": json.dumps(definition.name, ensure_ascii=False),
        "category": json.dumps(definition.category),
        "textures": json.dumps(list(definition.textures)),
        "stiffness_newtons_per_metre": repr(definition.stiffness_newtons_per_metre),
        "friction_coefficient": repr(definition.friction_coefficient),
    }
    if definition.wavelength_metres is not None:
        values["wavelength_metres"] = repr(definition.wavelength_metres)
    if definition.wave_vectors_per_mm is not None:
        values["wave_vectors_per_mm"] = json.dumps([list(vector) for vector in definition.wave_vectors_per_mm])
    return "".join(["[[label]]\n", *(f"{key} = {value}\n" for key, value in values.items())])
