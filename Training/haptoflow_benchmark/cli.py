"""`haptoflow-benchmark`: measurements of a model, the shipped one or your own. Exit codes as `haptoflow-training`."""

from __future__ import annotations

import sys
from collections.abc import Sequence

from haptoflow_training.cli import Command, run_program


def _command(summary: str, name: str) -> Command:
    return Command(summary, f"haptoflow_benchmark.commands.{name}")


_COMMANDS = {
    "evaluate": _command("compare a model with recordings of your own: level and spectrum of each label", "evaluate"),
    "discriminate": _command(
        "check that a classifier trained on recordings recognises the label of what the engine renders", "discriminate"
    ),
    "measure-wave-vectors": _command(
        "count ribs found, missed and falsely found in seconds of strokes", "measure_wave_vectors"
    ),
    "measure-full-scale": _command(
        "measure which acceleration should be full scale, from recorded strokes on every label", "measure_full_scale"
    ),
}
_DESCRIPTION = """Measures a model, the shipped one or your own: accuracy beside recordings, labels told apart, materials
learnt from seconds of recording, ribs found, the full scale. Each command measures one property.
To train and export a model, `haptoflow-training` is enough; the comparison with rivals is `haptoflow-paper`.
"""


def main(arguments: Sequence[str] | None = None) -> int:
    """`haptoflow-benchmark`; returns the exit code."""
    return run_program("haptoflow-benchmark", _DESCRIPTION, _COMMANDS, arguments)


if __name__ == "__main__":
    sys.exit(main())
