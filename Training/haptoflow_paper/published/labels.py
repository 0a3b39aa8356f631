"""Labels of an imported model: the checkpoint's classes by their names, and the short names that scenes use."""

from __future__ import annotations

import tomllib
import unicodedata
from dataclasses import dataclass
from pathlib import Path

from haptoflow_training.errors import InputError
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
    """One label for each class in the order of its row, then the labels of labels-cluster.toml that name one of the
    classes, as second names of its row: `wood`, `metal`, `cotton`.

    InputError if two classes have the same name in lower case.
    """
    surfaces, default = _surfaces()
    labels = [
        PublishedLabel(_lowered(name), row, *_traits(_surface_of(name, surfaces, default)))
        for row, name in enumerate(classes)
    ]
    names = [label.name for label in labels]
    for name in names:
        if names.count(name) > 1:
            raise InputError(f"the class '{name}' occurs twice, if capitals do not count; expected names of their own")
    rows = {plain_name(name): row for row, name in enumerate(classes)}
    for definition in load_labels().definitions:
        # Ids of the data set are not rows of a checkpoint, which are in the order of the names.
        known = [rows[plain_name(texture)] for texture in _names_of(definition.textures) if plain_name(texture) in rows]
        if known and definition.name not in names:
            labels.append(
                PublishedLabel(
                    definition.name,
                    known[0],
                    definition.category,
                    definition.stiffness_newtons_per_metre,
                    definition.friction_coefficient,
                )
            )
    return labels


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


def _surfaces() -> tuple[list[_Surface], str]:
    document = tomllib.loads(SURFACES_PATH.read_text(encoding="utf-8"))
    surfaces = [
        _Surface(
            entry["category"],
            tuple(_words(phrase) for phrase in entry["words"]),
            entry["stiffness_newtons_per_metre"],
            entry["friction_coefficient"],
        )
        for entry in document["surface"]
    ]
    return surfaces, document["default"]


# Names of the data set's list for the ids in labels-cluster.toml, as far as the list is known.
_NAMES = {
    0: ("Nyatoh",), 38: ("Granite",), 48: ("Concrete",), 53: ("ABS",), 63: ("Silicon", "Silicone"), 66: ("Steel",),
    74: ("Float", "Float glass"), 79: ("Linoleum",), 81: ("Sandpaper",), 83: ("Porcelain",), 85: ("Brick",),
    87: ("Jute",), 90: ("Sheep fur",), 97: ("Cow leather",),
}


def _names_of(textures: tuple[int | str, ...]) -> list[str]:
    names = [[texture] if isinstance(texture, str) else _NAMES.get(texture, ()) for texture in textures]
    return [name for several in names for name in several]
