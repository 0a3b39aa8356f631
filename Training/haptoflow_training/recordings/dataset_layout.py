"""The layout of the Cluster Haptic Texture Dataset, in both published releases, and the writer of the file release.

File release: `sensor_data/<kind>/<name>.csv`; hub release: `sensor_data/<kind>/<texture_id>/<name>.parquet`. The
columns are the same but for the clock: `time` in seconds, `time_ns` in int64 nanoseconds.
"""

from __future__ import annotations

import io
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.recordings.labels import plain_name
from haptoflow_training.recordings.recording import Recording
from haptoflow_training.whole_file import write_json, write_whole

SENSOR_FOLDER = "sensor_data"
TEXTURE_LIST_FILE = "texture_list.xlsx"
PROVENANCE_FILE = "provenance.json"
_TIME_DECIMALS = 6
_SIGNIFICANT_DIGITS = 9


@dataclass(frozen=True)
class SensorKind:
    """One sensor's folder and its columns in order."""

    folder: str
    columns: tuple[str, ...]


ACCELERATION = SensorKind("accel", ("time", "X", "Y", "Z"))
FORCE = SensorKind("force", ("time", "force"))
POSITION = SensorKind("position", ("time", "X", "Y"))
SENSOR_KINDS = (ACCELERATION, FORCE, POSITION)
AUDIO_FOLDERS = ("audio", "raw_audio")
AUDIO_ENDINGS = (".wav", ".flac")

PUBLISHED_LICENCE = "CC BY 4.0"
PUBLISHED_SOURCE = "Cluster Haptic Texture Dataset, https://doi.org/10.6084/m9.figshare.29438288"

_GROUPS: tuple[tuple[int, int, str], ...] = (
    (0, 37, "wood"),
    (38, 48, "stone"),
    (49, 64, "polymer"),
    (65, 73, "metal"),
    (74, 78, "glass"),
    (79, 81, "composite"),
    (82, 86, "ceramic"),
    (87, 101, "biodegradable"),
    (102, 117, "cloth"),
)

# Only groups whose names are known for each id; the names of the others are in texture_list.xlsx alone.
_NAMES: dict[int, str] = {
    0: "Nyatoh",
    37: "Cedar",
    **dict(
        enumerate(
            (
                *("Granite", "Basalt", "Oya stone", "Plutonic rock", "Towada stone", "Andesite", "Limestone"),
                *("Travertine", "Natural slate", "Marble", "Concrete"),
                *("HDPE", "LDPE", "PP", "Styrofoam", "ABS", "PVC", "PMMA", "PTFE", "PET", "PLA"),
                *("Paper phenol", "Linen phenol", "Melamine sponge", "PU sponge", "Silicon", "Carbon fiber"),
                *("Stainless steel", "Steel", "Cast iron", "Aluminum", "Lead", "Copper", "Brass", "Bronze"),
                "Titanium",
            ),
            start=38,
        )
    ),
    **dict(
        enumerate(
            (
                *("Linoleum", "Tar paper", "Sandpaper"),
                *("Alumina", "Porcelain", "Terracotta", "Brick", "Earth style porcelain"),
                *("Jute", "Cotton", "Wool felt", "Sheep fur", "Rabbit fur", "Cow fur"),
                *("Goat skin", "Horse skin", "Crocodile skin", "Cow skin", "Cow leather", "Snake skin"),
                *("Ray skin", "Lizard skin", "Seal skin"),
            ),
            start=79,
        )
    ),
}


def published_group(texture_id: int) -> str | None:
    """The material group of a published texture id, None outside 0-117."""
    return next((group for first, last, group in _GROUPS if first <= texture_id <= last), None)


def published_name(texture_id: int) -> str:
    """The published name if it is known, else the group and the id (`cloth 104`)."""
    return _NAMES.get(texture_id) or f"{published_group(texture_id) or 'texture'} {texture_id}"


def is_published_list(names: Mapping[int, str]) -> bool:
    """Whether a texture list is that of the published data set: it names at least one texture whose published name
    is known, and agrees with all such names."""
    known = {texture_id: name for texture_id, name in _NAMES.items() if texture_id in names}
    return bool(known) and all(plain_name(names[texture_id]) == plain_name(name) for texture_id, name in known.items())


def ending_of(path: Path) -> str:
    """The ending in lower case, with its dot."""
    return path.suffix.lower()


def beside(path: Path, name: str) -> Path:
    """The file `name` in the folder of `path`, in whatever case it is written there; as given if there is none, or if
    one of exactly this name exists."""
    wanted = path.parent / name
    if wanted.is_file() or not path.parent.is_dir():
        return wanted
    same = sorted(one for one in wanted.parent.glob("*") if one.name.lower() == wanted.name.lower() and one.is_file())
    return same[0] if same else wanted


def sidecar_of(path: Path) -> Path:
    """NAME.json of a recording, whether it exists or not."""
    return beside(path, path.with_suffix(".json").name)


@dataclass(frozen=True)
class TextureEntry:
    """One row of the texture list. friction_coefficients: by heading ({"Friction coefficient": 0.3})."""

    texture_id: int
    name: str
    friction_coefficients: dict[str, float]


def write_recording(root: Path, recording: Recording) -> None:
    """Write the three sensor files of one recording, each atomically.

    Times keep whole microseconds, values nine significant digits: sensor steps (1 mg, 0.01 N, 0.01 mm) are preserved
    exactly. ValueError if a value is not finite; InputError if the disk refuses.
    """
    sensors: tuple[tuple[SensorKind, NDArray[np.float64], NDArray[np.floating]], ...] = (
        (ACCELERATION, recording.acceleration_time_seconds, recording.acceleration_g),
        (FORCE, recording.force_time_seconds, recording.force_newtons),
        (POSITION, recording.position_time_seconds, recording.position_mm),
    )
    for kind, time, values in sensors:
        table = np.column_stack([time, values]).astype(np.float64)
        if not np.all(np.isfinite(table)):
            raise ValueError(
                f"recording {recording.identity.name}: {kind.folder} holds values that are not finite"
            )
        write_whole(Path(root) / SENSOR_FOLDER / kind.folder / f"{recording.identity.name}.csv", _csv(kind, table))


def write_texture_list(root: Path, entries: Iterable[TextureEntry]) -> None:
    """Write texture_list.xlsx: id, name, and a column for each kind of friction coefficient."""
    import pandas

    rows = [{"id": entry.texture_id, "name": entry.name, **entry.friction_coefficients} for entry in entries]
    sheet = io.BytesIO()
    pandas.DataFrame(rows).to_excel(sheet, index=False, engine="openpyxl")
    write_whole(Path(root) / TEXTURE_LIST_FILE, sheet.getvalue())


def write_provenance(
    root: Path, *, source: str, licence: str, synthetic: bool, details: dict[str, Any] | None = None
) -> None:
    """Write provenance.json, which states where the recordings come from; stores and model files copy it."""
    document = {"source": source, "licence": licence, "synthetic": synthetic, **(details or {})}
    write_json(Path(root) / PROVENANCE_FILE, document)


def _csv(kind: SensorKind, table: NDArray[np.float64]) -> bytes:
    row = f"%.{_TIME_DECIMALS}f" + f",%.{_SIGNIFICANT_DIGITS}g" * (len(kind.columns) - 1) + "\n"
    header = ",".join(kind.columns) + "\n"
    return (header + (row * len(table)) % tuple(table.ravel().tolist())).encode()
