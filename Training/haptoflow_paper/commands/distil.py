"""`haptoflow-paper distil`: the materials of a flow model, in what ships."""

from __future__ import annotations

import argparse
import os
import time
from pathlib import Path

from tqdm import tqdm

from haptoflow_benchmark.engine_library import default_engine
from haptoflow_paper.runs.distil_comparison import (
    PAGE,
    SPECTRA,
    compare,
    draw_spectra,
    render_held_out,
    steps_of_comparison,
    write_report,
)
from haptoflow_paper.runs.distil_rendering import Rendering, complete, render_all, seconds_of_a_stroke, write_labels
from haptoflow_paper.runs.distil_teacher import STROKE_SECONDS, Teacher, checked_solver
from haptoflow_paper.report.accuracy_time import machine_words
from haptoflow_paper.rows.engine_generator import SOLVERS
from haptoflow_training.training.closed_loop import UPDATE_RATE_HZ
from haptoflow_training.commands import train_tiers
from haptoflow_training.commands.train import add_minutes_option
from haptoflow_training.errors import InputError
from haptoflow_training.export.model_file import read_model_file
from haptoflow_training.model_stamp import sha256_of
from haptoflow_training.training.run_log import source_commit
from haptoflow_training.waveform import SAMPLE_RATE_HZ
from haptoflow_training.whole_file import check_writable

_DESCRIPTION = """\
Train what ships (a skeleton that filters noise, and networks that correct it) on what a flow model generates: the same
materials for a small part of the time, in every scene and on a headset. The model's labels are stroked inside the range
that it was trained on, in closed loop through the engine; these recordings train the tiers sketch, draft and standard;
a table then compares each of them with the model on strokes that no training saw.

What is finished is found again: run the same command to go on after an interruption.
"""
_EXAMPLES = """examples:
  haptoflow-paper distil published.haptoflow -o materials.haptoflow --update-hz 10 --minutes 600
  haptoflow-paper distil published.haptoflow --labels wood,denim -o two.haptoflow --minutes 60
  haptoflow-paper distil plain.haptoflow --solver midpoint --steps 4 -o distilled.haptoflow

Then: build/native/haptoflow inspect materials.haptoflow
"""
_ROOT = Path(__file__).resolve().parents[3]
_CONFIGURATIONS = Path(__file__).resolve().parents[1] / "configs" / "distilled"
# The largest share of --minutes that rendering may take; training and the comparison need the rest.
_RENDERING_SHARE = 0.45
_FEWEST_STROKES = 10
_HELD_OUT_STROKES = 10


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.description = _DESCRIPTION
    parser.epilog = _EXAMPLES
    parser.add_argument("model", type=Path, metavar="MODEL.haptoflow", help="the model to distil")
    parser.add_argument("-o", "--out", type=Path, required=True, metavar="OUT.haptoflow", help="the file to write")
    parser.add_argument("--tier", metavar="NAME", help="of MODEL (default: its default tier)")
    parser.add_argument(
        "--solver", default="tier", choices=list(SOLVERS), help="with --steps, in place of the tier's own solver"
    )
    parser.add_argument("--steps", type=int, default=0, metavar="N", help="1 to 16")
    parser.add_argument("--labels", metavar="NAMES", help="labels separated by commas (default: all)")
    parser.add_argument(
        "--seconds-per-label", type=float, default=320.0, metavar="S",
        help="of recordings (default 320); fewer where --minutes do not suffice",
    )  # fmt: skip
    parser.add_argument(
        "--update-hz", type=float, default=UPDATE_RATE_HZ, metavar="HZ",
        help="segments a second of the recordings (default 72, as a stylus asks for them; 10 is the fewest, each segment "
        "played to its end)",
    )  # fmt: skip
    add_minutes_option(parser)
    parser.add_argument("--seed", type=int, default=1, help="of strokes and noise (default 1)")
    parser.add_argument(
        "--work", type=Path, metavar="DIR", help="for recordings, trainings and the report (default: out/distil/OUT)"
    )
    parser.add_argument(
        "--lanes", type=int, default=os.cpu_count() or 1, help="renderings and trainings at a time (default: cores)"
    )


