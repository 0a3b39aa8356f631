"""Reads recorded pen strokes on a table from CSV (`stroke_id,t_s,x_m,y_m,z_m,...`) and transforms them to a scene's
frame."""

from __future__ import annotations

import csv
from collections import defaultdict
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from haptoflow_training.errors import InputError

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
