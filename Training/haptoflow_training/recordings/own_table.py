"""Reads an own table, CSV or Parquet: columns named with their unit, converted to SI units."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.recordings.cluster_dataset_files import (
    TOLERATED_SHARE,
    DatasetFileError,
    open_table,
    rising_rows,
)
from haptoflow_training.recordings.recording import STANDARD_GRAVITY_MPS2

_Doubles = NDArray[np.float64]

TIME_COLUMN = "time_s"
_G = STANDARD_GRAVITY_MPS2


@dataclass(frozen=True)
class ColumnForm:
    """Columns that belong together, and the factor that converts their numbers to SI units."""

    columns: tuple[str, ...]
    factor: float


ACCELERATION_FORMS = (
    ColumnForm(("acceleration_mps2",), 1.0),
    ColumnForm(("acceleration_g",), _G),
    ColumnForm(("acceleration_x_mps2", "acceleration_y_mps2", "acceleration_z_mps2"), 1.0),
    ColumnForm(("acceleration_x_g", "acceleration_y_g", "acceleration_z_g"), _G),
)
VELOCITY_FORMS = (
    ColumnForm(("velocity_x_mps", "velocity_y_mps"), 1.0),
    ColumnForm(("speed_mps",), 1.0),
    ColumnForm(("speed_mmps",), 1e-3),
)
POSITION_FORMS = (
    ColumnForm(("position_x_mm", "position_y_mm"), 1e-3),
    ColumnForm(("position_x_m", "position_y_m"), 1.0),
)
FORCE_FORMS = (ColumnForm(("force_newtons",), 1.0), ColumnForm(("force_millinewtons",), 1e-3))
_MOTION_FORMS = VELOCITY_FORMS + POSITION_FORMS


@dataclass(frozen=True)
class Series:
    """time_seconds: [n], increasing. values: [n, columns] in SI units. columns: the columns they were read from."""

    time_seconds: _Doubles
    values: _Doubles
    columns: tuple[str, ...]


@dataclass(frozen=True)
class OwnTable:
    """The contents of a table; None for what it lacks. unknown: columns that no form names, which are ignored."""

    path: Path
    acceleration: Series | None = None
    motion: Series | None = None
    force: Series | None = None
    unknown: tuple[str, ...] = field(default=())


def names_of(forms: tuple[ColumnForm, ...]) -> str:
    """The columns of the forms, for messages."""
    return " | ".join(", ".join(form.columns) for form in forms)


def column_names(path: Path) -> list[str]:
    """The column names in a CSV file's first line, without reading the rest."""
    try:
        with path.open(encoding="utf-8-sig") as file:
            line = file.readline()
    except (OSError, UnicodeDecodeError) as error:
        raise DatasetFileError(path, f"cannot be read ({error})", "a CSV table in UTF-8") from error
    return [name.strip().strip('"') for name in line.rstrip("\r\n").split(",")]


def unknown_columns(names: list[str]) -> tuple[str, ...]:
    """The columns that no form names."""
    forms = (*ACCELERATION_FORMS, *_MOTION_FORMS, *FORCE_FORMS)
    known = {TIME_COLUMN, *(column for form in forms for column in form.columns)}
    return tuple(name for name in names if name not in known)


def read_own_table(path: Path, rate_hz: float | None, *, with_acceleration: bool = True) -> OwnTable:
    """Read a table; rate_hz is its clock if it has no column time_s. with_acceleration: False for a motion file.

    Rows without a number in some column are dropped for that quantity only; for the acceleration, at most 1 % of the
    rows. DatasetFileError names the file, what was found and what is expected.
    """
    columns = _read_columns(path)
    names = list(columns)
    forms = {
        "acceleration": _form_in(path, names, ACCELERATION_FORMS, "acceleration") if with_acceleration else None,
        "motion": _form_in(path, names, _MOTION_FORMS, "motion"),
        "force": _form_in(path, names, FORCE_FORMS, "force"),
    }
    if with_acceleration and forms["acceleration"] is None:
        raise DatasetFileError(path, _found(names), f"acceleration: {names_of(ACCELERATION_FORMS)}")
    wanted = [form for form in forms.values() if form is not None]
    numbers = {name: _numbers(path, name, columns[name]) for form in wanted for name in form.columns}
    time = _time(path, columns, names, rate_hz)
    series = {what: _series(path, time, numbers, form, what) for what, form in forms.items()}
    return OwnTable(path, series["acceleration"], series["motion"], series["force"], unknown_columns(names))


def _read_columns(path: Path) -> Mapping[str, object]:
    expected = f"a table with columns {TIME_COLUMN} and acceleration ({names_of(ACCELERATION_FORMS)})"
    table = open_table(path, expected)
    names = [str(name).strip() for name in table.columns]
    repeated = sorted({name for name in names if names.count(name) > 1})
    if repeated:
        raise DatasetFileError(path, f"column {repeated[0]} twice", "each column once")
    if len(names) == 1 and ";" in names[0]:
        raise DatasetFileError(path, "columns separated by semicolons", "commas between columns, points in numbers")
    return dict(zip(names, (table.iloc[:, place] for place in range(len(names))), strict=True))


def _found(names: list[str]) -> str:
    return f"columns {', '.join(names)}"


