"""Draws Documentation~/images/crossing-lag.png: the crossing of the demo, the pen's speed and the vibration's level.

Run from the repository's root, after `npm run build`:

    /usr/bin/python3 scripts/pack/crossing_picture.py

The level is that of windows of 10 ms over 16 renders with other seeds. The lag is the shift at which log level and log
speed correlate best, over all of the stroke that touches.
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from renders import MODEL, ROOT, SAMPLES, contacts_of, read_wave, render_file, save
from scipy.ndimage import uniform_filter1d

SCENE = SAMPLES / "HeadlessScenes/crossing.scene.json"
STROKE = SAMPLES / "HeadlessScenes/crossing.stroke.csv"
PICTURE = ROOT / "Documentation~/images/crossing-lag.png"
RATE_HZ = 8000
SEEDS = range(1, 17)
SHOWN_SECONDS = (4.9, 6.5)
FLOOR_MPS = 0.01
FULL_SCALE_MPS2 = 200.0


def levels_db() -> np.ndarray:
    """Level [n] in dB re 1 m/s^2 at RATE_HZ."""
    power = []
    with tempfile.TemporaryDirectory() as folder:
        for seed in SEEDS:
            wav = Path(folder) / "crossing.wav"
            render_file(SCENE, STROKE, wav, "--seed", seed, "--rate", RATE_HZ, "--model", MODEL)
            power.append(np.square(read_wave(wav)[1] * FULL_SCALE_MPS2))
    shortest = min(len(each) for each in power)
    mean = np.mean([each[:shortest] for each in power], axis=0)
    return 10.0 * np.log10(uniform_filter1d(mean, RATE_HZ // 100) + 1e-8)


def true_speed() -> tuple[np.ndarray, np.ndarray]:
    """Seconds and the pen's speed over the table in m/s, at 1 kHz, from the stroke's own points."""
    rows = np.loadtxt(STROKE, delimiter=",", skiprows=1)
    times = np.arange(0.0, rows[-1, 0], 1e-3)
    places = np.stack([np.interp(times, rows[:, 0], rows[:, axis]) for axis in (1, 3)], axis=1)
    velocity = np.gradient(uniform_filter1d(places, 9, axis=0), times, axis=0)
    return times, np.hypot(*velocity.T)


def lag_ms(times: np.ndarray, speed: np.ndarray, level_db: np.ndarray, touching: np.ndarray) -> float:
    wanted = 20.0 * np.log10(np.maximum(speed, FLOOR_MPS))

    def likeness(lag_seconds: float) -> float:
        shifted = np.interp(times + lag_seconds, np.arange(len(level_db)) / RATE_HZ, level_db)
        return float(np.corrcoef(shifted[touching], wanted[touching])[0, 1])

    lags = np.arange(0.0, 0.06, 0.0005)
    return float(1e3 * lags[int(np.argmax([likeness(lag) for lag in lags]))])


def main() -> None:
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()
    times, speed = true_speed()
    contacts = contacts_of(SCENE, STROKE)
    touches = [float(row["touching"]) for row in contacts]
    # Landings and lift-offs have levels of their own.
    touching = uniform_filter1d(np.interp(times, [float(row["t"]) for row in contacts], touches), 201) > 0.99
    figure, axis = plt.subplots(figsize=(9.0, 2.9), layout="constrained")
    level = levels_db()
    lag = lag_ms(times, speed, level, touching)
    print(f"{lag:.1f} ms")
    axis.plot(times, 1000.0 * speed, color="#8fa3b8", label="speed of the pen, mm/s")
    axis.set_ylabel("mm/s")
    other = axis.twinx()
    other.plot(np.arange(len(level)) / RATE_HZ, level, color="#b4533c", label="level of the vibration, dB")
    other.set_ylim(-30.0, 30.0)
    other.set_ylabel("dB re 1 m/s²")
    axis.set_title(f"the level follows the speed {lag:.0f} ms later", loc="left", fontsize=11)
    lines = [*axis.lines, *other.lines]
    place = {"loc": "lower right", "bbox_to_anchor": (1.0, 1.0), "ncols": 2, "frameon": False, "fontsize": 9}
    axis.legend(lines, [str(line.get_label()) for line in lines], **place)
    axis.set_xlim(*SHOWN_SECONDS)
    axis.set_xlabel("s")
    save(figure, PICTURE)


if __name__ == "__main__":
    main()
