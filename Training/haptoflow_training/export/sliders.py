"""Sliders for designers: directions in the embedding space, found from the synthetic recorder's parameters of the
labels.

Ridge regression from standardised parameters of the recorder's materials to the labels' embeddings: each slider moves
the embedding by what its own parameter explains beyond the others. The result stays inside the spread of the labels
along their principal axes, because the network was trained on nothing beyond it.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.errors import InputError
from haptoflow_training.export.model_file import ModelFile, model_space
from haptoflow_training.models.label_embedding import WAVE_NUMBERS
from haptoflow_training.recordings.synthetic.materials import Material
from haptoflow_training.whole_file import write_whole

FORMAT, VERSION = "haptoflow-sliders", 1
LEVEL_DB = 12.0
_MINIMUM_LABELS = 8
# Ridge weight, relative to the squared standard deviation of a parameter summed over the labels.
_RIDGE = 3.0
# A slider at 1 is this many standard deviations of its parameter among the labels.
_REACH = 2.0
_JITTER_WITHOUT_RIBS = 0.2

_Doubles = NDArray[np.float64]


def parameters_of(material: Material) -> dict[str, float]:
    """The slider values that the recorder's parameters give. Coarseness: size and low pitch of the surface's grains;
    regularity: height of ribs that keep their places, less single impacts."""
    ribs = sum(
        ruling.relative_height * max(0.0, 1.0 - ruling.jitter / _JITTER_WITHOUT_RIBS) for ruling in material.rulings
    )
    return {
        "coarseness": math.log(material.tip_patch_mm) - math.log(material.targets.centroid_hz),
        "hardness": math.log(material.stiffness_newtons_per_metre),
        "regularity": ribs - 0.5 * material.impact_strength,
        "stickiness": math.log(material.friction),
    }


@dataclass(frozen=True)
class Sliders:
    """directions: [60] for a slider at 1, by name; mean [60]; axes [k, 60] orthonormal; lowest and highest [k]: of
    the labels' coordinates along the axes, about the mean."""

    space: str
    directions: Mapping[str, _Doubles]
    mean: _Doubles
    axes: _Doubles
    lowest: _Doubles
    highest: _Doubles

    def to_json(self) -> dict[str, Any]:
        sliders = [
            {"name": name, "direction": _rounded(direction), "lowest": -1, "highest": 1}
            for name, direction in self.directions.items()
        ]
        silent = _rounded(np.zeros(len(self.mean)))
        sliders.append({"name": "level", "direction": silent, "lowest": -1, "highest": 1, "level_db": LEVEL_DB})
        return {
            "format": FORMAT,
            "version": VERSION,
            "space": self.space,
            "sliders": sliders,
            "mean": _rounded(self.mean),
            "axes": [_rounded(axis) for axis in self.axes],
            "lowest": _rounded(self.lowest),
            "highest": _rounded(self.highest),
        }


def find_sliders(model: ModelFile, materials: Sequence[Material]) -> Sliders:
    """Find the sliders of a model. InputError if too few of its labels are materials of the recorder."""
    known = {material.label: material for material in materials}
    shared = [label for label in model.header["labels"] if label["name"] in known]
    if len(shared) < _MINIMUM_LABELS:
        raise InputError(
            f"the model shares {len(shared)} labels with the recorder's materials; sliders need {_MINIMUM_LABELS} at "
            "least, because they are found from the recorder's parameters"
        )
    table = model.tensors["embedding"].astype(np.float64)[:, :-WAVE_NUMBERS]
    every = table[[label["embedding_row"] for label in model.header["labels"]]]
    mean = every.mean(axis=0)
    _, sizes, axes = np.linalg.svd(every - mean, full_matrices=False)
    axes = axes[sizes > 1e-6 * sizes[0]]
    coordinates = (every - mean) @ axes.T

    rows = [parameters_of(known[label["name"]]) for label in shared]
    names = list(rows[0])
    given = np.array([[row[name] for name in names] for row in rows])
    given = (given - given.mean(axis=0)) / given.std(axis=0)
    offsets = table[[label["embedding_row"] for label in shared]]
    offsets = offsets - offsets.mean(axis=0)
    effects = np.linalg.solve(given.T @ given + _RIDGE * np.eye(len(names)), given.T @ offsets)
    return Sliders(
        model_space(model),
        {name: _REACH * effect for name, effect in zip(names, effects, strict=True)},
        mean,
        axes,
        coordinates.min(axis=0),
        coordinates.max(axis=0),
    )


def write_sliders(path: Path, sliders: Sliders) -> None:
    """Write the file atomically; InputError names the cause of a failure."""
    text = json.dumps(sliders.to_json(), allow_nan=False) + "\n"
    write_whole(path, text.encode("utf-8"))


def _rounded(values: _Doubles) -> list[float]:
    return [round(float(value), 6) for value in values]
