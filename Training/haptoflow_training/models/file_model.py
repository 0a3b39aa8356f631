"""A `.haptoflow` file as a differentiable model: embedding in, segment out, without a checkpoint."""

from __future__ import annotations

from typing import Any

import torch
from torch import Tensor

from haptoflow_training.errors import InputError
from haptoflow_training.export.model_file import ModelFile
from haptoflow_training.models.graph_module import GraphModule
from haptoflow_training.training.flow_matching import solve


class FileTier:
    """One raw tier: its field graph with its solver. All waves in unit scale."""

    def __init__(self, model: ModelFile, entry: dict[str, Any], *, trainable: bool = False) -> None:
        if entry["representation"] != "raw":
            raise InputError(f"tier '{entry['name']}' is latent; a material is fitted to a raw tier")
        self.name: str = entry["name"]
        self.kind: str = entry["kind"]
        self._solver, self._steps = entry["solver"], int(entry["steps"])
        self.field = GraphModule(model.graphs[entry["field"]], f"tier '{self.name}'", trainable=trainable)

    def segment(self, noise: Tensor, previous: Tensor, embedding: Tensor, motion: Tensor, rib_phase: Tensor) -> Tensor:
        """Segment [B, 1, 200] from noise and previous [B, 1, 200], embedding [B, 64], motion [B, 3] and rib phase
        [B, 2]."""
        given = {"previous": previous, "embedding": embedding, "motion": motion, "rib_phase": rib_phase}
        if self.kind == "direct":
            return self.field({"noisy": noise, "time": noise.new_zeros(len(noise), 1), **given})
        if self.kind == "flow":

            def field(noisy: Tensor, time: Tensor) -> Tensor:
                return self.field({"noisy": noisy, "time": time, **given})

            return solve(field, noise, self._solver, self._steps)
        length = 1.0 / self._steps
        interval = noise.new_full((len(noise), 1), length)
        for step in range(self._steps):
            time = noise.new_full((len(noise), 1), step * length)
            noise = noise + length * self.field({"noisy": noise, "time": time, "interval": interval, **given})
        return noise


class FileModel:
    """Embedding table, level graph and tiers of a model file."""

    def __init__(self, model: ModelFile) -> None:
        self.file = model
        self.embedding = torch.from_numpy(model.tensors["embedding"].copy())
        self._tiers = {entry["name"]: entry for entry in model.header["tiers"]}
        self._levels: dict[str, GraphModule] = {}
        self._opened: dict[str, FileTier] = {}

    @property
    def labels(self) -> list[dict[str, Any]]:
        found: list[dict[str, Any]] = self.file.header["labels"]
        return found

    @property
    def label_embeddings(self) -> Tensor:
        """[labels, 64], in the order of `labels`."""
        return self.embedding[[label["embedding_row"] for label in self.labels]]

    def tier(self, name: str | None = None) -> FileTier:
        """The named tier, or the file's default one."""
        wanted = self.file.header["default_tier"] if name is None else name
        if wanted not in self._tiers:
            raise InputError(f"the model has no tier '{wanted}'; it has {', '.join(self._tiers)}")
        if wanted not in self._opened:
            self._opened[wanted] = FileTier(self.file, self._tiers[wanted])
        return self._opened[wanted]

    def trainable_tier(self, name: str | None = None) -> FileTier:
        """A copy of the tier whose weights can be trained; the model's own tier stays unchanged."""
        wanted = self.file.header["default_tier"] if name is None else name
        return FileTier(self.file, self._tiers[wanted], trainable=True)

    def log_level(self, embedding: Tensor, motion: Tensor, tier: str | None = None) -> Tensor:
        """[B, 1]: the output of the tier's level graph, natural logarithm of the RMS in m/s^2."""
        entry = self._tiers[self.file.header["default_tier"] if tier is None else tier]
        graph = entry["level"]
        if graph not in self._levels:
            self._levels[graph] = GraphModule(self.file.graphs[graph], f"level graph '{graph}'")
        return self._levels[graph]({"embedding": embedding, "motion": motion})
