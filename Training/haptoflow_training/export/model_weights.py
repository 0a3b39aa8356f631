"""The weights of a model file that native code computes with, for training to begin from: what skeleton_tensors.py wrote,
read back."""

from __future__ import annotations

from typing import cast

import torch
from torch import Tensor

from haptoflow_training.export.model_file import ModelFile

_NAMES = {
    "level.law.": "level.power_law.",
    "level.correction.": "level.correction.",
    "skeleton.": "skeleton.perceptron.layers.",
}


def has_skeleton(file: ModelFile) -> bool:
    return "skeleton" in file.header


def skeleton_weights(file: ModelFile) -> dict[str, Tensor]:
    """Level and skeleton of the file, by the names that a SkeletonModel's state has; the embedding is not among them."""
    return {
        replacement + name.removeprefix(prefix): torch.from_numpy(tensor.copy())
        for name, tensor in file.tensors.items()
        for prefix, replacement in _NAMES.items()
        if name.startswith(prefix)
    }


def embedding_rows(file: ModelFile) -> dict[str, Tensor]:
    """The embedding [64] of each label."""
    rows = torch.from_numpy(file.tensors["embedding"].copy())
    return {cast(str, label["name"]): rows[label["embedding_row"]] for label in file.header["labels"]}
