"""`haptoflow-training`: one program, one subcommand a module; a subcommand's module is imported only when it is used.

Exit codes: 0 done, 2 wrong usage, 3 bad input, 4 internal error, 128 and a signal's number where it ended the program.
"""

from __future__ import annotations

import argparse
import importlib
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from haptoflow_training.errors import InputError, printable
from haptoflow_training.stopping import Stopped, stoppable
from haptoflow_training.whole_file import require_apart


@dataclass(frozen=True)
class Command:
    """summary: its line in the list of commands. module: has `register(subparsers, summary)`, which adds a parser whose
    default `run` takes the options and returns the exit code."""

    summary: str
    module: str


def _command(summary: str, name: str) -> Command:
    return Command(summary, f"haptoflow_training.commands.{name}")


_COMMANDS = {
    "record": _command("record synthetic recordings in the published data set's layout", "record"),
    "report-recorder": _command(
        "compare the synthetic recorder with its published targets, material by material", "report_recorder"
    ),
    "inspect": _command("count and validate the recordings of a data set folder", "inspect"),
    "prepare": _command("turn recordings into memory-mapped 2 kHz training arrays", "prepare"),
    "train": _command("train the level model and the network from one TOML file; resumable", "train"),
    "train-tiers": _command("train a model file with several tiers over one embedding and level model", "train_tiers"),
    "export": _command("write a trained run into a .haptoflow model file", "export"),
    "add-material": _command(
        "add a material to a model, or write a material file, from ten seconds of recording", "add_material"
    ),
    "sliders": _command("find a designer's sliders in a model's embedding space", "sliders"),
    "stroke": _command("write a hand-like stroke as CSV for `haptoflow render`", "stroke"),
    "study": _command("the two user studies: simulate, check, merge and analyse their logs", "study"),
}
_DESCRIPTION = """Turns recordings into a .haptoflow model file: reads or synthesises recordings, prepares them, trains the
networks and exports them; adds materials from seconds of recording; analyses the user studies.
`haptoflow-benchmark` measures a model; `haptoflow-paper` compares it with rivals.
"""


def run_program(
    name: str, description: str, commands: Mapping[str, Command], arguments: Sequence[str] | None = None
) -> int:
    """Run the subcommand that `arguments` (default: those of this process) name; returns the exit code."""
    words = list(sys.argv[1:] if arguments is None else arguments)
    chosen = next((word for word in words if word in commands), None)
    parser = argparse.ArgumentParser(
        prog=name,
        description=description,
        epilog=f"`{name} COMMAND --help` explains one command with examples.",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    subparsers = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for key, command in commands.items():
        if key == chosen:
            importlib.import_module(command.module).register(subparsers, command.summary)
        else:
            subparsers.add_parser(key, help=command.summary, add_help=False)
    options = parser.parse_args(words)
    try:
        require_apart(vars(options))
        with stoppable():
            return int(options.run(options))
    except InputError as error:
        print(f"{name}: {printable(str(error))}", file=sys.stderr)
        return 3
    except Stopped as stop:
        print(f"{name}: {stop}", file=sys.stderr)
        return stop.exit_code
    except BrokenPipeError:
        return 0


def main(arguments: Sequence[str] | None = None) -> int:
    """`haptoflow-training`; returns the exit code."""
    return run_program("haptoflow-training", _DESCRIPTION, _COMMANDS, arguments)


if __name__ == "__main__":
    sys.exit(main())
