"""`haptoflow-benchmark measure-lag`: how late the vibration's level follows the stylus's speed."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

from tqdm import tqdm

from haptoflow_benchmark.engine_render import read_recorded_strokes
from haptoflow_benchmark.stylus_lag import LABELS, NOISE_METRES, RATES_HZ, SEEDS, lag_strokes, measure_lags
from haptoflow_training.errors import InputError
from haptoflow_training.model_stamp import sha256_of
from haptoflow_training.training.run_log import source_commit, write_json
from haptoflow_training.whole_file import check_writable


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.description = (
        "Renders scribbles and recorded strokes at 72, 90 and 120 Hz through the engine's command line, and finds the "
        "lag at which the vibration's log level correlates best with the pen's true log speed. The figures are kept "
        "under a name beside those of other engines; `haptoflow-training study budget` puts them on its page."
    )
    parser.epilog = (
        "example:\n  haptoflow-benchmark measure-lag --engine build/native/haptoflow \\\n"
        "    --model Packages/com.haptoflow.runtime/Runtime/Models/default.haptoflow \\\n"
        "    --strokes ../shared/strokes/vr-pen-on-surface/strokes.csv \\\n"
        '    --out Training/results/default/stylus-lag.json --name "this version"'
    )
    parser.add_argument("--engine", type=Path, required=True, help="the built command line, build/native/haptoflow")
    parser.add_argument("--model", type=Path, required=True, help="the .haptoflow file")
    parser.add_argument("--strokes", type=Path, required=True, help="CSV: stroke_id,t_s,x_m,y_m,z_m")
    parser.add_argument("--name", default="this version", help='of the row (default "this version")')
    parser.add_argument("--commit", help="from which the engine was built, if it was not this tree's")
    parser.add_argument("--workers", type=int, default=2, help="renders at a time (default: 2)")
    parser.add_argument("--out", type=Path, required=True, help="JSON, made or extended by a row")


def run(options: argparse.Namespace) -> int:
    strokes = read_recorded_strokes(options.strokes)
    check_writable(options.out)
    rows = _read_rows(options.out)
    count = len(list(lag_strokes(strokes))) * len(RATES_HZ) * len(LABELS)
    with tqdm(total=count, unit="stroke") as bar:
        lags = measure_lags(
            options.engine, options.model, strokes, workers=options.workers, advance=lambda: bar.update(1)
        )
    rows[options.name] = {
        "commit": options.commit or source_commit(Path(__file__).parent),
        "model_sha256": sha256_of(options.model),
        "labels": list(LABELS), "seeds": list(SEEDS), "noise_mm": 1000.0 * NOISE_METRES, "lags": lags,
    }  # fmt: skip
    write_json(options.out, rows)
    for kind, by_rate in lags.items():
        print(f"{kind}: " + ", ".join(f"{each['lag_ms']:.1f} ms at {rate} Hz" for rate, each in by_rate.items()))
    return 0


def _read_rows(path: Path) -> dict[str, Any]:
    if not path.exists():
        return {}
    try:
        rows: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be read as the report of measure-lag ({error})") from error
    return rows
