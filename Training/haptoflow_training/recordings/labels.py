"""Labels and their textures, from a TOML file: which recordings are used for which material."""

from __future__ import annotations

import unicodedata
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from haptoflow_training.errors import InputError
from haptoflow_training.whole_file import read_toml

DEFAULT_LABELS_PATH = Path(__file__).resolve().parents[2] / "configs" / "labels-cluster.toml"

_REQUIRED = ("name", "category", "stiffness_newtons_per_metre", "friction_coefficient")
_OPTIONAL = ("textures", "wavelength_metres", "wave_vectors_per_mm")


@dataclass(frozen=True)
class LabelDefinition:
    """One label. textures: ids, or names as in texture_list.xlsx or the recordings' sidecars. stiffness: default
    spring, N/m. friction_coefficient: kinetic. wavelength_metres: of a ruled or woven surface, else None.
    wave_vectors_per_mm: (x, y) across its ribs in cycles per millimetre; empty for a surface without ribs, None if
    the file does not state them."""

    name: str
    category: str
    textures: tuple[int | str, ...]
    stiffness_newtons_per_metre: float
    friction_coefficient: float
    wavelength_metres: float | None = None
    wave_vectors_per_mm: tuple[tuple[float, float], ...] | None = None


@dataclass(frozen=True)
class LabelMap:
    """Labels in the order of their index in a store and a model file."""

    definitions: tuple[LabelDefinition, ...]

    @property
    def names(self) -> list[str]:
        return [definition.name for definition in self.definitions]

    def label_of(self, texture_id: int, texture_name: str) -> str | None:
        """The label that lists this texture by id or by name; None if none does."""
        plain = plain_name(texture_name)
        for definition in self.definitions:
            for texture in definition.textures:
                if texture == texture_id or (isinstance(texture, str) and plain_name(texture) == plain):
                    return definition.name
        return None


def plain_name(name: str) -> str:
    """A texture's name in lower case without spaces and punctuation, because releases spell names differently; of any
    script, however its accents are encoded."""
    composed = unicodedata.normalize("NFC", unicodedata.normalize("NFC", name).casefold())
    return "".join(letter for letter in composed if unicodedata.category(letter)[0] not in "PSZC")


def load_labels(path: Path | str | None = None) -> LabelMap:
    """Read a labels file; InputError names the file, the entry, the key and the expected value."""
    source = DEFAULT_LABELS_PATH if path is None else Path(path)
    document = read_toml(source, "a labels file")
    entries = document.get("label")
    if not isinstance(entries, list) or not entries:
        raise InputError(f"{source}: no [[label]] entries; expected one for each label")
    definitions = tuple(
        _definition(f"{source}: label {number}", entry) for number, entry in enumerate(entries, 1)
    )
    _require_unique(source, definitions)
    return LabelMap(definitions)


def _definition(where: str, entry: Any) -> LabelDefinition:
    if not isinstance(entry, dict):
        raise InputError(f"{where} is {entry!r}; expected a [[label]] table")
    for key in _REQUIRED:
        if key not in entry:
            raise InputError(f"{where}: key '{key}' is missing; expected {', '.join(_REQUIRED)}")
    for key in entry:
        if key not in _REQUIRED + _OPTIONAL:
            raise InputError(f"{where}: unknown key '{key}'; expected {', '.join(_REQUIRED + _OPTIONAL)}")
    for key in ("name", "category"):
        if not isinstance(entry[key], str) or not entry[key].strip():
            raise InputError(f"{where}: key '{key}' is {entry[key]!r}; expected a name")
    if entry["name"] != entry["name"].lower():
        raise InputError(
            f"{where}: key 'name' is {entry['name']!r}; expected lower case, as the engine reads labels: "
            f"{entry['name'].lower()!r} (textures may be spelt in any case)"
        )
    textures = entry.get("textures", [entry["name"]])
    if not isinstance(textures, list) or not textures or not all(
        _is_texture(texture) for texture in textures
    ):
        raise InputError(f"{where}: key 'textures' is {textures!r}; expected a list of ids or names")
    return LabelDefinition(
        entry["name"],
        entry["category"],
        tuple(textures),
        _positive(where, entry, "stiffness_newtons_per_metre"),
        _positive(where, entry, "friction_coefficient"),
        _positive(where, entry, "wavelength_metres") if "wavelength_metres" in entry else None,
        _wave_vectors(where, entry["wave_vectors_per_mm"]) if "wave_vectors_per_mm" in entry else None,
    )


def _wave_vectors(where: str, value: Any) -> tuple[tuple[float, float], ...]:
    """Up to two [x, y]; InputError for anything else."""
    expected = "up to two [x, y] in cycles per millimetre, or [] for a surface without ribs"
    good = isinstance(value, list) and len(value) <= 2 and all(
        isinstance(vector, list)
        and len(vector) == 2
        and all(isinstance(part, (int, float)) and not isinstance(part, bool) and abs(part) < 100.0 for part in vector)
        for vector in value
    )
    if not good:
        raise InputError(f"{where}: key 'wave_vectors_per_mm' is {value!r}; expected {expected}")
    return tuple((float(x), float(y)) for x, y in value)


def _is_texture(value: Any) -> bool:
    return (isinstance(value, int) and not isinstance(value, bool) and value >= 0) or (
        isinstance(value, str) and bool(plain_name(value))
    )


def _positive(where: str, entry: dict[str, Any], key: str) -> float:
    value = entry[key]
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not 0 < value < float("inf"):
        raise InputError(f"{where}: key '{key}' is {value!r}; expected a number above 0")
    return float(value)


def _require_unique(source: Path, definitions: tuple[LabelDefinition, ...]) -> None:
    names: set[str] = set()
    owner: dict[int | str, str] = {}
    for definition in definitions:
        if definition.name in names:
            raise InputError(f"{source}: label '{definition.name}' occurs twice; give each label one entry")
        names.add(definition.name)
        for texture in definition.textures:
            key = plain_name(texture) if isinstance(texture, str) else texture
            if key in owner:
                raise InputError(
                    f"{source}: texture {texture!r} belongs to '{owner[key]}' and to '{definition.name}'; "
                    "expected one"
                )
            owner[key] = definition.name
