"""Renders a prescribed motion on one label with the engine's command line, the shipped path from end to end."""

from __future__ import annotations

import csv
import json
import subprocess
import warnings
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.io import wavfile
from scipy.signal import resample_poly

from haptoflow_training.training.closed_loop import UPDATE_RATE_HZ
from haptoflow_training.errors import InputError
from haptoflow_training.waveform import SAMPLE_RATE_HZ

# The default full scale, as in the C header (a test compares all languages).
FULL_SCALE_MPS2 = 200.0
_RENDER_RATE_HZ = 8000
_STROKE_STEP = 16


@dataclass(frozen=True)
class EngineRender:
    """waveform_mps2: [n] at 2 kHz, resampled from the WAV. report: what `--report` wrote."""

    waveform_mps2: NDArray[np.float64]
    report: dict[str, Any]


def write_scene(
    path: Path, label: str, update_rate_hz: float, tip_radius_metres: float = 0.001, name: str = "plane"
) -> None:
    """Write a scene with a plane of the label whose grain lies along the first axis of motion. Planes of different names
    differ as two pieces of a material do."""
    scene = {
        "surfaces": [
            {
                "name": name,
                "shape": {"plane": {}},
                "position": [0.0, 0.0, 0.0],
                "rotation": [0.0, 0.0, 0.0, 1.0],
                "material": label,
            }
        ],
        "stylus": {"tip_radius": tip_radius_metres},
        "update_rate": update_rate_hz,
    }
    path.write_text(json.dumps(scene), encoding="utf-8")


def write_stroke(path: Path, motion: NDArray[np.floating]) -> None:
    """Write a stroke on the plane y = 0 with the motion [n, 3] (vx, vy in m/s, force in N at 2 kHz), sampled at 125 Hz.

    The surface's second tangent axis is Unity's -z (axis 1 x axis 2 = normal in the left-handed frame).
    """
    step_seconds = 1.0 / 2000.0
    position = np.cumsum(motion[:, :2], axis=0) * step_seconds
    rows = np.arange(0, len(motion), _STROKE_STEP)
    columns = np.stack(
        [rows * step_seconds, position[rows, 0], np.full(len(rows), 0.0005), -position[rows, 1], motion[rows, 2]],
        axis=1,
    )
    write_rows(path, columns, digits=7)


def read_wav(path: Path) -> NDArray[np.float32]:
    """Samples of a WAV file that the engine wrote, +-1 = FULL_SCALE_MPS2."""
    with warnings.catch_warnings():
        # SciPy warns of the engine's padding chunk, which is valid.
        warnings.simplefilter("ignore", wavfile.WavFileWarning)
        samples: NDArray[np.float32] = wavfile.read(path)[1]
    return samples


def run_engine(command: list[str]) -> str:
    """Run the command line, and return what it prints; InputError carries its own message if it fails."""
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    except OSError as error:
        raise InputError(f"{command[0]}: cannot be run ({error.strerror}); build it with `npm run build`") from error
    if done.returncode != 0:
        raise InputError(f"{command[0]} {command[1]} failed: {done.stderr.strip()}")
    return done.stdout


def model_labels(engine: Path, model: Path) -> list[str]:
    """The labels of a model file, as the engine reads it."""
    described = json.loads(run_engine([str(engine), "inspect", str(model), "--json"]))
    return [label["name"] for label in described["header"]["labels"]]


def write_rows(path: Path, rows: NDArray[np.floating], digits: int = 9) -> None:
    """Write a stroke's rows [n, 5]: seconds, the tip's position in metres, force in newtons."""
    np.savetxt(path, rows, fmt=f"%.{digits}f", delimiter=",", header="t,x,y,z,force", comments="")


