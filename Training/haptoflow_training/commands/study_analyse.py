"""`haptoflow-training study analyse`: write the report of a folder of logs."""

from __future__ import annotations

import argparse
import json
from pathlib import Path

from haptoflow_training.errors import InputError
from haptoflow_training.studies.log_columns import LATENCY, SIMILARITY
from haptoflow_training.studies.study_folder import read_faultless
from haptoflow_training.whole_file import write_whole

_EXAMPLES = """examples:
  haptoflow-training study analyse logs --out report.html
  haptoflow-training study analyse logs --out report.html --results results.json

The report is one file with its figures inside. Logs with a problem are refused; `study check` names all problems.
"""


def register(parser: argparse.ArgumentParser) -> None:
    parser.description = (
        "Fit the psychometric curves, test the ratings, and write one report for the studies whose logs a folder holds."
    )
    parser.epilog = _EXAMPLES
    parser.add_argument("folder", type=Path, help="with the logs")
    parser.add_argument("--out", required=True, type=Path, help="HTML file to write")
    parser.add_argument("--results", type=Path, help="JSON file with the same figures, for programs")
    parser.add_argument("--seed", type=int, default=0, help="of the resamples, 0 or more (default 0)")
    parser.set_defaults(run=_run)


def _run(options: argparse.Namespace) -> int:
    from haptoflow_training.studies.latency_analysis import analyse_latency
    from haptoflow_training.studies.report import Analysed, report, results
    from haptoflow_training.studies.similarity_analysis import (
        MINIMUM_PARTICIPANTS, analyse_similarity, too_few_words,
    )  # fmt: skip

    if options.seed < 0:
        raise InputError(f"--seed {options.seed}: expected 0 or more")
    for out in (options.out, options.results):
        if out is not None and options.folder.resolve() in out.resolve().parents and out.suffix in (".csv", ".json"):
            raise InputError(f"{out}: lies in the folder of the logs, where only logs may be; expected another folder")
    read = read_faultless(options.folder)
    latency, similarity = read.of(LATENCY), read.of(SIMILARITY)
    # A pilot of the one study does not keep back the report of the other.
    is_pilot = bool(latency) and 0 < len(similarity) < MINIMUM_PARTICIPANTS
    analysed = Analysed(
        [*latency, *similarity],
        read.notes,
        analyse_latency(latency, seed=options.seed) if latency else None,
        analyse_similarity(similarity) if similarity and not is_pilot else None,
        too_few_words(len(similarity)) if is_pilot else "",
    )
    write_whole(options.out, report(analysed).encode())
    if options.results is not None:
        write_whole(options.results, (json.dumps(results(analysed), indent=1) + "\n").encode())
    kind = "simulated" if analysed.is_simulated else "real"
    counts = f"{len(latency)} {kind} sessions of the latency study, {len(similarity)} of the similarity study"
    print(f"{options.out}: {counts}")
    return 0
