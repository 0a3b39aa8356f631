"""Adds a material to a model file as one more label; everything else in the file stays unchanged."""

from __future__ import annotations

from typing import Any

import numpy as np

from haptoflow_training.errors import InputError
from haptoflow_training.export.material_file import Material, model_space
from haptoflow_training.export.model_file import ModelFile


def with_label(model: ModelFile, material: Material) -> ModelFile:
    """The model with a further label at the end: an embedding row, seeds and a header entry. InputError if the
    material is of another space or a label has its name."""
    if material.space != model_space(model):
        raise InputError(
            f"material '{material.name}' was learnt for another model (space {material.space}, the model's is "
            f"{model_space(model)}); learn it from its recording under this model"
        )
    name = material.name.lower()
    if any(label["name"] == name for label in model.header["labels"]):
        raise InputError(f"the model has a label '{name}' already; choose another --name")
    rows = model.tensors["embedding"]
    label = {"name": name, "embedding_row": len(rows), **_without_name(material.label_keys())}
    label["provenance"] = material.provenance.to_json()
    bank = model.header["seed_bank"]
    tensors = dict(model.tensors)
    tensors["embedding"] = np.concatenate([rows, material.embedding[None, :]]).astype(np.float32)
    seeds = [seed.samples for seed in material.seeds]
    if seeds:
        tensors[bank["tensor"]] = np.concatenate([model.tensors[bank["tensor"]], np.stack(seeds)]).astype(np.float32)
    entries = [
        {
            "label": name,
            "velocity_mps": list(seed.velocity_mps),
            "force_newtons": seed.force_newtons,
            **({} if seed.rib_phase is None else {"rib_phase": list(seed.rib_phase)}),
        }
        for seed in material.seeds
    ]
    header: dict[str, Any] = {
        **model.header,
        "labels": [*model.header["labels"], label],
        "seed_bank": {**bank, "entries": [*bank["entries"], *entries]},
    }
    return ModelFile(header, tensors, model.graphs)


def _without_name(keys: dict[str, Any]) -> dict[str, Any]:
    return {key: value for key, value in keys.items() if key != "name"}
