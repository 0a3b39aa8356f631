"""`haptoflow-paper few-shot`: measure materials fitted to seconds of recording, on materials unknown to the
model."""

from __future__ import annotations

import argparse
import os
from pathlib import Path

from tqdm import tqdm

from haptoflow_paper.studies.few_shot_cases import SECONDS, filtered_surfaces, study_materials
from haptoflow_paper.studies.few_shot_report import (
    assembled,
    curve_table,
    page_words,
    rib_words,
    table,
    write_chart,
    write_results,
)
from haptoflow_paper.studies.few_shot_study import StudyPlan, cells_of, with_trained
from haptoflow_training.export.model_file import read_model_file
from haptoflow_training.model_stamp import read_measured_page, sha256_of, with_measured_words
from haptoflow_training.whole_file import check_writable, write_whole

_EXAMPLES = """examples:
  haptoflow-paper few-shot --model default.haptoflow --engine build/native/haptoflow --results few-shot.json
  haptoflow-paper few-shot --model mine.haptoflow --engine build/native/haptoflow --materials 4 --results mine.json

An interrupted study is resumed when it is started again with the same --work folder. It takes about a minute and a half
of one core for each material.
"""


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.description = (
        "Learn materials unknown to the model from 5, 10, 20 and 60 s of recording, beside autoregressive models, and "
        "write figures with intervals."
    )
    parser.epilog = _EXAMPLES
    parser.add_argument("--model", required=True, type=Path, help=".haptoflow file trained on the recorder's labels")
    parser.add_argument("--engine", required=True, type=Path, help="built command line (build/native/haptoflow)")
    parser.add_argument("--results", required=True, type=Path, help="JSON file to write")
    parser.add_argument("--chart", type=Path, help="PNG file to write")
    parser.add_argument("--page", type=Path, help="page whose measured part is replaced, with --chart's picture")
    parser.add_argument("--work", type=Path, default=Path("build/few-shot"), help="folder for finished cells")
    parser.add_argument("--materials", type=int, default=10, help="how many held-out materials of each kind (default 10)")
    parser.add_argument("--seed", type=int, default=2026, help="of materials, recordings and fits (default 2026)")


def run(options: argparse.Namespace) -> int:
    if options.page is not None:
        read_measured_page(options.page)
    for place in (options.results, options.chart, options.page):
        if place is not None:
            check_writable(place)
    model = read_model_file(options.model)
    plan = StudyPlan(options.model, options.engine, options.work, options.seed)
    materials = [
        *study_materials(options.materials, options.seed),
        *filtered_surfaces(options.materials, options.seed),
    ]
    with tqdm(total=len(materials), unit="material") as progress:
        cells = [cells_of(plan, model, material, lambda: progress.update(1) and None) for material in materials]
    with tqdm(total=len(plan.seconds), unit="training") as progress:
        cells = with_trained(plan, materials, cells, progress.update)
    header = {
        "model": model.header["name"],
        "model_sha256": sha256_of(options.model),
        "seed": options.seed,
        "seconds": list(SECONDS),
    }
    results = assembled(cells, header)
    write_results(options.results, results)
    if options.chart is not None:
        write_chart(options.chart, results)
    if options.page is not None:
        chart = options.chart or options.page.parent / "images" / "few-shot.png"
        address = Path(os.path.relpath(chart, options.page.parent)).as_posix()
        page = with_measured_words(read_measured_page(options.page), page_words(results, address))
        write_whole(options.page, page.encode())
    print(table(results, 10.0))
    print()
    print(curve_table(results, "lsd_median_db"))
    print()
    print(rib_words(results))
    return 0
