"""The seam by which another package extends a run: it derives a configuration of its own and puts it in place.

A configuration class names the classes that train it and write it (`trained_by`, `exported_as`), so
a derived one may bring further keys, rules, networks, objectives and kinds of tiers. haptoflow_training itself has
neither keys nor branches for them. Importing a package that calls `use_configuration` changes what `load_config` reads.
"""

from __future__ import annotations

import importlib
from typing import Any

_configuration = ["haptoflow_training.training.config:TrainingConfig"]


def use_configuration(location: str) -> None:
    """Read runs as this class from now on, "package.module:name", which derives from TrainingConfig."""
    _configuration[:] = [location]


def configuration_class() -> Any:
    """The class as which runs are read."""
    return located(_configuration[0])


def located(location: str) -> Any:
    """What "package.module:name" names, imported when it is first needed."""
    module, name = location.split(":")
    return getattr(importlib.import_module(module), name)
