"""`haptoflow-paper velocity`: which estimate of the tip's velocity, on strokes whose true velocity is known."""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path

from tqdm import tqdm

from haptoflow_benchmark.engine_render import read_recorded_strokes
from haptoflow_paper.studies.velocity_cases import person_of
from haptoflow_paper.studies.velocity_study import VelocityPlan, page_words, run_study, steps_of
from haptoflow_training.errors import InputError
from haptoflow_training.model_stamp import read_measured_page, with_measured_words
from haptoflow_training.training.run_log import source_commit
from haptoflow_training.whole_file import check_writable, write_json, write_whole

_EXAMPLES = """examples:
  haptoflow-paper velocity --engine build/native/haptoflow \\
    --strokes ../shared/strokes/vr-pen-on-surface/strokes.csv \\
    --results Training/haptoflow_paper/results/velocity.json --page Training/haptoflow_paper/results/velocity.md

Settings are chosen on the persons of --choosing, figures are those of the others. The product's row comes from
`haptoflow contact`. It takes some minutes.
"""


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.description = (
        "Estimate velocities of real strokes, scribbles, reversals, stops and starts, slow strokes and rest by several "
        "estimators and by the product, at 72 to 500 Hz with 0 to 0.1 mm of noise, and write their errors."
    )
    parser.epilog = _EXAMPLES
    parser.add_argument("--engine", required=True, type=Path, help="built command line (build/native/haptoflow)")
    parser.add_argument("--strokes", required=True, type=Path, help="CSV: stroke_id,t_s,x_m,y_m,z_m")
    parser.add_argument("--choosing", nargs="+", default=["1", "3", "5"], help="persons (default 1 3 5)")
    parser.add_argument("--rates", nargs="+", type=float, help="Hz of the reported figures (default 72 90 120 500)")
    parser.add_argument("--workers", type=int, default=2, help="processes (default 2)")
    parser.add_argument("--results", required=True, type=Path, help="JSON file to write")
    parser.add_argument("--page", type=Path, help="page whose measured part is replaced")


def run(options: argparse.Namespace) -> int:
    strokes = read_recorded_strokes(options.strokes)
    if any(name.count("/") < 1 for name in strokes):
        raise InputError(f"{options.strokes}: names of strokes must hold the person, as in Study1/4/circle")
    persons = {person_of(name) for name in strokes}
    if not set(options.choosing) < persons:
        given, known = " ".join(options.choosing), " ".join(sorted(persons))
        raise InputError(f"--choosing {given}: expected some of {known}, not all")
    for place in (options.results, options.page):
        if place is not None:
            check_writable(place)
    page = None if options.page is None else read_measured_page(options.page)
    plan = VelocityPlan(strokes, tuple(sorted(options.choosing)), options.engine, workers=options.workers)
    if options.rates:
        plan = replace(plan, rates_hz=tuple(options.rates))
    with tqdm(total=steps_of(plan), unit="row") as progress:
        rows = run_study(plan, lambda: progress.update(1))
    results = {
        "commit": source_commit(Path(__file__).parent),
        "choosing": list(plan.choosing),
        "reporting": list(plan.reporting),
        "rows": rows,
    }
    write_json(options.results, results)
    words = page_words(results)
    if options.page is not None and page is not None:
        write_whole(options.page, with_measured_words(page, words).encode())
    print(words)
    return 0