def run(options: argparse.Namespace) -> int:
    begun = time.monotonic()
    if not 10.0 <= options.update_hz <= 240.0:
        raise InputError(f"--update-hz is {options.update_hz:g}; expected 10 to 240")
    if not 0 <= options.steps <= 16:
        raise InputError(f"--steps is {options.steps}; expected 1 to 16")
    check_writable(options.out)
    names = tuple(name.strip() for name in options.labels.split(",")) if options.labels else ()
    teacher = Teacher.of_file(options.model, options.tier, *checked_solver(options.solver, options.steps), names)
    work = options.work or _ROOT / "out" / "distil" / options.out.stem
    recordings, labels, report = work / "recordings", work / "labels.toml", work / "report"
    each = seconds_of_a_stroke(_ROOT, teacher, options.update_hz) / options.lanes
    count = _strokes_per_label(options, teacher, each)
    rendering = Rendering(teacher, count, options.update_hz, options.seed)
    _tell(rendering, each)
    with tqdm(total=count * len(teacher.labels), unit="stroke", desc="render") as bar:
        render_all(_ROOT, rendering, recordings, options.lanes, bar.update)
    if not labels.exists():
        with tqdm(total=len(teacher.labels), unit="label", desc="ribs") as bar:
            write_labels(rendering, recordings, labels, bar.update)
    _train(options, work, recordings, labels, begun)
    complete(options.out, teacher)
    with tqdm(total=2 * _HELD_OUT_STROKES * len(teacher.labels), unit="stroke", desc="render held-out") as bar:
        held_out = render_held_out(
            _ROOT, teacher, work / "held-out", _HELD_OUT_STROKES, options.update_hz, options.lanes, bar.update
        )
    tiers = [entry["name"] for entry in reversed(read_model_file(options.out).header["tiers"])]
    with tqdm(total=steps_of_comparison(len(tiers)), unit="part", desc="compare") as bar:
        rows, waves = compare(_ROOT, teacher, options.out, tiers, held_out, bar.update)
    report.mkdir(parents=True, exist_ok=True)
    sha256 = sha256_of(options.out)
    about = {
        "machine": machine_words(), "commit": source_commit(_ROOT), "engine": default_engine(_ROOT).version(),
        "labels": len(teacher.labels), "strokes": len(held_out.pairs), "seed": options.seed,
        "seconds": sum(len(pair.recorded) for pair in held_out.pairs) / SAMPLE_RATE_HZ, "strokes_per_label": count,
        "update_rate_hz": options.update_hz, "minutes": options.minutes, "command_minutes": (time.monotonic() - begun) / 60.0,
    }  # fmt: skip
    print(write_report(report, teacher, rows, about, sha256))
    draw_spectra(report / SPECTRA, teacher, held_out, waves, sha256)
    print(f"{options.out}: {options.out.stat().st_size / 1e6:.2f} MB; {report / PAGE}")
    return 0


def _strokes_per_label(options: argparse.Namespace, teacher: Teacher, seconds_of_a_stroke: float) -> int:
    wanted = max(_FEWEST_STROKES, round(options.seconds_per_label / STROKE_SECONDS))
    if options.minutes is None:
        return wanted
    labels = len(teacher.labels)
    held_out = 2 * _HELD_OUT_STROKES
    affordable = int(60.0 * options.minutes * _RENDERING_SHARE / (labels * seconds_of_a_stroke)) - held_out
    if affordable < _FEWEST_STROKES:
        needed = (_FEWEST_STROKES + held_out) * labels * seconds_of_a_stroke / _RENDERING_SHARE / 60.0
        raise InputError(
            f"--minutes is {options.minutes:g}: {teacher.solved_words} of {teacher.model} takes {seconds_of_a_stroke:.2g} s for "
            f"a stroke of {STROKE_SECONDS:g} s here; expected {needed:.0f} at least, or fewer --labels, or a lower --update-hz"
        )
    return min(wanted, affordable)


def _tell(rendering: Rendering, seconds_of_a_stroke: float) -> None:
    labels, strokes = len(rendering.teacher.labels), rendering.strokes_per_label
    hours = labels * (strokes + 2 * _HELD_OUT_STROKES) * seconds_of_a_stroke / 3600.0
    print(
        f"{labels} labels, {strokes} strokes of {STROKE_SECONDS:g} s each: rendering takes about "
        + (f"{hours:.1f} h" if hours >= 1.0 else f"{60.0 * hours:.0f} min")
    )


def _train(options: argparse.Namespace, work: Path, recordings: Path, labels: Path, begun: float) -> None:
    """Train the tiers in what is left of the minutes, or find them trained."""
    minutes = options.minutes
    if minutes is not None:
        minutes = max(minutes - (time.monotonic() - begun) / 60.0, (1.0 - _RENDERING_SHARE) * minutes)
    training = argparse.Namespace(
        configs=_CONFIGURATIONS, out=work / "train", recordings=[recordings], labels=labels, minutes=minutes,
        lanes=options.lanes, workers=options.lanes, export=options.out, parity=None,
    )  # fmt: skip
    train_tiers.run(training)