def rendered_samples(
    engine: Path, scene: Path, stroke: Path, wav: Path, *, model: Path | None, seed: int, options: tuple[str, ...] = ()
) -> NDArray[np.float64]:
    """Run `haptoflow render`, and return the samples of its WAV at 2 kHz, +-1 = FULL_SCALE_MPS2. InputError carries the
    command's own message if it fails."""
    command = [str(engine), "render", str(scene), "--stroke", str(stroke), "-o", str(wav)]
    command += ["--rate", str(_RENDER_RATE_HZ), "--seed", str(seed), *options]
    if model is not None:
        command += ["--model", str(model)]
    run_engine(command)
    samples: NDArray[np.float64] = resample_poly(read_wav(wav).astype(np.float64), 1, _RENDER_RATE_HZ // SAMPLE_RATE_HZ)
    return samples


def render_motion(
    engine: Path,
    label: str,
    motion: NDArray[np.floating],
    folder: Path,
    *,
    model: Path | None = None,
    seed: int = 1,
    options: tuple[str, ...] = (),
) -> EngineRender:
    """Run `haptoflow render`; InputError carries the command's own message if it fails."""
    scene, stroke, wav, report = (folder / name for name in ("scene.json", "stroke.csv", "out.wav", "report.json"))
    write_scene(scene, label, UPDATE_RATE_HZ)
    write_stroke(stroke, motion)
    samples = rendered_samples(
        engine, scene, stroke, wav, model=model, seed=seed, options=("--report", str(report), *options)
    )
    waveform = samples * FULL_SCALE_MPS2
    return EngineRender(waveform[: len(motion)], json.loads(report.read_text(encoding="utf-8")))


_COLUMNS = ("t_s", "x_m", "y_m", "z_m")
# Even with lifts at its ends, a stroke has well over this share of its samples on the table.
_SHARE_ON_TABLE = 0.6


def read_recorded_strokes(path: Path) -> dict[str, NDArray[np.float64]]:
    """Strokes by name, [n, 4]: seconds and metres as recorded, with the table roughly in the x-y plane. InputError
    names the line."""
    rows: dict[str, list[list[float]]] = defaultdict(list)
    try:
        with path.open(newline="", encoding="utf-8") as file:
            for number, row in enumerate(csv.DictReader(file), start=2):
                try:
                    rows[row["stroke_id"]].append([float(row[column]) for column in _COLUMNS])
                except (KeyError, TypeError, ValueError) as error:
                    expected = f"expected stroke_id and numbers in {', '.join(_COLUMNS)}"
                    raise InputError(f"{path}:{number}: {expected}") from error
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror})") from error
    if not rows:
        raise InputError(f"{path}: holds no stroke")
    return {name: np.array(values) for name, values in rows.items()}


def onto_table(stroke: NDArray[np.float64]) -> NDArray[np.float64]:
    """[n, 4] in seconds from 0 and metres in a scene's frame, y up: the plane fitted to the samples on the table is
    y = 0, and the stroke's middle is above the origin."""
    points = stroke[:, 1:4]
    plane = points
    for _ in range(5):
        design = np.c_[plane[:, :2], np.ones(len(plane))]
        coefficients, *_ = np.linalg.lstsq(design, plane[:, 2], rcond=None)
        height = points[:, 2] - np.c_[points[:, :2], np.ones(len(points))] @ coefficients
        plane = points[height <= np.quantile(height, _SHARE_ON_TABLE)]
    centre = np.median(points[:, :2], axis=0)
    return np.c_[stroke[:, 0] - stroke[0, 0], points[:, 0] - centre[0], height, points[:, 1] - centre[1]]


def on_table_spline(stroke: NDArray[np.float64]) -> tuple[float, CubicSpline]:
    """Length in s, and the path [n, 3] as `onto_table`, over time from 0: a spline through the tracker's distinct
    positions, which it measured evenly in time, whatever the times at which frames read them."""
    placed = onto_table(stroke)
    is_fresh = np.r_[True, np.any(np.diff(placed[:, 1:], axis=0) != 0.0, axis=1)]
    ticks = np.linspace(0.0, placed[is_fresh, 0][-1], int(is_fresh.sum()))
    return float(ticks[-1]), CubicSpline(ticks, placed[is_fresh, 1:])
