#!/usr/bin/env python3
"""Writes the recording from which the sample Workshop learns a material: its files Recordings/doormat.*.

Ten and a half seconds of a stylus on a material unknown to every model, by the synthetic recorder: strokes back and
forth with varying speed and force. A WAV file of three axes (its name ends in .bytes, so that Unity does not import it
as sound), its sidecar, and a table of motion and force. From the repository root:

PYTHONPATH=Training python3 scripts/pack/sample_recording.py
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

import numpy as np
from scipy import signal
from scipy.io import wavfile

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "Training"))

from haptoflow_benchmark.wave_vector_study import unseen_materials
from haptoflow_training.recordings.recording import STANDARD_GRAVITY_MPS2, Recording  # noqa: E402
from haptoflow_training.recordings.synthetic.materials import load_materials  # noqa: E402
from haptoflow_training.recordings.synthetic.recorder import record_condition  # noqa: E402

FOLDER = ROOT / "Packages/com.haptoflow.runtime/Runtime/SampleScenes/Recordings"
NAME = "doormat"
SECONDS, RATE_HZ, MOTION_HZ = 10.5, 2000, 100
SEED = 17
# Index of the unseen material that lies between carpet and another label.
CARPET = 12
SIMULATION_STEPS = 2000


def hand() -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Times [n] in s, velocities [n] in m/s along both axes, forces [n] in N."""
    time = np.linspace(0.0, SECONDS, SIMULATION_STEPS)
    speed = 0.05 * 6.0 ** (0.5 - 0.5 * np.cos(2.0 * np.pi * 0.23 * time))
    way = np.sin(2.0 * np.pi * 0.9 * time)
    heading = 0.5 * np.sin(2.0 * np.pi * 0.11 * time)
    force = 1.1 + 0.6 * np.sin(2.0 * np.pi * 0.31 * time + 0.7)
    return time, speed * way * np.cos(heading), speed * way * np.sin(heading), force


def waveform(recording: Recording) -> np.ndarray:
    """[n, 3] in m/s^2 at RATE_HZ, without gravity."""
    stamps = recording.acceleration_time_seconds
    dense = np.arange(0.0, SECONDS, 1.0 / (4 * RATE_HZ))
    axes = [np.interp(dense, stamps, axis) for axis in recording.vibration_g.T]
    return STANDARD_GRAVITY_MPS2 * signal.decimate(np.column_stack(axes), 4, axis=0, ftype="fir", zero_phase=True)


def main() -> None:
    material = unseen_materials(load_materials(), CARPET + 1, SEED)[CARPET]
    time, velocity_x, velocity_y, force = hand()
    recording = record_condition(
        material, velocity_mps=(velocity_x, velocity_y), force_newtons=force, duration_seconds=SECONDS, seed=SEED
    )
    acceleration = waveform(recording)
    full_scale = float(np.ceil(1.1 * np.abs(acceleration).max()))
    FOLDER.mkdir(parents=True, exist_ok=True)
    samples = np.round(32767.0 * acceleration / full_scale).astype(np.int16)
    with (FOLDER / f"{NAME}.wav.bytes").open("wb") as file:
        wavfile.write(file, RATE_HZ, samples)
    sidecar = {
        "label": NAME,
        "full_scale_mps2": full_scale,
        "motion": f"{NAME}.motion.csv",
        "licence": "MIT",
        "source": f"HaptoFlow's synthetic recorder: a material between carpet and another label, seed {SEED}",
    }
    (FOLDER / f"{NAME}.json").write_text(json.dumps(sidecar, indent=2) + "\n", encoding="utf-8")
    rows = ["time_s,velocity_x_mps,velocity_y_mps,force_newtons"]
    for moment in np.arange(0.0, SECONDS, 1.0 / MOTION_HZ):
        values = (np.interp(moment, time, column) for column in (velocity_x, velocity_y, force))
        rows.append(f"{moment:.2f}," + ",".join(f"{value:.4f}" for value in values))
    (FOLDER / f"{NAME}.motion.csv").write_text("\n".join(rows) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
