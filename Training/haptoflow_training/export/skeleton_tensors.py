"""The skeleton of a model as tensors of its file: what native code computes without a graph (model-format.md)."""

from __future__ import annotations

from typing import Any, cast

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor, nn

from haptoflow_training.export.model_file import ModelFile
from haptoflow_training.models.haptoflow_model import parameter_count
from haptoflow_training.models.level_model import LevelModel
from haptoflow_training.models.refiner import Refiner
from haptoflow_training.models.skeleton import (
    LINE_HARMONICS, ORDER, SWING_HARMONICS, TAIL_THRESHOLDS, Skeleton, impulse_factors
)

Tensors = dict[str, NDArray[np.float32]]


def skeleton_header(skeleton: Skeleton) -> dict[str, Any]:
    """The key `skeleton` of the file's header."""
    return {
        "order": ORDER,
        "harmonics": LINE_HARMONICS,
        "swing_harmonics": SWING_HARMONICS,
        "rungs": list(TAIL_THRESHOLDS),
        "hidden": skeleton.perceptron.layers[0].out_features,
        "parameters": parameter_count(skeleton),
    }


def skeleton_tensors(level: LevelModel, skeleton: Skeleton) -> Tensors:
    """The tensors that all tiers with a skeleton share."""
    return {
        "level.law.weight": _numbers(level.power_law.weight),
        "level.law.bias": _numbers(level.power_law.bias),
        **_layers("level.correction", level.correction),
        **_layers("skeleton", skeleton.perceptron.layers, _output_factors(skeleton)),
    }


def _output_factors(skeleton: Skeleton) -> Tensor:
    """[269]: factors on the perceptron's outputs, which are part of a file's last layer."""
    ones = torch.ones(skeleton.perceptron.layers[-1].out_features - len(skeleton.impulse_factors))
    return torch.cat([ones, skeleton.impulse_factors])


def condition_tensors(tier: str, refiner: Refiner) -> Tensors:
    """The perceptron of a tier's FiLM parameters; their factors are part of its last layer."""
    return _layers(f"{tier}.condition", refiner.condition.layers, refiner.film_factors)


def _layers(name: str, layers: nn.Sequential, factors: Tensor | None = None) -> Tensors:
    """factors: on the outputs of the last layer."""
    tensors = {
        f"{name}.{place}.{kind}": _numbers(getattr(layer, kind))
        for place, layer in enumerate(layers)
        if isinstance(layer, nn.Linear)
        for kind in ("weight", "bias")
    }
    if factors is not None:
        last = f"{name}.{len(layers) - 1}"
        tensors[f"{last}.weight"] *= _numbers(factors)[:, None]
        tensors[f"{last}.bias"] *= _numbers(factors)
    return tensors


def _numbers(values: Tensor) -> NDArray[np.float32]:
    numbers: NDArray[np.float32] = values.detach().numpy().astype(np.float32).copy()
    return numbers


_NAMES = {
    "level.law.": "level.power_law.",
    "level.correction.": "level.correction.",
    "skeleton.": "skeleton.perceptron.layers.",
}


def has_skeleton(file: ModelFile) -> bool:
    return "skeleton" in file.header


def skeleton_weights(file: ModelFile) -> dict[str, Tensor]:
    """Level and skeleton of the file, by the names that a SkeletonModel's state has; the embedding is not among them."""
    weights = {
        replacement + name.removeprefix(prefix): torch.from_numpy(tensor.copy())
        for name, tensor in file.tensors.items()
        for prefix, replacement in _NAMES.items()
        if name.startswith(prefix)
    }
    factors = impulse_factors()
    for kind in ("weight", "bias"):
        last = weights[f"skeleton.perceptron.layers.4.{kind}"]
        last[-len(factors) :] /= factors.reshape(-1, *[1] * (last.dim() - 1))
    return weights


def embedding_rows(file: ModelFile) -> dict[str, Tensor]:
    """The embedding [64] of each label."""
    rows = torch.from_numpy(file.tensors["embedding"].copy())
    return {cast(str, label["name"]): rows[label["embedding_row"]] for label in file.header["labels"]}
