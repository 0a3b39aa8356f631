"""`haptoflow-paper`: the comparison behind the published tables. Exit codes as `haptoflow-training`."""

from __future__ import annotations

from collections.abc import Sequence

from haptoflow_training.cli import run_program

_COMMANDS = {
    "evaluate": "measure accuracy and time of every row of the plan",
    "few-shot": "measure materials fitted to ten seconds of recording, beside rivals",
    "place": "measure whether a place of a surface feels the same twice",
    "velocity": "measure estimates of the velocity of the tip on strokes of known velocity",
    "import-published": "turn the authors' published weights into a model file of the engine",
    "check-published": "check a model file on this machine: parity, levels, times, one report to send",
    "distil": "train what ships on what a flow model generates, and compare them",
    "train": "`haptoflow-training train` for rivals, codecs, their objectives and ablations too",
    "train-codec": "train the small codec whose latents some rows work on",
    "export": "`haptoflow-training export` for rivals, codecs, their objectives and ablations too",
}
_DESCRIPTION = """Measures what the published tables state: the product's models beside rivals (transformer, DSTN, SPSI,
autoregressive), latent codecs, reflow and mean flow, one row for each method and configuration.
`haptoflow-paper evaluate` trains what the rows need, measures them and writes results/accuracy-and-time.md;
it needs the native library (`./run build`) and hours of computing.
To train and export a model of your own, `haptoflow-training` is enough; `haptoflow-benchmark` measures it.
"""


def main(arguments: Sequence[str] | None = None) -> int:
    """`haptoflow-paper`; returns the exit code."""
    return run_program("haptoflow-paper", _DESCRIPTION, _COMMANDS, arguments, borrowed=("train", "export"))
