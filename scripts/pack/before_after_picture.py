"""Draws three labels as recorded, as an older engine with its model renders them, and as this one does: spectra and a
tenth of a second of each.

Run from the repository's root, after `npm run build`:

    PYTHONPATH=Training /usr/bin/python3 scripts/pack/before_after_picture.py --baseline older/build/native/haptoflow \\
        --baseline-model older/Packages/com.haptoflow.runtime/Runtime/Models/default.haptoflow --out before-after.png
"""

from __future__ import annotations

import argparse
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import renders
from renders import MODEL, render
from scipy.signal import resample_poly, welch

from haptoflow_training.preprocessing.pipeline import preprocess_recording
from haptoflow_training.preprocessing.settings import PreprocessingSettings
from haptoflow_training.recordings.synthetic import load_materials, record_condition

# Each column: label, speed in m/s, and what differs there between before and now.
SHOWN = (
    ("wood", 0.01, "slow: the sensor's noise was learnt as well"),
    ("corduroy", 0.15, "ribs and their depth"),
    ("rubber", 0.08, "stick and slip"),
)
RATE_HZ, FORCE_NEWTONS, SECONDS, WAVE_SECONDS = 2000, 1.0, 6.0, 0.1


def recorded(label: str, speed_mps: float) -> np.ndarray:
    material = next(entry for entry in load_materials() if entry.label == label)
    recording = record_condition(
        material, velocity_mps=(speed_mps, 0.0), force_newtons=FORCE_NEWTONS, duration_seconds=SECONDS, seed=7,
        accelerometer_noise=False,
    )  # fmt: skip
    return preprocess_recording(recording, PreprocessingSettings()).waveform_mps2[RATE_HZ // 2 :]


def rendered(engine: Path, model: Path, label: str, speed_mps: float) -> np.ndarray:
    renders.ENGINE = engine
    times = np.arange(0.0, SECONDS, 1.0 / 120.0)
    nothing = np.zeros_like(times)
    stroke = np.stack([times, speed_mps * times, nothing, nothing, nothing + FORCE_NEWTONS], axis=1)
    scene = {"surfaces": [{"name": label, "shape": {"plane": {}}, "material": label}]}
    felt = render(scene, stroke, "--model", model, "--rate", 8000)
    return resample_poly(felt.acceleration_mps2, 1, 4)[RATE_HZ // 2 : -RATE_HZ // 2]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--baseline", type=Path, required=True, help="command line of an older engine")
    parser.add_argument("--baseline-model", type=Path, required=True, help="its model file")
    parser.add_argument("--out", type=Path, required=True, help="PNG file to write")
    options = parser.parse_args()
    engine = renders.ENGINE
    figure, axes = plt.subplots(2, len(SHOWN), figsize=(13.0, 6.0), layout="constrained")
    for (label, speed_mps, words), spectra, waves in zip(SHOWN, *axes, strict=True):
        rows = (
            ("recorded", recorded(label, speed_mps), "#3b3b3b"),
            ("before", rendered(options.baseline, options.baseline_model, label, speed_mps), "#8fa3b8"),
            ("now", rendered(engine, MODEL, label, speed_mps), "#d1495b"),
        )
        peak = 1.1 * max(np.abs(wave[: int(WAVE_SECONDS * RATE_HZ)]).max() for _, wave, _ in rows)
        for place, (name, wave, colour) in enumerate(rows):
            frequencies, power = welch(wave, RATE_HZ, nperseg=1024)
            spectra.plot(frequencies, 10.0 * np.log10(power + 1e-12), color=colour, linewidth=1.0, label=name)
            short = wave[: int(WAVE_SECONDS * RATE_HZ)]
            waves.plot(1e3 * np.arange(len(short)) / RATE_HZ, short - 2.0 * place * peak, color=colour, linewidth=0.8)
        spectra.set_title(f"{label}, {1000.0 * speed_mps:.0f} mm/s: {words}", fontsize=10)
        spectra.set_xlabel("Hz")
        waves.set_xlabel("ms")
        waves.set_yticks([-2.0 * place * peak for place in range(len(rows))], [name for name, _, _ in rows])
    axes[0, 0].set_ylabel("dB re 1 (m/s²)²/Hz")
    axes[0, 0].legend(fontsize=9)
    figure.savefig(options.out, dpi=100)


if __name__ == "__main__":
    main()
