"""`haptoflow-benchmark measure-wave-vectors`: how often ribs are found in seconds of strokes."""

from __future__ import annotations

import argparse
import json
from pathlib import Path

from tqdm import tqdm

from haptoflow_benchmark.wave_vector_study import measured, study_surfaces
from haptoflow_training.whole_file import write_whole

_EXAMPLES = """examples:
  haptoflow-benchmark measure-wave-vectors --results wave-vectors.json
  haptoflow-benchmark measure-wave-vectors --every 8 --results quick.json

All 68 surfaces take about four minutes of one core, mostly for recording.
"""


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.description = (
        "Estimate the wave vectors of 30 ruled surfaces and of 38 without ribs from 10 and 30 s of strokes, "
        "and count those found, missed and wrong."
    )
    parser.epilog = _EXAMPLES
    parser.add_argument("--results", required=True, type=Path, help="JSON file to write")
    parser.add_argument("--every", type=int, default=1, help="use every Nth surface (default 1: all)")


def run(options: argparse.Namespace) -> int:
    surfaces = list(study_surfaces())[:: max(options.every, 1)]
    with tqdm(total=len(surfaces), unit="surface") as progress:
        results = measured(surfaces, lambda: progress.update(1) and None)
    write_whole(options.results, (json.dumps(results, indent=1) + "\n").encode("utf-8"))
    for seconds, total in results["totals"].items():
        print(
            f"{seconds} s: {total['within_2_percent']} of {total['families']} families of ribs within 2 %, "
            f"{total['within_5_percent']} within 5 %; {total['wrong_on_ruled']} wrong vectors on "
            f"{total['ruled_surfaces']} ruled surfaces, {total['wrong_on_unruled']} on {total['unruled_surfaces']} without"
        )
    return 0
