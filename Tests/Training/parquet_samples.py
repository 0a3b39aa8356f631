"""What the Parquet files of Tests/Golden/parquet hold, computed without them."""

from __future__ import annotations

import atexit
import dataclasses
import shutil
import tempfile
from pathlib import Path

import numpy as np
import pandas
from dataset_samples import small_recording

from haptoflow_training.recordings.recording import Recording

GOLDEN = Path(__file__).resolve().parents[1] / "Golden" / "parquet"
COLUMNS, HUB_FILES = GOLDEN / "columns", GOLDEN / "hub"
# After 2^53 ns (104 days) a double cannot count single nanoseconds.
FIRST_NANOSECONDS = 1_764_000_000_123_456_789
HUB_NAMES = ("0_0_40_500_0", "0_90_40_500_1", "38_0_40_500_0", "38_90_40_500_1", "49_0_40_500_0")


def _hub_release() -> Path:
    """The files of `hub` in the layout of the data set's hub release, for as long as this process lasts."""
    root = Path(tempfile.mkdtemp(prefix="hub-"))
    atexit.register(shutil.rmtree, root, ignore_errors=True)
    for file in HUB_FILES.glob("*.parquet"):
        kind, name = file.stem.split("_", 1)
        target = root / "sensor_data" / kind / name.split("_")[0] / f"{name}.parquet"
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(file, target)
    shutil.copy(HUB_FILES / "texture_list.xlsx", root)
    return root


HUB = _hub_release()


def column_table(rows: int, *, missing: bool = True) -> pandas.DataFrame:
    """Columns of every kind that is read: time_ns int64 odd in its last digits, X and Y float32, force float64, Z
    float32 with a value missing in every 197th row, count int32."""
    row = np.arange(rows)
    z = ((row * 37) % 2001 / 1000 - 1.5).astype(np.float32)
    if missing:
        z[5::197] = np.nan
    return pandas.DataFrame(
        {
            "time_ns": FIRST_NANOSECONDS + row.astype(np.int64) * 115_607,
            "X": ((row * 53) % 401 / 1000 - 0.2).astype(np.float32),
            "Y": (row / 7).astype(np.float32),
            "Z": z,
            "force": 0.5 + row / 3,
            "count": (row % 5 - 2).astype(np.int32),
        }
    )


def hub_recording(name: str) -> Recording:
    """As `small_recording`, with every second row of the acceleration, so that the files are small."""
    recording = small_recording(name, seconds=2.8, quiet_rests=False)
    return dataclasses.replace(
        recording,
        acceleration_time_seconds=recording.acceleration_time_seconds[::2],
        acceleration_g=recording.acceleration_g[::2],
    )


def hub_tables(recording: Recording) -> dict[str, pandas.DataFrame]:
    """The three sensors' tables as the hub's release has them: int64 nanoseconds and float32 values."""
    position, acceleration = recording.position_mm, recording.acceleration_g
    return {
        "accel": _hub_table(recording.acceleration_time_seconds, dict(zip("XYZ", acceleration.T, strict=True))),
        "force": _hub_table(recording.force_time_seconds, {"force": recording.force_newtons}),
        "position": _hub_table(recording.position_time_seconds, dict(zip("XY", position.T, strict=True))),
    }


def _hub_table(seconds: np.ndarray, values: dict[str, np.ndarray]) -> pandas.DataFrame:
    nanoseconds = np.round(1e9 * seconds).astype(np.int64)
    stored = {key: value.astype(np.float32) for key, value in values.items()}
    return pandas.DataFrame({"time_ns": nanoseconds, **stored})
