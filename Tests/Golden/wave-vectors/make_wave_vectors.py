"""Writes recordings of strokes for the search for wave vectors: corduroy.json, jute.json, sandpaper.json. The wave vectors
that the files state are kept.

Run from the repository root: PYTHONPATH=Training python3 Tests/Golden/wave-vectors/make_wave_vectors.py
"""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.preprocessing.pipeline import preprocess_recording
from haptoflow_training.preprocessing.settings import PreprocessingSettings
from haptoflow_training.recordings.synthetic import Material, load_materials, record_condition

HERE = Path(__file__).parent
RATE_HZ = 2000
STROKE_SAMPLES = 1200
# Whole strokes and the part of one at either end that preparing trims away.
STROKES = 17
# Seeds of which every step of the estimator counts: see README.md.
CASES = (("corduroy", 1), ("jute", 3), ("sandpaper", 1))
MAXIMUM = 999


def strokes(seed: int) -> NDArray[np.float64]:
    """[strokes, 2] in m/s: each in a direction and at a speed of its own."""
    rng = np.random.default_rng(seed)
    speed = np.exp(rng.uniform(np.log(0.05), np.log(0.35), STROKES))
    angle = 2.4 * np.arange(STROKES) + rng.uniform(0.0, 6.28)
    return np.round(speed[:, None] * np.column_stack([np.cos(angle), np.sin(angle)]), 4)


def case(material: Material, seed: int) -> dict[str, object]:
    settings = PreprocessingSettings()
    velocity = np.repeat(strokes(seed), STROKE_SAMPLES, axis=0)
    recorded = record_condition(
        material, velocity_mps=(velocity[:, 0], velocity[:, 1]), force_newtons=1.0,
        duration_seconds=len(velocity) / RATE_HZ, seed=seed,
    )  # fmt: skip
    wave = preprocess_recording(recorded, settings).waveform_mps2
    trimmed = round(settings.trim_seconds * RATE_HZ)
    velocity = velocity[trimmed : trimmed + len(wave)]
    scale = float(np.float32(np.abs(wave).max() / MAXIMUM))
    whole = np.round(wave / scale).astype(int)
    changes = np.flatnonzero(np.any(velocity[1:] != velocity[:-1], axis=1)) + 1
    begins = np.concatenate([[0], changes])
    counts = np.diff(np.append(begins, len(wave)))
    content: dict[str, object] = {
        "material": material.label,
        "rate_hz": RATE_HZ,
        "force_newtons": 1.0,
        "strokes": [
            {"samples": int(count), "velocity_mps": velocity[begin].tolist()}
            for begin, count in zip(begins, counts, strict=True)
        ],
        "scale_mps2": scale,
        "wave": whole.tolist(),
    }
    stated = json.loads((HERE / f"{material.label}.json").read_text(encoding="utf-8"))
    content["wave_vectors_per_mm"] = stated["wave_vectors_per_mm"]
    return content


def main() -> None:
    materials = {material.label: material for material in load_materials()}
    for label, seed in CASES:
        text = json.dumps(case(materials[label], seed), separators=(",", ":"))
        (HERE / f"{label}.json").write_text(text + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
