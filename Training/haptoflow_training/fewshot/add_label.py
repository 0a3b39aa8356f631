"""Adds a material to a model file as one more label; everything else in the file stays unchanged."""

from __future__ import annotations

from typing import Any

import numpy as np

from haptoflow_training.errors import InputError
from haptoflow_training.export.model_file import ModelFile, model_space

# What a material file states beside a label's own keys.
_NOT_OF_A_LABEL = ("format", "version", "space", "name", "description", "embedding", "range", "seeds")


def with_label(model: ModelFile, material: dict[str, Any]) -> ModelFile:
    """The model with a further label at the end: an embedding row, a header entry and, if the model has a seed bank,
    seeds. material: the content of a material file. InputError if it is of another space or a label has its name."""
    name, space = material["name"], model_space(model)
    if material["space"] != space:
        raise InputError(
            f"material '{name}' was learnt for another model (space {material['space']}, the model's is {space}); learn "
            "it from its recording under this model"
        )
    require_new_name(model, name)
    rows = model.tensors["embedding"]
    label = {key: value for key, value in material.items() if key not in _NOT_OF_A_LABEL}
    header = {**model.header, "labels": [*model.header["labels"], {"name": name, "embedding_row": len(rows), **label}]}
    added: dict[str, Any] = {"embedding": [material["embedding"]]}
    if "pieces" in model.tensors:
        # One piece of the material is known: the label itself.
        added["pieces"] = np.zeros((1, *model.tensors["pieces"].shape[1:]))
    bank, seeds = model.header.get("seed_bank"), material.get("seeds", [])
    if bank is not None:
        added[bank["tensor"]] = [seed["samples"] for seed in seeds]
        entries = [{"label": name, **{key: value for key, value in seed.items() if key != "samples"}} for seed in seeds]
        header["seed_bank"] = {**bank, "entries": [*bank["entries"], *entries]}
    tensors = {
        key: np.concatenate([tensor, np.array(added[key], dtype=np.float32)]) if len(added.get(key, ())) else tensor
        for key, tensor in model.tensors.items()
    }
    return ModelFile(header, tensors, model.graphs)


def require_new_name(model: ModelFile, name: str) -> None:
    """InputError if the model has a label of this name."""
    if any(label["name"] == name for label in model.header["labels"]):
        raise InputError(f"the model has a label '{name}' already; choose another --name")
