"""Labels of an imported model: the checkpoint's classes by their names, and the short names that scenes use."""

from __future__ import annotations

import tomllib
import unicodedata
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor, nn

from haptoflow_training.errors import InputError
from haptoflow_training.models.conditioning import EMBEDDING_SIZE
from haptoflow_training.recordings.labels import load_labels, plain_name

SURFACES_PATH = Path(__file__).with_name("surfaces.toml")


@dataclass(frozen=True)
class PublishedLabel:
    """name: lower case, as the engine reads labels. row: of the label embedding. stiffness: default spring, N/m."""

    name: str
    row: int
    category: str
    stiffness_newtons_per_metre: float
    friction_coefficient: float


@dataclass(frozen=True)
class _Surface:
    category: str
    phrases: tuple[tuple[str, ...], ...]
    stiffness_newtons_per_metre: float
    friction_coefficient: float


def published_labels(classes: tuple[str, ...]) -> list[PublishedLabel]:
    """One label for each class in the order of its row, then the labels of labels-cluster.toml as second names of the
    class that each of them names: `wood`, `metal`, `rubber`. One that is called as a category and whose texture is not
    among the classes is the first class of that category.

    InputError if two classes have the same name in lower case.
    """
    table = tomllib.loads(SURFACES_PATH.read_text(encoding="utf-8"))
    surfaces = _surfaces(table)
    labels = [
        PublishedLabel(_lowered(name), row, *_traits(_surface_of(name, surfaces, table["default"])))
        for row, name in enumerate(classes)
    ]
    names = [label.name for label in labels]
    for name in names:
        if names.count(name) > 1:
            raise InputError(f"the class '{name}' occurs twice, if capitals do not count; expected names of their own")
    rows = {plain_name(name): row for row, name in enumerate(classes)}
    first_of = {label.category: label.row for label in reversed(labels)}
    second_names = []
    for definition in load_labels().definitions:
        # Ids of the data set are not rows of a checkpoint, whose classes are in the order of their names.
        textures = [plain_name(name) for name in _names_of(definition.textures, table["texture_names"])]
        row = next((rows[name] for name in textures if name in rows), first_of.get(definition.name))
        if row is not None and definition.name not in names:
            traits = (definition.stiffness_newtons_per_metre, definition.friction_coefficient)
            second_names.append(PublishedLabel(definition.name, row, definition.category, *traits))
    return labels + second_names


def _names_of(textures: tuple[int | str, ...], names: Mapping[str, list[str]]) -> list[str]:
    several = [[texture] if isinstance(texture, str) else names.get(str(texture), []) for texture in textures]
    return [name for each in several for name in each]


def _lowered(name: str) -> str:
    return unicodedata.normalize("NFC", name.strip()).lower()


def _words(name: str) -> tuple[str, ...]:
    letters = "".join(letter if letter.isalnum() else " " for letter in _lowered(name))
    return tuple(letters.split())


def _contains(words: tuple[str, ...], phrase: tuple[str, ...]) -> bool:
    return any(words[start : start + len(phrase)] == phrase for start in range(len(words) - len(phrase) + 1))


def _surface_of(name: str, surfaces: list[_Surface], default: str) -> _Surface:
    words = _words(name)
    matches = [
        (sum(map(len, phrase)), surface)
        for surface in surfaces
        for phrase in surface.phrases
        if _contains(words, phrase)
    ]
    if matches:
        return max(matches, key=lambda match: match[0])[1]
    return next(surface for surface in surfaces if surface.category == default)


def _traits(surface: _Surface) -> tuple[str, float, float]:
    return surface.category, surface.stiffness_newtons_per_metre, surface.friction_coefficient


def _surfaces(table: Mapping[str, Any]) -> list[_Surface]:
    return [
        _Surface(
            entry["category"],
            tuple(_words(phrase) for phrase in entry["words"]),
            entry["stiffness_newtons_per_metre"],
            entry["friction_coefficient"],
        )
        for entry in table["surface"]
    ]


_TEXTURE = EMBEDDING_SIZE - 4
# Cycles per millimetre for a unit of a row: at 1 m/s a rate of 0.001 Hz, where ribs begin at 0.5 Hz.
_RIB_SCALE = 1e-6
# Directions that vary less than this share of the first one are rounding.
_LEAST_SHARE = 1e-6


class EmbeddingRows(nn.Module):
    """embeddings: [classes, 64] for the file, float32. Maps embeddings [B, 64] back to rows [B, label]."""

    def __init__(self, rows: Tensor) -> None:
        super().__init__()
        values: NDArray[np.float64] = rows.detach().double().numpy()
        mean = values.mean(axis=0)
        left, sizes, directions = np.linalg.svd(values - mean, full_matrices=False)
        count = int((sizes > _LEAST_SHARE * sizes[:1]).sum())
        if count > EMBEDDING_SIZE:
            raise InputError(
                f"label_embed.emb.weight: {len(values)} rows that vary in {count} directions; expected at most "
                f"{EMBEDDING_SIZE}, the size of an embedding of the model format"
            )
        scale = np.ones(EMBEDDING_SIZE)
        scale[_TEXTURE:] = _RIB_SCALE
        embeddings = np.zeros((len(values), EMBEDDING_SIZE))
        embeddings[:, :count] = (left * sizes)[:, :count]
        self.embeddings: NDArray[np.float32] = (embeddings * scale).astype(np.float32)
        self.turn = nn.Linear(EMBEDDING_SIZE, values.shape[1])
        weight = np.zeros((values.shape[1], EMBEDDING_SIZE))
        weight[:, :count] = directions[:count].T
        self.turn.weight.data = torch.from_numpy((weight / scale).astype(np.float32))
        self.turn.bias.data = torch.from_numpy(mean.astype(np.float32))

    def forward(self, embedding: Tensor) -> Tensor:
        return self.turn(embedding)
