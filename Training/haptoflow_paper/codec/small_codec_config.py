"""The configuration of the small codec, `configs/codec-small.toml`."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any, TypeVar

from haptoflow_paper.codec.small_codec import SmallCodecShape
from haptoflow_training.errors import InputError

Table = TypeVar("Table")


@dataclass(frozen=True)
class SmallCodecConfig:
    """One training run of the small codec.

    output_folder: for checkpoint, log and result.
    steps: of `batch` segments each.
    learning_rate: falls by a cosine over the second half.
    spectral_weight: of the spectral loss beside the time loss.
    held_out_as: the configuration of a network whose held-out bands the codec excludes too; none if missing.
    validate_every_steps: also the interval of log and checkpoint.
    threads: of PyTorch.
    """

    output_folder: Path
    shape: SmallCodecShape = SmallCodecShape()
    seed: int = 1
    steps: int = 6000
    batch: int = 64
    learning_rate: float = 1e-3
    spectral_weight: float = 0.1
    validate_every_steps: int = 250
    validation_segments: int = 512
    threads: int = 2
    held_out_as: Path | None = None


_PATHS = {"Path": "folder", "Path | None": "file"}
_MINIMUM = {"seed": 0, "spectral_weight": 0.0, "learning_rate": 1e-8}


def _checked(table: type[Table], values: dict[str, Any], path: Path, section: str) -> dict[str, Any]:
    known = {field.name: field.type for field in fields(table)}
    for key, value in values.items():
        if known.get(key, "SmallCodecShape") == "SmallCodecShape":
            names = ", ".join(sorted(known.keys() - {"shape"}))
            raise InputError(f"{path}: [{section}] {key} is unknown, expected one of {names}")
        if known[key] in _PATHS:
            if not isinstance(value, str) or not value:
                raise InputError(f"{path}: [{section}] {key} = {value!r}, expected a {_PATHS[known[key]]} as text")
            continue
        whole = known[key] == "int"
        allowed = int if whole else (int, float)
        least = _MINIMUM.get(key, 1)
        if isinstance(value, bool) or not isinstance(value, allowed) or not least <= value < float("inf"):
            kind = "a whole number" if whole else "a number"
            raise InputError(f"{path}: [{section}] {key} = {value!r}, expected {kind} of at least {least}")
    return values


def read_small_codec_config(path: Path | str) -> SmallCodecConfig:
    """Read a TOML file with the tables [codec] and [training]; InputError names file, key and the expected value.

    A relative output_folder refers to the current folder, a relative held_out_as to the file's own.
    """
    path = Path(path)
    try:
        content = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror})") from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise InputError(f"{path}: not a TOML file ({error})") from error
    unknown = sorted(content.keys() - {"codec", "training"})
    if unknown:
        raise InputError(f"{path}: '{unknown[0]}' is unknown, expected the tables [codec] and [training]")
    for section in ("codec", "training"):
        if not isinstance(content.get(section, {}), dict):
            raise InputError(f"{path}: '{section}' is a value, expected the table [{section}]")
    training = content.get("training", {})
    if "output_folder" not in training:
        raise InputError(f"{path}: [training] output_folder is missing, expected a folder for the results")
    shape = SmallCodecShape(**_checked(SmallCodecShape, content.get("codec", {}), path, "codec"))
    values = dict(_checked(SmallCodecConfig, training, path, "training"))
    values["output_folder"] = Path(values["output_folder"])
    if "held_out_as" in values:
        values["held_out_as"] = path.parent / values["held_out_as"]
    return SmallCodecConfig(shape=shape, **values)
