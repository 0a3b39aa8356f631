"""`haptoflow-training study check`: list the problems of a folder of logs."""

from __future__ import annotations

import argparse
from pathlib import Path

from haptoflow_training.studies.log_columns import STUDIES
from haptoflow_training.studies.study_folder import read_folder

_EXAMPLES = """examples:
  haptoflow-training study check logs

Every problem is a line that names file, row and column. The exit code is 0 without problems, 3 with some.
"""


def register(parser: argparse.ArgumentParser) -> None:
    parser.description = "Read every session below a folder and list what is broken, missing or duplicate."
    parser.epilog = _EXAMPLES
    parser.add_argument("folder", type=Path, help="with the logs, in folders of their own or not")
    parser.set_defaults(run=_run)


def _run(options: argparse.Namespace) -> int:
    read = read_folder(options.folder)
    for problem in read.problems:
        print(problem)
    for note in read.notes:
        print(f"note: {note}")
    for study in STUDIES:
        sessions = read.of(study)
        if sessions:
            simulated = sum(session.is_simulated for session in sessions)
            trials = sum(len(session.rows) for session in sessions)
            print(f"{study}: {len(sessions)} sessions, {simulated} of them simulated, {trials} answered trials")
    print(f"{len(read.problems)} problem{'' if len(read.problems) == 1 else 's'}")
    return 3 if read.problems else 0
