"""`haptoflow-training study budget`: compute the delay budget from the benchmark's figures."""

from __future__ import annotations

import argparse
import os
from pathlib import Path

from haptoflow_training.errors import InputError
from haptoflow_training.model_stamp import read_measured_page, with_measured_words
from haptoflow_training.whole_file import write_whole

_PUBLISHED = Path("Documentation~") / "benchmarks.md"
_EXAMPLES = """examples:
  haptoflow-training study budget
  haptoflow-training study budget --bench out/bench.json --device-ms 25
  haptoflow-training study budget --page Documentation~/delay-budget.md --chart Documentation~/images/delay-budget.png

The first reads the tables of Documentation~/benchmarks.md, the second those of `npm run bench` on this machine with a
device delay that you measured. The third writes the page anew after `npm run bench -- --publish`.
"""


def register(parser: argparse.ArgumentParser) -> None:
    parser.description = "Add up pose interval, inference, audio block and device, beside the thresholds of the paper."
    parser.epilog = _EXAMPLES
    parser.add_argument("--bench", type=Path, default=_PUBLISHED, help="bench.json, or the page that publishes it")
    parser.add_argument("--device-ms", type=float, help="from the audio callback to the hand, as you measured it")
    parser.add_argument("--page", type=Path, help="page whose measured part is written anew")
    parser.add_argument("--chart", type=Path, help="PNG file to write")
    parser.set_defaults(run=_run)


def _run(options: argparse.Namespace) -> int:
    from haptoflow_training.studies.bench_figures import read_bench
    from haptoflow_training.studies.delay_budget import page_words, write_chart

    if options.device_ms is not None and not 0.0 <= options.device_ms <= 1000.0:
        raise InputError(f"--device-ms {options.device_ms:g}: expected 0 to 1000")
    bench = read_bench(options.bench)
    if "standard" not in bench.inference_ms:
        raise InputError(f"{options.bench}: no quality 'standard'; expected the benchmark of the shipped model")
    chart = options.chart
    if options.page is not None and chart is None:
        chart = options.page.parent / "images" / "delay-budget.png"
    address = "" if chart is None else Path(os.path.relpath(chart, (options.page or chart).parent)).as_posix()
    words = page_words(bench, address, options.device_ms)
    if options.page is not None:
        write_whole(options.page, with_measured_words(read_measured_page(options.page), words).encode())
    if chart is not None:
        write_chart(chart, bench, options.device_ms)
    print(words)
    return 0
