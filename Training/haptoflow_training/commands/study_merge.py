"""`haptoflow-training study merge`: write one table for each study."""

from __future__ import annotations

import argparse
from pathlib import Path

from haptoflow_training.errors import InputError
from haptoflow_training.studies.log_columns import STUDIES
from haptoflow_training.studies.session_writer import merged_csv
from haptoflow_training.studies.study_folder import read_faultless
from haptoflow_training.whole_file import write_whole

_EXAMPLES = """examples:
  haptoflow-training study merge logs --out tables

writes tables/latency.csv and tables/similarity.csv, as far as there are sessions, for a statistics program of your own.
"""


def register(parser: argparse.ArgumentParser) -> None:
    parser.description = "Write all sessions of a study as one table, a row an answered trial, practice included."
    parser.epilog = _EXAMPLES
    parser.add_argument("folder", type=Path, help="with the logs")
    parser.add_argument("--out", required=True, type=Path, help="another folder, for the tables")
    parser.set_defaults(run=_run)


def _run(options: argparse.Namespace) -> int:
    folder, out = options.folder.resolve(), options.out.resolve()
    if out == folder or folder in out.parents:
        raise InputError(f"{options.out}: lies in the folder of the logs, where only logs may be; name another folder")
    read = read_faultless(options.folder)
    for study in STUDIES:
        sessions = read.of(study)
        if sessions:
            path = options.out / f"{study}.csv"
            write_whole(path, merged_csv(study, sessions).encode())
            print(f"{path}: {len(sessions)} sessions, {sum(len(session.rows) for session in sessions)} trials")
    for note in read.notes:
        print(f"note: {note}")
    return 0
