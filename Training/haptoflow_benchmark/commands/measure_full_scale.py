"""`haptoflow-benchmark measure-full-scale`: which acceleration should be +-1, from recorded strokes on every label."""

from __future__ import annotations

import argparse
import json
from pathlib import Path

from tqdm import tqdm

from haptoflow_benchmark.engine.engine_render import FULL_SCALE_MPS2
from haptoflow_benchmark.full_scale.measurement import (
    ALLOWED_SHARE,
    FORCES_NEWTONS,
    full_scale_table,
    measure_levels,
    model_labels,
    summarise,
)
from haptoflow_benchmark.full_scale.recorded_strokes import read_recorded_strokes
from haptoflow_training.model_stamp import (
    model_line,
    read_measured_page,
    sha256_of,
    with_measured_words,
)
from haptoflow_training.whole_file import check_writable, write_whole


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.description = (
        "Renders recorded strokes on every label of a model through the engine's command line, with each force "
        "held for the whole stroke, far below the limiter's knee, and reports the smallest full scale at "
        f"which less than {ALLOWED_SHARE:.1%} of the samples exceed the knee, with the shares at others."
    )
    parser.epilog = (
        "example:\n  haptoflow-benchmark measure-full-scale --engine build/native/haptoflow \\\n"
        "    --model Packages/com.haptoflow.runtime/Runtime/Models/default.haptoflow \\\n"
        "    --strokes ../shared/strokes/vr-pen-on-surface/strokes.csv \\\n"
        "    --out Training/results/default/full-scale.json --page Documentation~/devices.md"
    )
    parser.add_argument("--engine", type=Path, required=True, help="the built command line, build/native/haptoflow")
    parser.add_argument("--model", type=Path, required=True, help="the .haptoflow file")
    parser.add_argument("--strokes", type=Path, required=True, help="CSV: stroke_id,t_s,x_m,y_m,z_m")
    parser.add_argument(
        "--forces", type=float, nargs="+", default=list(FORCES_NEWTONS), help="newtons (default: 0.5 1 2 3)"
    )
    parser.add_argument(
        "--full-scales", type=float, nargs="+", default=[60.0, 100.0, 150.0, FULL_SCALE_MPS2, 250.0],
        help="m/s^2 whose shares are reported (default: 60 100 150, the engine's own, 250)",
    )  # fmt: skip
    parser.add_argument("--workers", type=int, default=2, help="renders at a time (default: 2)")
    parser.add_argument("--out", type=Path, required=True, help="the report, JSON")
    parser.add_argument("--page", type=Path, help="a page whose measured table is replaced")


def run(options: argparse.Namespace) -> int:
    strokes = read_recorded_strokes(options.strokes)
    check_writable(options.out)
    if options.page is not None:
        read_measured_page(options.page)
        check_writable(options.page)
    labels = model_labels(options.engine, options.model)
    with tqdm(total=len(strokes) * len(labels) * len(options.forces), unit="render") as bar:
        levels = measure_levels(
            options.engine, options.model, strokes, labels, options.forces, workers=options.workers, advance=bar.update
        )
    report = {"model_sha256": sha256_of(options.model), **summarise(levels, sorted(set(options.full_scales)))}
    write_whole(options.out, (json.dumps(report, indent=1) + "\n").encode())
    if options.page is not None:
        words = f"{model_line(report['model_sha256'])}\n\n{full_scale_table(report)}"
        write_whole(options.page, with_measured_words(read_measured_page(options.page), words).encode())
    print(
        f"{options.out}: {report['smallest_full_scale_mps2']:.0f} m/s^2 over all labels, "
        f"{report['smallest_full_scale_of_loudest_label_mps2']:.0f} m/s^2 for the loudest alone"
    )
    return 0
