"""Networks, representations and training objectives that another package adds under the names of a run's TOML file.

haptoflow_training itself has the velocity field ("unet"), raw samples ("raw") and the objectives of the shipped model.
Importing a package that calls `register` adds its parts; each is imported when a run first needs it.
"""

from __future__ import annotations

import importlib
from typing import Any, Literal

from haptoflow_training.errors import InputError

Kind = Literal["architecture", "representation", "objective"]

_registered: dict[tuple[Kind, str], str] = {}


def register(kind: Kind, name: str, location: str) -> None:
    """Add a part. location: "package.module:attribute".

    An architecture is a function (ribs, sampled) -> SegmentNetwork; a representation a function (table of the TOML
    file) -> Representation; the objective "average-velocity" a function (bound
    field, target, generator, weight) -> loss; the objective "reflow" a class with `draw`, `loss` and `joined`, as
    training/losses.py and training/trainer.py call them.
    """
    _registered[kind, name] = location


def registered(kind: Kind) -> tuple[str, ...]:
    """The names of the registered parts of one kind, in the order of their registration."""
    return tuple(name for part, name in _registered if part == kind)


def extension(kind: Kind, name: str) -> Any:
    """The registered part; InputError if there is none of this name."""
    if (kind, name) not in _registered:
        raise InputError(
            f"{kind} '{name}' is not part of haptoflow-training: use the same command of `haptoflow-paper`, which "
            "adds the rivals, the codecs and their training objectives"
        )
    module, attribute = _registered[kind, name].split(":")
    return getattr(importlib.import_module(module), attribute)
