"""Reads `meta.json` of a published checkpoint: what the weights do not say."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from haptoflow_training.errors import InputError
from haptoflow_training.waveform import SAMPLE_RATE_HZ, SEGMENT_SAMPLES

META_FILE = "meta.json"
# In the order of the control embedding's inputs.
CONTROLS = ("force", "velocity_x", "velocity_y")
SOLVERS = ("heun", "euler")


@dataclass(frozen=True)
class ControlStatistics:
    """Of one control over the training recordings; N or m/s."""

    mean: float
    deviation: float
    least: float
    greatest: float


@dataclass(frozen=True)
class PublishedMeta:
    """controls: by their names in CONTROLS. classes: names of the rows of the label embedding. groups, past_groups: of
    the group norms of the U-Net and of the features of the past. bandwidth_kbps: of EnCodec's quantiser."""

    classes: tuple[str, ...]
    controls: dict[str, ControlStatistics]
    solver: str
    steps: int
    guidance: float
    groups: int
    past_groups: int
    bandwidth_kbps: float

    @property
    def is_guided(self) -> bool:
        return self.guidance != 1.0


class _Node:
    """A value of the file with its dotted key, which errors name."""

    def __init__(self, path: Path, key: str, value: Any) -> None:
        self.path, self.key, self.value = path, key, value

    def refuse(self, expected: str) -> InputError:
        return InputError(f"{self.path}: key '{self.key}' is {self.value!r}; expected {expected}")

    def at(self, key: str) -> _Node:
        dotted = f"{self.key}.{key}" if self.key else key
        if not isinstance(self.value, dict) or key not in self.value:
            raise InputError(
                f"{self.path}: key '{dotted}' is missing; expected the meta.json that the authors' training writes "
                "beside the weights (save it again with their present version)"
            )
        return _Node(self.path, dotted, self.value[key])

    def number(self, least: float = -math.inf) -> float:
        is_number = isinstance(self.value, (int, float)) and not isinstance(self.value, bool)
        if not is_number or not math.isfinite(self.value) or self.value < least:
            raise self.refuse("a number" + (f" of at least {least:g}" if least > -math.inf else ""))
        return float(self.value)

    def count(self) -> int:
        if self.number(1) != int(self.value):
            raise self.refuse("a whole number above 0")
        return int(self.value)

    def require(self, expected: Any, remedy: str = "") -> None:
        if self.value != expected:
            raise self.refuse(json.dumps(expected) + (f": {remedy}" if remedy else ""))


def read_meta(path: Path) -> PublishedMeta:
    """Read and check a meta.json; InputError names file, key and what was expected."""
    try:
        document = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        remedy = "expected the folder of a published checkpoint"
        raise InputError(f"{path}: cannot be read ({error.strerror}); {remedy}") from error
    except (ValueError, RecursionError) as error:
        raise InputError(f"{path}: not valid JSON ({error})") from error
    root = _Node(path, "", document)
    root.at("model_type").require("flow_matching", "other models of the authors' code cannot be imported")
    config = root.at("config")
    _require_vibration(root)
    _require_codec(root)
    model, past = config.at("model"), config.at("model").at("prev_segment_encoder")
    model.at("use_prev_segment").require(True)
    past.at("use_positional_embedding").require(True)
    past.at("pos_embed_max_distance").require(None)
    model.at("control_embedding").at("use_sinusoidal").require(True)
    sampling = config.at("sampling")
    solver = sampling.at("solver")
    if solver.value not in SOLVERS:
        raise solver.refuse("one of " + ", ".join(SOLVERS))
    statistics = root.at("control_stats")
    return PublishedMeta(
        classes=_classes(root.at("dataset")),
        controls={name: _statistics(statistics.at(name)) for name in CONTROLS},
        solver=solver.value,
        steps=sampling.at("steps").count(),
        guidance=sampling.at("guidance_scale").number(0.0),
        groups=model.at("groups").count(),
        past_groups=past.at("groups").count(),
        bandwidth_kbps=config.at("encodec").at("bandwidth_kbps").number(0.1),
    )


def _require_vibration(root: _Node) -> None:
    rate, samples = root.at("dataset").at("sample_rate"), root.at("waveform_length")
    if rate.number() != SAMPLE_RATE_HZ or samples.count() != SEGMENT_SAMPLES:
        raise InputError(
            f"{root.path}: dataset.sample_rate is {rate.value!r} and waveform_length {samples.value!r}; expected "
            f"{SAMPLE_RATE_HZ} and {SEGMENT_SAMPLES}: this is not the checkpoint of vibrations (haptoflow_accel); the "
            "audio variant (haptoflow_audio) cannot be felt and is not imported"
        )
    data = root.at("config").at("data").at("root")
    if "audio" in str(data.value).lower():
        raise data.refuse("recordings of acceleration: the audio variant (haptoflow_audio) is not imported")


def _require_codec(root: _Node) -> None:
    for node in (root.at("config").at("encodec").at("model_name"), root.at("encodec_io").at("encodec_model_name")):
        node.require("24khz", "checkpoints on EnCodec's 48 kHz model are not imported")


def _classes(dataset: _Node) -> tuple[str, ...]:
    classes, numbers = dataset.at("classes"), dataset.at("label_to_int")
    names = classes.value
    if not isinstance(names, list) or not names or not all(isinstance(name, str) and name.strip() for name in names):
        raise classes.refuse("a list of names")
    rows = numbers.value
    if not isinstance(rows, dict) or rows.keys() != set(names) or sorted(rows.values()) != list(range(len(names))):
        raise numbers.refuse("for each of dataset.classes a row of its own, from 0")
    return tuple(sorted(names, key=lambda name: rows[name]))


def _statistics(node: _Node) -> ControlStatistics:
    found = ControlStatistics(
        node.at("mean").number(), node.at("std").number(1e-9), node.at("min").number(), node.at("max").number()
    )
    if not found.least <= found.mean <= found.greatest:
        raise node.refuse("min <= mean <= max")
    return found
