"""Writes recordings in the data set's file release layout, so that one reader serves both."""

from __future__ import annotations

import io
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.recordings.dataset_layout import (
    ACCELERATION, FORCE, POSITION, PROVENANCE_FILE, SENSOR_FOLDER, TEXTURE_LIST_FILE, SensorKind
)
from haptoflow_training.recordings.recording import Recording
from haptoflow_training.whole_file import write_json, write_whole

_TIME_DECIMALS = 6
_SIGNIFICANT_DIGITS = 9


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
