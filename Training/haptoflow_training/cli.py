"""`haptoflow-training`: one program, one subcommand a module; a subcommand's module is imported only when it is used.

Exit codes: 0 done, 2 wrong usage, 3 bad input, 4 internal error, 128 and a signal's number where it ended the program.
"""

from __future__ import annotations

import argparse
import importlib
import io
import sys
from collections.abc import Collection, Mapping, Sequence

from haptoflow_training.errors import InputError, printable
from haptoflow_training.stopping import Stopped, stoppable
from haptoflow_training.whole_file import require_apart


_COMMANDS = {
    "record": "record synthetic recordings in the published data set's layout",
    "report-recorder": "compare the synthetic recorder with its published targets, material by material",
    "inspect": "count and validate the recordings of a data set folder",
    "labels": "write a labels file for textures of the published data set",
    "prepare": "turn recordings into memory-mapped 2 kHz training arrays",
    "train": "train one run from a TOML file: labels of your own, a skeleton, or a network; resumable",
    "train-tiers": "train a whole model file as the shipped one: several tiers over one embedding, level and skeleton",
    "export": "write a trained run into a .haptoflow model file",
    "add-material": "add a material to a model, or write a material file, from ten seconds of recording",
    "sliders": "find a designer's sliders in a model's embedding space",
    "stroke": "write a hand-like stroke as CSV for `haptoflow render`",
    "study": "the two user studies: simulate, check, merge and analyse their logs",
}
_DESCRIPTION = """Turns recordings into a .haptoflow model file: reads or synthesises recordings, prepares them, trains
skeletons and networks and exports them; adds materials from seconds of recording; analyses the user studies.
`haptoflow-benchmark` measures a model; `haptoflow-paper` compares it with rivals.
"""


def run_program(
    name: str,
    description: str,
    commands: Mapping[str, str],
    arguments: Sequence[str] | None = None,
    borrowed: Collection[str] = (),
) -> int:
    """Run the subcommand that `arguments` (default: those of this process) name; returns the exit code.

    commands: each one's line in the list of commands. The command `a-b` is the module commands.a_b of the program's
    package, or of this one if it is borrowed. The module has `add_options(parser)`, and `run(options)`, which returns
    the exit code.
    """
    words = list(sys.argv[1:] if arguments is None else arguments)
    # Names of files and cells of tables are bytes, which need not be text in the terminal's encoding.
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="backslashreplace")
    chosen = next((word for word in words if word in commands), None)
    parser = argparse.ArgumentParser(
        prog=name,
        description=description,
        epilog=f"`{name} COMMAND --help` explains one command with examples.",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    subparsers = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for key, summary in commands.items():
        if key == chosen:
            package = "haptoflow-training" if key in borrowed else name
            module = importlib.import_module(f"{package}.commands.{key}".replace("-", "_"))
            layout = argparse.RawDescriptionHelpFormatter
            subparser = subparsers.add_parser(key, help=summary, formatter_class=layout)
            module.add_options(subparser)
            # A command with steps of its own sets `run` itself.
            if hasattr(module, "run"):
                subparser.set_defaults(run=module.run)
        else:
            subparsers.add_parser(key, help=summary, add_help=False)
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
