"""`haptoflow-training sliders`: find directions in a model's embedding space that a designer can move along."""

from __future__ import annotations

import argparse
from pathlib import Path

from haptoflow_training.export.model_file import read_model_file
from haptoflow_training.export.sliders import find_sliders, write_sliders
from haptoflow_training.recordings.synthetic.materials import load_materials

_EXAMPLES = """examples:
  haptoflow-training sliders --model default.haptoflow -o default.sliders.json
  haptoflow-training sliders --model mine.haptoflow --materials my-materials.toml -o mine.sliders.json
"""


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.description = (
        "Find what coarseness, hardness, regularity, stickiness and level are in a model's embedding "
        "space, from the parameters that the synthetic recorder has of the model's labels."
    )
    parser.epilog = _EXAMPLES
    parser.add_argument("--model", required=True, type=Path, help=".haptoflow file trained on the recorder's labels")
    parser.add_argument("-o", "--out", required=True, type=Path, help="file to write, for example default.sliders.json")
    parser.add_argument("--materials", type=Path, help="materials.toml of the recorder (default: the shipped one)")


def run(options: argparse.Namespace) -> int:
    sliders = find_sliders(read_model_file(options.model), load_materials(options.materials))
    write_sliders(options.out, sliders)
    print(f"{options.out}: {', '.join(sliders.directions)} and level, for models of space {sliders.space}")
    return 0
