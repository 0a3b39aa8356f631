"""`haptoflow-benchmark learn-figures`: measure `haptoflow learn` on materials unknown to the model."""

from __future__ import annotations

import argparse
import json
import tempfile
from dataclasses import asdict
from pathlib import Path

from tqdm import tqdm

from haptoflow_benchmark.few_shot.few_shot_cases import make_case
from haptoflow_benchmark.few_shot.learn_figures import SECONDS, chosen_materials, measured, table
from haptoflow_training.export.model_file import read_model_file
from haptoflow_training.model_stamp import model_line, sha256_of
from haptoflow_training.models.file_model import FileModel
from haptoflow_training.whole_file import write_whole

_EXAMPLES = """examples:
  haptoflow-benchmark learn-figures --model default.haptoflow --engine build/native/haptoflow
  haptoflow-benchmark learn-figures --model mine.haptoflow --engine build/native/haptoflow --plain 2 --ruled 1

About 15 s of one core for each material.
"""


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.description = (
        "Fit materials unknown to the model with `haptoflow learn` to ten seconds each, render them at six "
        "speeds, and print the errors of level and spectrum against another specimen of the material."
    )
    parser.epilog = _EXAMPLES
    parser.add_argument("--model", required=True, type=Path, help=".haptoflow file trained on the recorder's labels")
    parser.add_argument("--engine", required=True, type=Path, help="built command line (build/native/haptoflow)")
    parser.add_argument("--results", type=Path, help="JSON file to write")
    parser.add_argument("--plain", type=int, default=9, help="how many materials without ribs (default 9)")
    parser.add_argument("--ruled", type=int, default=3, help="how many with ribs (default 3)")
    parser.add_argument("--seed", type=int, default=2026, help="of materials, recordings and fits (default 2026)")


def run(options: argparse.Namespace) -> int:
    model = FileModel(read_model_file(options.model))
    figures = []
    with tempfile.TemporaryDirectory() as folder:
        for material in tqdm(chosen_materials(options.plain, options.ruled, options.seed), unit="material"):
            case = make_case(material, options.seed, SECONDS)
            figures.append(measured(options.engine, model, options.model, case, Path(folder), options.seed))
    sha256 = sha256_of(options.model)
    if options.results is not None:
        content = {"model_sha256": sha256, "seed": options.seed, "materials": [asdict(each) for each in figures]}
        write_whole(options.results, (json.dumps(content, indent=1) + "\n").encode())
    print(model_line(sha256))
    for ruled in (False, True):
        if any(bool(each.families) == ruled for each in figures):
            print(f"\n{table(figures, ruled=ruled)}")
    families, found, wrong = (sum(getattr(each, name) for each in figures) for name in ("families", "found", "wrong"))
    print(f"\nFamilies of ribs: {found} of {families} found within 2 %, {wrong} wrong.")
    print(f"Learning took {sum(each.core_seconds for each in figures) / len(figures):.1f} s of one core a material.")
    return 0
