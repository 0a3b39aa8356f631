"""`haptoflow-benchmark evaluate`: compare a model with own recordings."""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

from tqdm import tqdm

from haptoflow_benchmark.commands.own_parts import ENGINE, OwnParts, add_recording_options, own_parts, require_engine
from haptoflow_benchmark.own_accuracy import (
    LabelAccuracy, RenderedPart, Verdict, label_accuracy, lines, render_learnt, render_parts, verdict, write_own_report
)
from haptoflow_training.errors import InputError
from haptoflow_training.model_stamp import SHIPPED_MODEL, sha256_of

_ROOT = Path(__file__).resolve().parents[3]
_NOT_WORTH_USING = 3


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.description = (
        "Compares a model with recordings of your own: the held-out parts are rendered by the engine, and level, "
        "GFC and LSD of each label are printed; --out also writes them, with a picture."
    )
    parser.epilog = (
        "example:\n"
        "  haptoflow-benchmark evaluate --model own.haptoflow --recordings recordings --out out/own/accuracy\n"
        "The rows of the table of accuracy and time are measured by `haptoflow-paper evaluate`."
    )
    add_recording_options(parser)
    parser.add_argument(
        "--model", type=Path, default=_ROOT / SHIPPED_MODEL, metavar="FILE",
        help="the model file (default: the shipped one)",
    )  # fmt: skip
    parser.add_argument(
        "--engine", type=Path, default=ENGINE, help="the built command line (default: build/native/haptoflow)"
    )
    parser.add_argument(
        "--beside-learn", action="store_true",
        help="also learn each label from the recordings that the model was trained on (about 7 s each), and say whether the "
        "model is worth using; the exit code is 3 if it is not",
    )  # fmt: skip
    parser.add_argument("--out", type=Path, help="for own-accuracy.json, .md and .png (default: printed only)")


def run(options: argparse.Namespace) -> int:
    """Print the table; with --out, write it with its figures and the picture into that folder."""
    model = options.model
    require_engine(options.engine)
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        parts = own_parts(options, model, folder)
        with tqdm(total=len(parts.held_out), unit="part", desc="render") as bar:
            rendered = render_parts(
                parts.held_out, engine=options.engine, model=model, folder=folder, advance=bar.update
            )
        by_label, found = _measured(rendered)
        print("\n".join(lines(found)))
        decided = _beside_learning(options, parts, found, folder) if options.beside_learn else None
    if options.out is not None:
        write_own_report(options.out, found, by_label, sha256_of(model))
        print(f"evaluate: {options.out / 'own-accuracy.json'}, .md and .png")
    if decided is not None:
        print(decided.words)
    return _NOT_WORTH_USING if decided is not None and decided.is_worse else 0


def _measured(rendered: list[RenderedPart]) -> tuple[dict[str, list[RenderedPart]], list[LabelAccuracy]]:
    by_label: dict[str, list[RenderedPart]] = {}
    for entry in rendered:
        by_label.setdefault(entry.part.label, []).append(entry)
    measured = {label: label_accuracy(label, entries) for label, entries in by_label.items()}
    for label in [label for label, one in measured.items() if one is None]:
        print(f"{label}: left out: no 0.2 s of its held-out parts in which the tip moves", file=sys.stderr)
    found = [one for one in measured.values() if one is not None]
    if not found:
        raise InputError("no held-out part is long enough: record 5 s of each label at least, with a tip that moves")
    return by_label, found


def _beside_learning(options: argparse.Namespace, parts: OwnParts, found: list[LabelAccuracy], folder: Path) -> Verdict:
    compared = {one.label for one in found}
    held_out = [part for part in parts.held_out if part.label in compared]
    with tqdm(total=len(compared), unit="label", desc="haptoflow learn") as bar:
        rendered = render_learnt(
            parts.seen, held_out, parts.turned_degrees,
            base=_ROOT / SHIPPED_MODEL, engine=options.engine, folder=folder, advance=bar.update,
        )  # fmt: skip
    return verdict(found, _measured(rendered)[1])
