"""`haptoflow-training`: one entry, one subcommand a module, imported only when it is asked for.

Exit codes: 0 done, 2 wrong usage, 3 bad input, 4 internal error.
"""

from __future__ import annotations

import argparse
import importlib
import sys
from collections.abc import Sequence

from haptoflow_training.errors import InputError

_COMMANDS: dict[str, str] = {
    "record": "record synthetic recordings in the published data set's layout",
    "report-recorder": "compare the synthetic recorder with its published targets, per material",
    "inspect": "count and validate the recordings of a data set folder",
    "prepare": "turn recordings into memory-mapped 2 kHz training arrays",
    "train": "train the level model and the network from one TOML file, resumable",
    "train-tiers": "train a model file with several tiers over one embedding and level",
    "train-codec": "train the small codec behind latent tiers",
    "export": "write a trained run into a .haptoflow model file",
    "add-material": "add a material to a model, or write a material file, from ten seconds of recording",
    "few-shot": "measure what ten seconds of a material give, beside rivals",
    "learn-figures": "measure what `haptoflow learn` makes of ten seconds of a material",
    "sliders": "find a designer's sliders in a model's embedding space",
    "stroke": "write a hand-like stroke as CSV for `haptoflow render`",
    "evaluate": "accuracy over time: every row of the plan, measured through the engine",
    "discriminate": "check that a classifier trained on recordings names what the engine renders",
    "measure-wave-vectors": "count the ribs that are found, missed and made up from seconds of strokes",
    "study": "the two user studies: simulate, check, merge and analyse their logs",
    "measure-full-scale": "which acceleration should be +-1, from recorded strokes on every label",
}


def _parser(chosen: str | None) -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="haptoflow-training",
        description="Recordings in, a .haptoflow model file out.",
        epilog="`haptoflow-training COMMAND --help` explains one command with examples.",
    )
    subparsers = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for name, summary in _COMMANDS.items():
        if name == chosen:
            module = importlib.import_module(f"haptoflow_training.commands.{name.replace('-', '_')}")
            module.register(subparsers, summary)
        else:
            subparsers.add_parser(name, help=summary, add_help=False)
    return parser


def main(arguments: Sequence[str] | None = None) -> int:
    words = list(sys.argv[1:] if arguments is None else arguments)
    chosen = next((word for word in words if word in _COMMANDS), None)
    options = _parser(chosen).parse_args(words)
    try:
        return int(options.run(options))
    except InputError as error:
        print(f"haptoflow-training: {error}", file=sys.stderr)
        return 3
    except BrokenPipeError:
        return 0


if __name__ == "__main__":
    sys.exit(main())
