"""A model file's weights as training reads them back: writing them again gives the same file."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import torch
from torch import nn

from haptoflow_training.export.model_file import ModelFile, read_model_file
from haptoflow_training.export.skeleton_tensors import skeleton_tensors, skeleton_weights
from haptoflow_training.models.level_model import LevelModel
from haptoflow_training.models.skeleton import Skeleton

SHIPPED = Path(__file__).parents[2] / "Packages" / "com.haptoflow.runtime" / "Runtime" / "Models" / "default.haptoflow"


@pytest.fixture(scope="module")
def file() -> ModelFile:
    return read_model_file(SHIPPED)


def _part(weights: dict[str, torch.Tensor], name: str, module: nn.Module) -> nn.Module:
    module.load_state_dict(
        {key.removeprefix(name): value for key, value in weights.items() if key.startswith(name)}, strict=True
    )
    return module


def test_level_and_skeleton_are_written_again_as_they_were_read(file: ModelFile) -> None:
    weights = skeleton_weights(file)
    level, skeleton = _part(weights, "level.", LevelModel()), _part(weights, "skeleton.", Skeleton())
    assert isinstance(level, LevelModel) and isinstance(skeleton, Skeleton)
    for name, tensor in skeleton_tensors(level, skeleton).items():
        np.testing.assert_array_equal(tensor, file.tensors[name])
