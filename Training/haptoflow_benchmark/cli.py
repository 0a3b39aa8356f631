"""`haptoflow-benchmark`: the measurements behind the published tables. Exit codes as `haptoflow-training`."""

from __future__ import annotations

import sys
from collections.abc import Sequence

from haptoflow_training.cli import Command, run_program


def _command(summary: str, name: str) -> Command:
    return Command(summary, f"haptoflow_benchmark.commands.{name}")


_COMMANDS = {
    "evaluate": _command(
        "measure accuracy and time of every row of the plan, or accuracy of your own model", "evaluate"
    ),
    "discriminate": _command(
        "check that a classifier trained on recordings recognises the label of what the engine renders", "discriminate"
    ),
    "few-shot": _command("measure materials fitted to ten seconds of recording, beside rivals", "few_shot"),
    "learn-figures": _command(
        "measure materials fitted by `haptoflow learn` to ten seconds of recording", "learn_figures"
    ),
    "measure-wave-vectors": _command(
        "count ribs found, missed and falsely found in seconds of strokes", "measure_wave_vectors"
    ),
    "measure-full-scale": _command(
        "measure which acceleration should be full scale, from recorded strokes on every label", "measure_full_scale"
    ),
    "train": Command(
        "`haptoflow-training train` for rivals, codecs and their objectives too", "haptoflow_training.commands.train"
    ),
    "train-codec": _command("train the small codec whose latents some rows work on", "train_codec"),
    "export": Command(
        "`haptoflow-training export` for rivals, codecs and their objectives too", "haptoflow_training.commands.export"
    ),
}
_DESCRIPTION = """Measures what the published tables state: the product's models beside rivals (transformer, DSTN, SPSI,
autoregressive), latent codecs, reflow and mean flow, one row for each method and configuration.
`haptoflow-benchmark evaluate` trains what the rows need, measures them and writes Documentation~/accuracy-and-time.md;
it needs the native library (`./run build`) and hours of computing. The other commands measure one property each.
To train and export a model of your own, `haptoflow-training` is enough.
"""


def main(arguments: Sequence[str] | None = None) -> int:
    """`haptoflow-benchmark`; returns the exit code."""
    return run_program("haptoflow-benchmark", _DESCRIPTION, _COMMANDS, arguments)


if __name__ == "__main__":
    sys.exit(main())
