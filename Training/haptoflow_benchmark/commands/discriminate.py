"""`haptoflow-benchmark discriminate`: check that a classifier trained on recordings recognises rendered labels."""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path

from tqdm import tqdm

from haptoflow_benchmark.commands.evaluate import ENGINE, add_recording_options, own_parts, require_engine
from haptoflow_benchmark.label_discrimination import (
    DiscriminationReport, discriminate, discriminate_parts, train_classifier, write_report
)
from haptoflow_training.model_stamp import SHIPPED_MODEL, sha256_of
from haptoflow_training.recordings.synthetic import load_materials

_ROOT = Path(__file__).resolve().parents[3]
# Of each label: recordings that train the classifier, and strokes that are rendered and classified.
_RECORDINGS, _STROKES = 16, 4
_PROCESSES = 2


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.description = (
        "Trains a simple classifier (third-octave spectrum and level, given the stroke's speed and force) on "
        "synthetic hand recordings, renders held-out strokes with the engine's command line, and counts how often "
        "the classifier recognises the label. Recordings of the same strokes are classified too, as an upper "
        "bound. With --recordings, the classifier is trained on the training part of these recordings, and the "
        "held-out parts are rendered and classified."
    )
    parser.epilog = (
        "example:\n  haptoflow-benchmark discriminate --engine build/native/haptoflow"
        " --out Training/results\n"
        "  haptoflow-benchmark discriminate --model own.haptoflow --recordings recordings --out out/own/discrimination"
    )
    parser.add_argument(
        "--engine", type=Path, default=ENGINE, help="the built command line (default: build/native/haptoflow)"
    )
    add_recording_options(parser)
    parser.add_argument(
        "--model", type=Path, default=_ROOT / SHIPPED_MODEL, help="the .haptoflow file (default: the shipped one)"
    )
    parser.add_argument(
        "--seed", type=int, default=1001, help="seed of all recordings; the model's training used others"
    )
    parser.add_argument("--out", type=Path, required=True, help="folder of the report (JSON, Markdown, picture)")


def run(options: argparse.Namespace) -> int:
    require_engine(options.engine)
    if options.recordings:
        return _run_own(options)
    materials = load_materials()
    bar = tqdm(total=len(materials) * (_RECORDINGS + _STROKES), unit="recording")
    classifier = train_classifier(materials, _RECORDINGS, options.seed, bar.update, _PROCESSES)
    with tempfile.TemporaryDirectory() as folder:
        report: DiscriminationReport = discriminate(
            classifier,
            materials,
            engine=options.engine,
            model=options.model,
            strokes_per_label=_STROKES,
            seed=options.seed + 1,
            folder=Path(folder),
            advance=bar.update,
        )
    bar.close()
    return _report(options, report)


def _run_own(options: argparse.Namespace) -> int:
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        parts = own_parts(options, options.model, folder)
        with tqdm(total=len(parts.held_out), unit="part", desc="render") as bar:
            report = discriminate_parts(
                parts.seen, parts.held_out, engine=options.engine, model=options.model, seed=options.seed, folder=folder,
                advance=bar.update,
            )  # fmt: skip
    return _report(options, report)


def _report(options: argparse.Namespace, report: DiscriminationReport) -> int:
    write_report(report, options.out, sha256_of(options.model))
    print(
        f"named right: {report.render_accuracy:.1%} of {len(report.outcomes)} renders, "
        f"{report.recording_accuracy:.1%} of the recordings of the same strokes; "
        f"level order of the labels: Spearman {report.level_order_spearman:.3f}; "
        f"level error: median {report.level_error_median_db:+.2f} dB, 90 % within {report.level_error_p90_db:.2f} dB"
    )
    return 0
