"""`stroke`: write a hand-like movement through way-points as the CSV file that `haptoflow render` reads."""

from __future__ import annotations

import argparse
import tomllib
from pathlib import Path

from haptoflow_training.errors import InputError
from haptoflow_training.hand_stroke import DEFAULT_TREMOR_METRES, SpatialStroke, scripted_stroke
from haptoflow_training.whole_file import write_whole

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
    try:
        script = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror}); expected a TOML script") from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise InputError(f"{path}: not valid TOML: {error}") from error
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
    lines = ["t,x,y,z" if stroke.force_newtons is None else "t,x,y,z,force"]
    for index, time in enumerate(stroke.time_seconds):
        row = f"{time:.6f}," + ",".join(f"{value:.9f}" for value in stroke.position_metres[index])
        if stroke.force_newtons is not None:
            row += f",{stroke.force_newtons[index]:.6f}"
        lines.append(row)
    write_whole(path, ("\n".join(lines) + "\n").encode())