def _form_in(path: Path, names: list[str], forms: tuple[ColumnForm, ...], what: str) -> ColumnForm | None:
    present = [form for form in forms if any(column in names for column in form.columns)]
    if not present:
        return None
    if len(present) > 1:
        both = " and ".join(", ".join(column for column in form.columns if column in names) for form in present)
        raise DatasetFileError(path, f"{what} in several forms ({both})", f"one of {names_of(forms)}")
    missing = [column for column in present[0].columns if column not in names]
    if missing:
        raise DatasetFileError(path, f"{_found(names)} without {', '.join(missing)}", ", ".join(present[0].columns))
    return present[0]


def _numbers(path: Path, name: str, column: object) -> _Doubles:
    try:
        return np.asarray(column, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise DatasetFileError(path, f"text in column {name} ({error})", "numbers only") from error


def _time(path: Path, columns: Mapping[str, object], names: list[str], rate_hz: float | None) -> _Doubles:
    if TIME_COLUMN in columns:
        return _numbers(path, TIME_COLUMN, columns[TIME_COLUMN])
    if rate_hz is None:
        expected = f"a column {TIME_COLUMN}, or the key rate_hz in {path.with_suffix('.json').name}"
        raise DatasetFileError(path, f"{_found(names)} without {TIME_COLUMN}", expected)
    count = len(np.asarray(next(iter(columns.values()))))
    return np.arange(count, dtype=np.float64) / rate_hz


def _series(
    path: Path, time: _Doubles, numbers: Mapping[str, _Doubles], form: ColumnForm | None, what: str
) -> Series | None:
    if form is None:
        return None
    rows = np.column_stack([time, *(form.factor * numbers[column] for column in form.columns)])
    broken = ~np.isfinite(rows).all(axis=1)
    if what == "acceleration" and broken.mean() > TOLERATED_SHARE:
        row = int(broken.argmax()) + 2
        found = f"no number in row {row}, column {form.columns[0]} or {TIME_COLUMN}"
        raise DatasetFileError(path, found, "finite numbers")
    rows = rows[~broken]
    if len(rows) < 4:
        raise DatasetFileError(path, f"{len(rows)} rows with numbers in {', '.join(form.columns)}", "4 rows at least")
    rows = rising_rows(path, rows)
    return Series(rows[:, 0].copy(), rows[:, 1:].copy(), form.columns)


def misread_units(table: OwnTable) -> Iterator[DatasetFileError]:
    """Columns whose numbers indicate another unit than their name."""
    if table.acceleration is not None and len(table.acceleration.columns) == 3:
        rest = float(np.linalg.norm(table.acceleration.values.mean(axis=0)))
        raw, is_mps2 = (rest, True) if table.acceleration.columns[0].endswith("mps2") else (rest / _G, False)
        if is_mps2 and 0.9 < raw < 1.1:
            name = table.acceleration.columns[0]
            expected = f"m/s^2 (9.8 at rest); name the columns {name[:-4]}g and so on where they are in g"
            yield DatasetFileError(table.path, f"{name[:-7]} rests at {raw:.2f}, which looks like g", expected)
    if table.motion is not None:
        yield from _misread_motion(table.path, table.motion)


_MAXIMUM_SPEED_MPS, _MINIMUM_SPEED_MPS = 10.0, 0.0005
_OTHER_UNIT = {
    "velocity_x_mps": "m/s (a thousandth of mm/s)",
    "speed_mps": "m/s; name the column speed_mmps where it is in mm/s",
    "speed_mmps": "mm/s; name the column speed_mps where it is in m/s",
    "position_x_mm": "millimetres; name the columns position_x_m, position_y_m where they are in metres",
    "position_x_m": "metres; name the columns position_x_mm, position_y_mm where they are in millimetres",
}


def _misread_motion(path: Path, motion: Series) -> Iterator[DatasetFileError]:
    speeds = speeds_mps(motion)
    moving = speeds[speeds > 0.2 * np.percentile(speeds, 95)]
    if len(moving) == 0:
        return
    median = float(np.median(moving))
    if not _MINIMUM_SPEED_MPS < median < _MAXIMUM_SPEED_MPS:
        found = f"{motion.columns[0]} gives a speed of {median:.3g} m/s"
        yield DatasetFileError(path, found, _OTHER_UNIT[motion.columns[0]])


def is_position(motion: Series) -> bool:
    return motion.columns[0].startswith("position")


def velocity_of(motion: Series) -> _Doubles:
    """[n, 2] in m/s for motion given as velocity or speed; a speed lies along the first axis."""
    if motion.values.shape[1] == 2:
        return motion.values
    return np.column_stack([np.abs(motion.values[:, 0]), np.zeros(len(motion.values))])


def speeds_mps(motion: Series) -> _Doubles:
    """The speed of each sample, or between positions; unsmoothed except over 50 ms of positions."""
    if not is_position(motion):
        return np.asarray(np.linalg.norm(velocity_of(motion), axis=1))
    step = float(np.median(np.diff(motion.time_seconds)))
    stride = max(1, min(round(0.05 / step), len(motion.values) - 1))
    moved = np.linalg.norm(motion.values[stride:] - motion.values[:-stride], axis=1)
    return np.asarray(moved / np.maximum(motion.time_seconds[stride:] - motion.time_seconds[:-stride], 1e-9))
