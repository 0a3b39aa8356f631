"""Labels for chosen textures of the published data set, also for those that no label of labels-cluster.toml names."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Mapping, Sequence

from haptoflow_training.errors import InputError
from haptoflow_training.recordings.dataset_layout import TEXTURE_LIST_FILE, published_group, published_name
from haptoflow_training.recordings.labels import LabelDefinition, LabelMap


def labels_of_textures(known: LabelMap, listed: Mapping[int, str], textures: Sequence[int]) -> LabelMap:
    """One label for each texture, in the order given; for none given, the textures of `known`.

    listed: the data set's names by id. A texture that `known` does not name is called as the data set calls it, with
    stiffness and friction of the first label of its category. InputError for an id that the data set does not have, or
    if a name of `known` is not listed.
    """
    for texture in textures:
        if published_group(texture) is None:
            raise InputError(f"--textures {texture}: the data set has no such texture; expected ids from 0 to 117")
    names = {texture: listed.get(texture) or published_name(texture) for texture in range(118)}
    label_of = {texture: known.label_of(texture, name) for texture, name in names.items()}
    if not textures:
        textures = [texture for texture, label in label_of.items() if label is not None]
        unlisted = [name for name in known.names if name not in label_of.values()]
        if unlisted:
            words = ", ".join(unlisted)
            raise InputError(f"{TEXTURE_LIST_FILE} lists no texture of the labels {words}; name ids in --textures")
    return LabelMap(tuple(_label(known, texture, names[texture]) for texture in dict.fromkeys(textures)))


def _label(known: LabelMap, texture: int, name: str) -> LabelDefinition:
    by_name = {definition.name: definition for definition in known.definitions}
    label = known.label_of(texture, name)
    if label is not None:
        return dataclasses.replace(by_name[label], textures=(texture,))
    category = published_group(texture)
    like = next(definition for definition in known.definitions if definition.category == category)
    own = name.strip().lower()
    own = f"{own} {texture}" if own in by_name else own
    return dataclasses.replace(
        like, name=own, textures=(texture,), wavelength_metres=None, wave_vectors_per_mm=None
    )


def as_toml(labels: LabelMap) -> str:
    """The text of a labels file."""
    return "\n".join(_entry(definition) for definition in labels.definitions)


def _entry(definition: LabelDefinition) -> str:
    # A JSON string is a TOML string, too.
    values = {
        "name": json.dumps(definition.name, ensure_ascii=False),
        "category": json.dumps(definition.category),
        "textures": json.dumps(list(definition.textures)),
        "stiffness_newtons_per_metre": repr(definition.stiffness_newtons_per_metre),
        "friction_coefficient": repr(definition.friction_coefficient),
    }
    if definition.wavelength_metres is not None:
        values["wavelength_metres"] = repr(definition.wavelength_metres)
    if definition.wave_vectors_per_mm is not None:
        values["wave_vectors_per_mm"] = json.dumps([list(vector) for vector in definition.wave_vectors_per_mm])
    return "".join(["[[label]]\n", *(f"{key} = {value}\n" for key, value in values.items())])
