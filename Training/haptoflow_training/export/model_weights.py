"""The weights of a model file, for training to go on from: what skeleton_tensors.py and onnx_graphs.py wrote, read
back."""

from __future__ import annotations

from typing import cast

import onnx
import torch
from onnx import numpy_helper
from torch import Tensor

from haptoflow_training.export.model_file import ModelFile
from haptoflow_training.models.refiner import Refiner

Weights = dict[str, Tensor]

_LEVEL_LAW, _LEVEL_CORRECTION, _SKELETON = "level.law.", "level.correction.", "skeleton."


def has_skeleton(file: ModelFile) -> bool:
    return "skeleton" in file.header


def skeleton_weights(file: ModelFile) -> Weights:
    """Level and skeleton of the file, by the names that a SkeletonModel's state has; the embedding is not among them."""
    named = {
        _LEVEL_LAW: "level.power_law.",
        _LEVEL_CORRECTION: "level.correction.",
        _SKELETON: "skeleton.perceptron.layers.",
    }
    return {
        replacement + name.removeprefix(prefix): torch.from_numpy(tensor.copy())
        for name, tensor in file.tensors.items()
        for prefix, replacement in named.items()
        if name.startswith(prefix)
    }


def refiner_of(file: ModelFile, tier: str) -> Refiner:
    """The network of a tier of kind "refine" with its weights. Its graph holds most under their names; the exporter
    transposed the mixers' and the last layer's, and kept their order."""
    graph = onnx.load_from_string(file.graphs[f"{tier}.field"]).graph
    given = {each.name: torch.from_numpy(numpy_helper.to_array(each).copy()) for each in graph.initializer}
    condition = {
        name.removeprefix(f"{tier}."): torch.from_numpy(tensor.copy())
        for name, tensor in file.tensors.items()
        if name.startswith(f"{tier}.condition.")
    }
    width, previous_width = len(given["refiner.enter.weight"]), len(given["refiner.previous_fine.weight"])
    made = Refiner(width=width, previous_width=previous_width, levels=2 if "refiner.down.weight" in given else 1)
    # The file's last layer contains the FiLM factors.
    condition["condition.4.weight"] /= made.film_factors[:, None]
    condition["condition.4.bias"] /= made.film_factors
    named = {name.removeprefix("refiner."): given.pop(name) for name in list(given) if name.startswith("refiner.")}
    named |= {name.replace("condition.", "condition.layers."): value for name, value in condition.items()}
    folded = iter(given.values())
    with torch.no_grad():
        for name, parameter in made.named_parameters():
            if name in named:
                parameter.copy_(named[name])
            else:
                value = next(folded)
                parameter.copy_(value if value.ndim == 1 else value.flatten(1).t().reshape(parameter.shape))
    return made


def embedding_rows(file: ModelFile) -> dict[str, Tensor]:
    """The embedding [64] of each label."""
    rows = torch.from_numpy(file.tensors["embedding"].copy())
    return {cast(str, label["name"]): rows[label["embedding_row"]] for label in file.header["labels"]}
