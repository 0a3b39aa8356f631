"""`haptoflow-benchmark evaluate --model FILE --recordings PATH`: compare a model with own recordings."""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

from tqdm import tqdm

from haptoflow_benchmark.commands.own_parts import own_parts, require_engine
from haptoflow_benchmark.own_model.own_accuracy import RenderedPart, label_accuracy, render_parts
from haptoflow_benchmark.own_model.own_report import lines, write_own_report
from haptoflow_training.errors import InputError
from haptoflow_training.model_stamp import SHIPPED_MODEL, sha256_of


def run(options: argparse.Namespace) -> int:
    """Print the table; with --out, write it with its figures and the picture into that folder."""
    model = options.model or Path(__file__).resolve().parents[3] / SHIPPED_MODEL
    require_engine(options.engine)
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        parts = own_parts(options, model, folder).held_out
        with tqdm(total=len(parts), unit="part", desc="render") as bar:
            rendered = render_parts(parts, engine=options.engine, model=model, folder=folder, advance=bar.update)
    by_label: dict[str, list[RenderedPart]] = {}
    for entry in rendered:
        by_label.setdefault(entry.part.label, []).append(entry)
    measured = {label: label_accuracy(label, entries) for label, entries in by_label.items()}
    for label in [label for label, one in measured.items() if one is None]:
        print(f"{label}: left out: no 0.2 s of its held-out parts in which the tip moves", file=sys.stderr)
    found = [one for one in measured.values() if one is not None]
    if not found:
        raise InputError("no held-out part is long enough: record 5 s of each label at least, with a tip that moves")
    print("\n".join(lines(found)))
    if options.own_out is not None:
        write_own_report(options.own_out, found, by_label, sha256_of(model))
        print(f"evaluate: {options.own_out / 'own-accuracy.json'}, .md and .png")
    return 0
