"""Own recordings in every form, made from a stroke whose vibration is known."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.io import wavfile

RATE_HZ = 4000


@dataclass(frozen=True)
class Stroke:
    """time_seconds [n]; acceleration_mps2 [n]; velocity_mps [n, 2]; position_mm [n, 2]; force_newtons [n]."""

    time_seconds: NDArray[np.float64]
    acceleration_mps2: NDArray[np.float64]
    velocity_mps: NDArray[np.float64]
    position_mm: NDArray[np.float64]
    force_newtons: NDArray[np.float64]


def stroke(
    seconds: float = 10.0,
    *,
    hertz: float = 120.0,
    exponent: float = 1.0,
    rate_hz: int = RATE_HZ,
    speeds_mps: tuple[float, float] = (0.05, 0.2),
    seed: int = 0,
) -> Stroke:
    """A stroke back and forth with varying speed; noise about `hertz` with RMS 20 v^exponent m/s^2 at 1 N."""
    generator = np.random.default_rng(seed)
    time = np.arange(int(seconds * rate_hz)) / rate_hz
    slow, fast = np.log(speeds_mps)
    speed = np.exp(0.5 * (slow + fast) + 0.5 * (fast - slow) * np.sin(2 * np.pi * time / 3.0))
    angle = 0.4 * np.sin(2 * np.pi * time / 4.0)
    velocity = np.column_stack([speed * np.cos(angle), speed * np.sin(angle)])
    position = 1000.0 * np.cumsum(velocity, axis=0) / rate_hz
    force = 1.0 + 0.2 * np.sin(2 * np.pi * time / 5.0)
    noise = generator.standard_normal(len(time))
    frequency = np.fft.rfftfreq(len(time), 1.0 / rate_hz)
    shaped = np.fft.irfft(np.fft.rfft(noise) * np.exp(-np.square(np.log((frequency + 1.0) / hertz)) / 0.3), len(time))
    shaped *= 20.0 * speed**exponent * force**0.3 / np.sqrt(np.mean(shaped**2))
    return Stroke(time, shaped, velocity, position, force)


def write_table(path: Path, columns: dict[str, NDArray[np.floating]], sidecar: dict[str, Any] | None = None) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    rows = np.column_stack(list(columns.values()))
    np.savetxt(path, rows, fmt="%.7g", delimiter=",", header=",".join(columns), comments="")
    return with_sidecar(path, sidecar)


def with_sidecar(path: Path, sidecar: dict[str, Any] | None) -> Path:
    if sidecar is not None:
        path.with_suffix(".json").write_text(json.dumps(sidecar), encoding="utf-8")
    return path


def three_axes(acceleration: NDArray[np.floating], unit: float = 1.0) -> list[NDArray[np.floating]]:
    """The vibration along one direction in space, with gravity on Z."""
    return [0.6 * acceleration / unit, 0.0 * acceleration + 1e-4, (0.8 * acceleration - 9.80665) / unit]


def csv_one_axis(folder: Path, name: str, label: str, made: Stroke, **sidecar: Any) -> Path:
    columns = {
        "time_s": made.time_seconds,
        "acceleration_mps2": made.acceleration_mps2,
        "velocity_x_mps": made.velocity_mps[:, 0],
        "velocity_y_mps": made.velocity_mps[:, 1],
        "force_newtons": made.force_newtons,
    }
    return write_table(folder / f"{name}.csv", columns, {"label": label, **sidecar})


def csv_three_axes(folder: Path, name: str, label: str, made: Stroke, **sidecar: Any) -> Path:
    x, y, z = three_axes(made.acceleration_mps2, 9.80665)
    columns = {
        "time_s": made.time_seconds,
        "acceleration_x_g": x,
        "acceleration_y_g": y,
        "acceleration_z_g": z,
        "position_x_mm": made.position_mm[:, 0],
        "position_y_mm": made.position_mm[:, 1],
        "force_millinewtons": 1000.0 * made.force_newtons,
    }
    return write_table(folder / f"{name}.csv", columns, {"label": label, **sidecar})


def wav_with_motion(folder: Path, name: str, label: str, made: Stroke, **sidecar: Any) -> Path:
    """16 bits, +-1 = 50 m/s^2; the motion at 100 readings a second with its own clock."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{name}.wav"
    wavfile.write(path, RATE_HZ, np.round(made.acceleration_mps2 / 50.0 * 32767.0).astype(np.int16))
    rows = slice(0, None, RATE_HZ // 100)
    columns = {
        "time_s": made.time_seconds[rows],
        "position_x_m": made.position_mm[rows, 0] / 1000.0,
        "position_y_m": made.position_mm[rows, 1] / 1000.0,
        "force_newtons": made.force_newtons[rows],
    }
    write_table(folder / f"{name}.motion.csv", columns)
    return with_sidecar(path, {"label": label, "full_scale_mps2": 50.0, "motion": f"{name}.motion.csv", **sidecar})
