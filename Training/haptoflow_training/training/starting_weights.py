"""The weights that a run begins with: those of another run, or of a model file."""

from __future__ import annotations

import copy
from pathlib import Path
from typing import Any

import torch
from torch import Tensor, nn

from haptoflow_training.errors import InputError
from haptoflow_training.export.model_file import read_model_file
from haptoflow_training.export.skeleton_tensors import embedding_rows, has_skeleton, skeleton_weights
from haptoflow_training.models.conditioning import EMBEDDING_SIZE, MaskedLinear
from haptoflow_training.models.haptoflow_model import HaptoFlowModel, SkeletonModel
from haptoflow_training.models.label_embedding import WAVE_NUMBERS

def adopt_base(model: HaptoFlowModel, folder: Path, labels: list[str]) -> None:
    """Copy the embedding, the level and, for a refinement, the skeleton of the finished run in `folder` into `model`,
    and freeze them."""
    weights = _averaged_weights(folder, labels, "--base")
    shared: list[tuple[str, nn.Module]] = [("embedding", model.embedding), ("level", model.level)]
    if isinstance(model, SkeletonModel):
        if not any(key.startswith("skeleton.") for key in weights):
            raise InputError(f"--base {folder}: has no skeleton; name a run whose model.network is 'skeleton'")
        shared.append(("skeleton", model.skeleton))
    for name, part in shared:
        # The base's own network, if it has one, is ignored.
        prefix = f"{name}."
        part.load_state_dict({key[len(prefix) :]: value for key, value in weights.items() if key.startswith(prefix)})
        part.requires_grad_(False)


def adopt_start(model: HaptoFlowModel, start: Path, labels: list[str]) -> None:
    """Start from a model file or from the finished run in a folder."""
    if start.is_file():
        _adopt_file(model, start, labels)
    else:
        _adopt_run(model, start, labels)


def _adopt_run(model: HaptoFlowModel, folder: Path, labels: list[str]) -> None:
    """Start from the averaged weights of the run in `folder`, of the same labels. A layer with more outputs than in
    that run keeps its initial weights for the new ones; InputError names a layer with another shape."""
    own = model.state_dict()
    for name, weights in _averaged_weights(folder, labels, "--from").items():
        if name not in own or weights.shape[1:] != own[name].shape[1:] or weights.shape[:1] > own[name].shape[:1]:
            raise InputError(f"--from {folder}: its '{name}' does not fit; begin from a run of the same [model]")
        own[name][: len(weights)] = weights
    model.load_state_dict(own)


def _averaged_weights(folder: Path, labels: list[str], option: str) -> dict[str, Tensor]:
    content = checkpoint_of(folder)
    if content["labels"] != labels:
        raise InputError(f"{option} {folder}: trained on labels {content['labels']}, this run has {labels}")
    weights: dict[str, Tensor] = content["average"]["module"]
    return weights


def checkpoint_of(folder: Path) -> dict[str, Any]:
    """The checkpoint of the run in `folder`; InputError if there is none."""
    path = folder / "checkpoint.pt"
    if not path.exists():
        raise InputError(f"{path} does not exist: train first (`haptoflow-training train --out {folder}`)")
    content: dict[str, Any] = torch.load(path, map_location="cpu")
    return content


def _adopt_file(model: HaptoFlowModel, path: Path, labels: list[str]) -> None:
    """Begin with the level, the skeleton and the labels of a model file. A label that the file does not know begins in
    the middle of those it knows."""
    file = read_model_file(path)
    if not isinstance(model, SkeletonModel) or not has_skeleton(file):
        raise InputError(f"--from {path}: only a model with a skeleton can begin from a file, and only from one with a skeleton")
    rows = embedding_rows(file)
    middle = torch.stack(list(rows.values())).mean(dim=0)
    begun = torch.stack([rows.get(label, middle) for label in labels])
    weights = skeleton_weights(file) | {"embedding.learnt.weight": begun[:, : EMBEDDING_SIZE - WAVE_NUMBERS]}
    own = model.state_dict()
    masks = {
        f"{name}.weight": layer.mask for name, layer in model.named_modules() if isinstance(layer, MaskedLinear)
    }
    for name, value in weights.items():
        fits = name in own and own[name].shape == value.shape
        # One perceptron is no two side by side, even if it is as wide.
        if not fits or (name in masks and (value * (1.0 - masks[name])).any()):
            raise InputError(f"--from {path}: its '{name}' does not fit; begin with its [model], or without --from")
        own[name] = value
    model.load_state_dict(own)


class MovingAverage:
    """average <- decay average + (1 - decay) weights, with the decay ramped up over the first steps."""

    def __init__(self, module: nn.Module, decay: float) -> None:
        self.module = copy.deepcopy(module).eval().requires_grad_(False)
        self._decay = decay
        self._updates = 0

    @torch.no_grad()
    def update(self, module: nn.Module) -> None:
        self._updates += 1
        decay = min(self._decay, (1.0 + self._updates) / (10.0 + self._updates))
        for average, weight in zip(self.module.parameters(), module.parameters(), strict=True):
            average.lerp_(weight.detach(), 1.0 - decay)

    def state(self) -> dict[str, object]:
        return {"module": self.module.state_dict(), "updates": self._updates}

    def restore(self, state: dict[str, object]) -> None:
        self.module.load_state_dict(state["module"])  # type: ignore[arg-type]
        self._updates = int(state["updates"])  # type: ignore[call-overload]
