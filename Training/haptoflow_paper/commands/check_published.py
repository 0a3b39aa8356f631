"""`haptoflow-paper check-published`: a report on a model file where the published weights are."""

from __future__ import annotations

import argparse
import os
import time
from pathlib import Path

from tqdm import tqdm

from haptoflow_benchmark.engine_library import default_engine
from haptoflow_paper.published.check_lines import FAIL
from haptoflow_paper.published.check_parity import parity_lines
from haptoflow_paper.published.check_report import (
    CHART,
    FIGURES,
    PAGE,
    SPECTRA,
    draw_chart,
    draw_spectra,
    environment,
    summary,
    write_report,
)
from haptoflow_paper.published.check_points import blocks_to_measure, idle_line, measure_points, time_lines
from haptoflow_paper.published.check_signals import count_of_labels, render_labels, signal_lines
from haptoflow_paper.published.level_measurement import reference_motions, render_waves, segments_a_wave
from haptoflow_paper.rows.engine_generator import EngineGenerator
from haptoflow_training.errors import InputError
from haptoflow_training.export.model_file import read_model_file
from haptoflow_training.model_stamp import SHIPPED_MODEL, sha256_of
from haptoflow_training.whole_file import check_writable

_DESCRIPTION = """\
Check a model file on this machine and write one page with pictures and one JSON file to send: whether it computes what
the published checkpoint computes, whether its levels and spectra are those measured on the real data set, what each tier
costs here, which one quality `auto` would take, and how far fewer solver steps are from the best tier. Every line has a
verdict and says what to do. A line that cannot be measured says why, and is no failure.

The authors' own code is the reference of the parity if it can be imported: clone github.com/tamago117/HaptoFlow, install
its dependencies and put its folder on PYTHONPATH. Otherwise this project's reading of the checkpoint is, and the report
says so. Takes any model file: a cluster training, the shipped one. Leave the machine alone meanwhile; times count.
"""
_EXAMPLES = """examples:
  haptoflow-paper check-published published.haptoflow --folder haptoflow_accel -o work/check
  PYTHONPATH=Training:../HaptoFlow haptoflow-paper check-published published.haptoflow --folder haptoflow_accel \\
    --encodec encodec_24khz-d7cc33bc.th -o work/check
  haptoflow-paper check-published work/cluster.haptoflow -o work/check-cluster

Exit code 0 if no line fails, 3 if one does; the report is written either way.
"""
_ROOT = Path(__file__).resolve().parents[3]
# Of the limit, for the labels; parity and times take the rest.
_LABELS_SHARE = 0.4
_RUNS_SHARE = 0.4
_MOST_RUNS, _LEAST_RUNS = 50, 5


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.description = _DESCRIPTION
    parser.epilog = _EXAMPLES
    parser.add_argument("model", type=Path, metavar="FILE.haptoflow", help="model file to check")
    parser.add_argument("--folder", type=Path, help="the checkpoint that it was imported from, for the parity")
    parser.add_argument("--encodec", type=Path, metavar="FILE", help="EnCodec's state dict (default: the .th in FOLDER)")
    parser.add_argument(
        "--seconds-limit", type=float, default=300.0, metavar="S",
        help="about how long to take; labels and timed runs are fewer where it is short (default 300)",
    )  # fmt: skip
    parser.add_argument("-o", "--out", required=True, type=Path, metavar="OUT_DIR", help="folder of the report")


def run(options: argparse.Namespace) -> int:
    if not options.seconds_limit > 0.0:
        raise InputError(f"--seconds-limit is {options.seconds_limit:g}; expected seconds, above 0")
    check_writable(options.out / FIGURES)
    idle = idle_line(os.getloadavg()[0], os.cpu_count() or 1)
    engine = default_engine(_ROOT)
    file = read_model_file(options.model)
    header = file.header
    sha256 = sha256_of(options.model)
    with tqdm(total=4 + count_of_labels(header) + blocks_to_measure(header), unit="part", disable=None) as progress:

        def stage(words: str) -> None:
            progress.set_description(words)
            progress.update(1)

        lines, reference = parity_lines(file, options.model, options.folder, options.encodec, engine, _ROOT, stage)
        progress.set_description("labels")
        with EngineGenerator(engine, options.model, maximum_batch=2) as generator:
            waves = render_labels(generator, _LABELS_SHARE * options.seconds_limit, progress.update)
            seconds_a_segment = _seconds_a_segment(generator)
        lines += signal_lines(waves, header)
        progress.set_description("times")
        runs = _runs(seconds_a_segment, blocks_to_measure(header), _RUNS_SHARE * options.seconds_limit)
        shipped = _ROOT / SHIPPED_MODEL
        found, other = measure_points(engine, options.model, shipped, header, runs, progress.update)
        name = f"the shipped model's {other.point.tier}"
        lines += [idle, *time_lines(header, found, other, name)]
        progress.set_description("pictures")
        options.out.mkdir(parents=True, exist_ok=True)
        draw_chart(found, options.out / CHART, sha256)
        draw_spectra(waves, options.out / SPECTRA, sha256)
    about = {**environment(engine, _ROOT), "parity_reference": reference, "time_reference": name}
    about["reference_hot_p50_ms"] = other.hot.p50
    about["runs"] = runs
    write_report(options.out, lines, found, header, sha256, about)
    for line in lines:
        print(f"{line.verdict:14}  {line.part}: {line.name}: {line.measured}")
        if line.verdict == FAIL:
            print(f"{'':14}  expected {line.expected}; {line.remedy}")
    print(f"{summary(lines)}; {options.out / PAGE}, and {options.out / FIGURES} to send")
    return 3 if any(line.verdict == FAIL for line in lines) else 0


def _seconds_a_segment(generator: EngineGenerator) -> float:
    began = time.monotonic()
    render_waves(generator, generator.embeddings[:1], reference_motions()[:1])
    return (time.monotonic() - began) / segments_a_wave()


def _runs(seconds_a_segment: float, blocks: int, seconds: float) -> int:
    """Timed runs in each block, so that all blocks together take about `seconds` at the best tier's pace at most."""
    return int(min(_MOST_RUNS, max(_LEAST_RUNS, seconds / max(blocks * seconds_a_segment, 1e-9))))
