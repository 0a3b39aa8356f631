"""`haptoflow-paper`: the comparison behind the published tables. Exit codes as `haptoflow-training`."""

from __future__ import annotations

import sys
from collections.abc import Sequence

from haptoflow_training.cli import Command, run_program


def _command(summary: str, name: str) -> Command:
    return Command(summary, f"haptoflow_paper.commands.{name}")


_COMMANDS = {
    "evaluate": _command("measure accuracy and time of every row of the plan", "evaluate"),
    "few-shot": _command("measure materials fitted to ten seconds of recording, beside rivals", "few_shot"),
    "train": Command(
        "`haptoflow-training train` for rivals, codecs, their objectives and ablations too",
        "haptoflow_training.commands.train",
    ),
    "train-codec": _command("train the small codec whose latents some rows work on", "train_codec"),
    "export": Command(
        "`haptoflow-training export` for rivals, codecs, their objectives and ablations too",
        "haptoflow_training.commands.export",
    ),
}
_DESCRIPTION = """Measures what the published tables state: the product's models beside rivals (transformer, DSTN, SPSI,
autoregressive), latent codecs, reflow and mean flow, one row for each method and configuration.
`haptoflow-paper evaluate` trains what the rows need, measures them and writes Documentation~/accuracy-and-time.md;
it needs the native library (`./run build`) and hours of computing.
To train and export a model of your own, `haptoflow-training` is enough; `haptoflow-benchmark` measures it.
"""


def main(arguments: Sequence[str] | None = None) -> int:
    """`haptoflow-paper`; returns the exit code."""
    return run_program("haptoflow-paper", _DESCRIPTION, _COMMANDS, arguments)


if __name__ == "__main__":
    sys.exit(main())
