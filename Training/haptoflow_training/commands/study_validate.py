"""`haptoflow-training study validate`: check the analysis on simulated studies with known results."""

from __future__ import annotations

import argparse
import json
from pathlib import Path

from tqdm import tqdm

from haptoflow_training.errors import InputError
from haptoflow_training.model_stamp import read_measured_page, with_measured_words
from haptoflow_training.whole_file import write_whole

_EXAMPLES = """examples:
  haptoflow-training study validate --out Training/results/study-validation.json --page Documentation~/study-analysis.md
  haptoflow-training study validate --studies 20 --simulations 100 --out first-look.json

About ten minutes of one core.
"""


def register(parser: argparse.ArgumentParser) -> None:
    parser.description = (
        "Simulate studies with a known truth, analyse them, and count how often thresholds, differences and their "
        "absence are found as they should be."
    )
    parser.epilog = _EXAMPLES
    parser.add_argument("--out", required=True, type=Path, help="JSON file to write")
    parser.add_argument("--page", type=Path, help="page whose measured part is written anew")
    parser.add_argument("--studies", type=int, default=200, help="written as logs and analysed whole (default 200)")
    parser.add_argument("--simulations", type=int, default=2000, help="of each single question (default 2000)")
    parser.add_argument("--seed", type=int, default=1, help="0 or more (default 1)")
    parser.set_defaults(run=_run)


def _run(options: argparse.Namespace) -> int:
    from haptoflow_training.studies.validation import steps_of, validated
    from haptoflow_training.studies.validation_words import page_words

    for name, lowest in (("studies", 2), ("simulations", 2), ("seed", 0)):
        if getattr(options, name) < lowest:
            raise InputError(f"--{name} {getattr(options, name)}: expected {lowest} or more")
    if options.page is not None:
        read_measured_page(options.page)
    with tqdm(total=steps_of(options.studies, options.simulations), unit="study", disable=None) as progress:
        found = validated(
            studies=options.studies, simulations=options.simulations, seed=options.seed, advance=progress.update
        )
    write_whole(options.out, (json.dumps(found, indent=1) + "\n").encode())
    words = page_words(found)
    if options.page is not None:
        write_whole(options.page, with_measured_words(read_measured_page(options.page), words).encode())
    print(words)
    return 0
