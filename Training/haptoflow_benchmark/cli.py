"""`haptoflow-benchmark`: measurements of a model, the shipped one or your own. Exit codes as `haptoflow-training`."""

from __future__ import annotations

from collections.abc import Sequence

from haptoflow_training.cli import run_program

_COMMANDS = {
    "evaluate": "compare a model with recordings of your own: level and spectrum of each label",
    "discriminate": "check that a classifier trained on recordings recognises the label of what the engine renders",
}
_DESCRIPTION = """Measures a model, the shipped one or your own: accuracy beside recordings and beside
learning, labels told apart. Each command measures one property.
To train and export a model, `haptoflow-training` is enough; the comparison with rivals is `haptoflow-paper`.
"""


def main(arguments: Sequence[str] | None = None) -> int:
    """`haptoflow-benchmark`; returns the exit code."""
    return run_program("haptoflow-benchmark", _DESCRIPTION, _COMMANDS, arguments)
