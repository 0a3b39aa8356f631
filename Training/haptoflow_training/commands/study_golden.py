"""`haptoflow-training study golden`: write the test vectors of the study plans."""

from __future__ import annotations

import argparse
from pathlib import Path

from haptoflow_training.studies.golden import golden_text
from haptoflow_training.whole_file import write_whole

_EXAMPLES = """examples:
  haptoflow-training study golden --out Tests/Golden/studies/plans.json

Write it anew only when the plans are meant to change, because participants' numbers then mean other orders.
"""


def register(parser: argparse.ArgumentParser) -> None:
    parser.description = "Write plans of several participants, seeds and sizes, which the Unity package must reproduce."
    parser.epilog = _EXAMPLES
    parser.add_argument("--out", required=True, type=Path, help="JSON file to write")
    parser.set_defaults(run=_run)


def _run(options: argparse.Namespace) -> int:
    write_whole(options.out, golden_text().encode())
    print(f"{options.out}: written")
    return 0
