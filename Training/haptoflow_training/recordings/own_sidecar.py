"""The sidecar of an own recording: NAME.json, and recordings.json with defaults for its folder."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from haptoflow_training.recordings.cluster_dataset_files import DatasetFileError
from haptoflow_training.recordings.file_names import beside, sidecar_of

DEFAULTS_FILE = "recordings.json"
KEYS = (
    "label", "full_scale_mps2", "speed_mps", "velocity_mps", "force_newtons", "motion", "rate_hz", "licence", "source",
)  # fmt: skip
_MAXIMUM_SPEED_MPS = 10.0
_MAXIMUM_FORCE_NEWTONS = 100.0
MINIMUM_RATE_HZ, MAXIMUM_RATE_HZ = 1000.0, 192_000.0


@dataclass(frozen=True)
class Sidecar:
    """The contents of the sidecar files; None or empty for what is in the columns instead.

    path: of the sidecar, whether it exists or not. velocity_mps: a speed lies along the first axis. motion: a file with
    its own clock.
    """

    path: Path
    label: str = ""
    full_scale_mps2: float | None = None
    velocity_mps: tuple[float, float] | None = None
    force_newtons: float | None = None
    motion: Path | None = None
    rate_hz: float | None = None
    licence: str = ""
    source: str = ""


def read_sidecar(recording: Path) -> Sidecar:
    """Read the sidecar of one recording; its own keys override those of recordings.json.

    DatasetFileError names the file, the key, what was found and what is expected.
    """
    path = sidecar_of(recording)
    values: dict[str, Any] = {}
    origins: dict[str, Path] = {}
    for file in (beside(recording, DEFAULTS_FILE), path):
        own = _document(file)
        if "speed_mps" in own and "velocity_mps" in own:
            raise DatasetFileError(file, "keys speed_mps and velocity_mps", "one of them")
        for other, key in (("speed_mps", "velocity_mps"), ("velocity_mps", "speed_mps")):
            if key in own:
                values.pop(other, None)
        values |= own
        origins |= dict.fromkeys(own, file)
    return Sidecar(
        path=path,
        label=_text(values, origins, "label"),
        full_scale_mps2=_number(values, origins, "full_scale_mps2", 0.01, 1e5, "m/s^2 at +-1, 0.01 to 100000"),
        velocity_mps=_velocity(values, origins),
        force_newtons=_number(
            values, origins, "force_newtons", 0.0, _MAXIMUM_FORCE_NEWTONS, "newtons, 0 to 100 (a thousandth of mN)"
        ),
        motion=_motion(values, origins),
        rate_hz=_number(
            values, origins, "rate_hz", MINIMUM_RATE_HZ, MAXIMUM_RATE_HZ, "samples a second, 1000 to 192000"
        ),
        licence=_text(values, origins, "licence"),
        source=_text(values, origins, "source"),
    )


def _document(path: Path) -> dict[str, Any]:
    if not path.is_file():
        return {}
    expected = f"a JSON object with keys of {', '.join(KEYS)}"
    try:
        document = json.loads(path.read_text(encoding="utf-8-sig"))
    except (OSError, ValueError) as error:
        raise DatasetFileError(path, f"not JSON ({error})", expected) from error
    if not isinstance(document, dict):
        raise DatasetFileError(path, f"JSON of another kind ({type(document).__name__})", expected)
    for key in document:
        if key not in KEYS:
            raise DatasetFileError(path, f"unknown key '{key}'", f"keys of {', '.join(KEYS)}")
    return document


def _text(values: dict[str, Any], origins: dict[str, Path], key: str) -> str:
    value = values.get(key, "")
    if not isinstance(value, str):
        raise DatasetFileError(origins[key], f"key '{key}' is {value!r}", "a text in quotes")
    return value.strip()


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)


def _number(
    values: dict[str, Any], origins: dict[str, Path], key: str, lowest: float, highest: float, expected: str
) -> float | None:
    if key not in values:
        return None
    value = values[key]
    if not _is_number(value) or not lowest <= value <= highest:
        raise DatasetFileError(origins[key], f"key '{key}' is {value!r}", expected)
    return float(value)


def _velocity(values: dict[str, Any], origins: dict[str, Path]) -> tuple[float, float] | None:
    speed = _number(
        values, origins, "speed_mps", 0.0, _MAXIMUM_SPEED_MPS, "metres a second, 0 to 10 (a thousandth of mm/s)"
    )
    if speed is not None:
        return speed, 0.0
    if "velocity_mps" not in values:
        return None
    value = values["velocity_mps"]
    pair = isinstance(value, list) and len(value) == 2 and all(_is_number(entry) for entry in value)
    if not pair or math.hypot(*value) > _MAXIMUM_SPEED_MPS:
        expected = "[vx, vy] in metres a second, 10 at most (a thousandth of mm/s)"
        raise DatasetFileError(origins["velocity_mps"], f"key 'velocity_mps' is {value!r}", expected)
    return float(value[0]), float(value[1])


def _motion(values: dict[str, Any], origins: dict[str, Path]) -> Path | None:
    name = _text(values, origins, "motion")
    if not name:
        return None
    origin = origins["motion"]
    path = beside(origin, name)
    # A name in a file leads no further than its own folder, also by a link.
    if not path.resolve().is_relative_to(origin.parent.resolve()):
        raise DatasetFileError(
            origin,
            f"key 'motion' names {name}, which is outside the folder of {origin.name}",
            "a table beside the recording: copy it there",
        )
    if not path.is_file():
        raise DatasetFileError(origin, f"key 'motion' names {name}, which is not there", "a table beside the recording")
    return path
