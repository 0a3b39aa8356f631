"""`stroke`: write a hand-like movement through way-points as the CSV file that `haptoflow render` reads."""

from __future__ import annotations

import argparse
import io
from pathlib import Path

import numpy as np

from haptoflow_training.errors import InputError
from haptoflow_training.hand_stroke import DEFAULT_TREMOR_METRES, SpatialStroke, scripted_stroke
from haptoflow_training.whole_file import read_toml, write_whole

_KEYS = ("waypoints_metres", "segment_seconds", "rate_hz", "seed", "tremor_metres", "force_newtons",
         "smoothing_seconds")  # fmt: skip


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.description = "Sigma-lognormal movement through the way-points of a TOML script."
    parser.epilog = (
        "script keys: waypoints_metres = [[x, y, z], ...], segment_seconds (a number, or one a leg), "
        "and optionally rate_hz (120), seed (0), tremor_metres (5e-5), force_newtons = [one a way-point], "
        "smoothing_seconds (0; 0.02 where way-points only draw a curve)."
    )
    parser.formatter_class = argparse.HelpFormatter
    parser.add_argument("--script", type=Path, required=True)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--seed", type=int, help="instead of the script's")


def run(options: argparse.Namespace) -> int:
    stroke = stroke_from_script(options.script, seed=options.seed)
    write_stroke(options.out, stroke)
    print(f"{len(stroke.time_seconds)} samples, {stroke.time_seconds[-1]:.3f} s, in {options.out}")
    return 0


def stroke_from_script(path: Path, *, seed: int | None = None) -> SpatialStroke:
    """The stroke of a TOML script. InputError names the file, the key and what was expected."""
    script = read_toml(path, "a TOML script")
    for key in script:
        if key not in _KEYS:
            raise InputError(f"{path}: unknown key '{key}'; expected {', '.join(_KEYS)}")
    for key in ("waypoints_metres", "segment_seconds"):
        if key not in script:
            raise InputError(f"{path}: '{key}' is missing; a stroke needs way-points and their seconds")
    try:
        return scripted_stroke(
            script["waypoints_metres"],
            segment_seconds=script["segment_seconds"],
            rate_hz=float(script.get("rate_hz", 120.0)),
            seed=int(script.get("seed", 0)) if seed is None else seed,
            tremor_metres=float(script.get("tremor_metres", DEFAULT_TREMOR_METRES)),
            force_newtons=script.get("force_newtons"),
            smoothing_seconds=float(script.get("smoothing_seconds", 0.0)),
        )
    except (TypeError, ValueError) as error:
        raise InputError(f"{path}: {error}") from error


def write_stroke(path: Path, stroke: SpatialStroke) -> None:
    """Write columns `t,x,y,z[,force]`, seconds to the microsecond and metres to the nanometre. The file is written
    atomically."""
    columns, forms, names = [stroke.time_seconds, stroke.position_metres], ["%.6f", *["%.9f"] * 3], "t,x,y,z"
    if stroke.force_newtons is not None:
        columns, forms, names = [*columns, stroke.force_newtons], [*forms, "%.6f"], f"{names},force"
    table = io.BytesIO()
    np.savetxt(table, np.column_stack(columns), fmt=forms, delimiter=",", header=names, comments="")
    write_whole(path, table.getvalue())
