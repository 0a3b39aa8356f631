"""Measures how much a label's training specimens differ from one another, and strokes on one of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from haptoflow_training.recordings.synthetic.materials import Material
from haptoflow_training.recordings.synthetic.measurement import (
    REFERENCE_FORCE_NEWTONS,
    REFERENCE_SPEED_MMPS,
    Design,
    band_level,
    mean_spectrum,
    recorded_waveforms,
    slope_db_per_octave,
)
from haptoflow_training.recordings.synthetic.specimens import HELD_OUT_SPECIMEN, TRAINING_SPECIMENS


@dataclass(frozen=True)
class SpreadMeasurement:
    """Standard deviations at the reference condition: of the training specimens' levels in dB and slopes in dB per
    octave; and of the levels of strokes at different places of one specimen, in dB. mean_db: mean level of the training
    specimens over that of the held-out one."""

    specimen_db: float
    specimen_slope_db_per_octave: float
    place_db: float
    mean_db: float


def measure_spread(material: Material, *, seed: int, design: Design = Design()) -> SpreadMeasurement:
    """All specimens are met on the same paths."""
    levels, slopes, places = [], [], []
    directions = len(design.directions_degrees)
    for specimen in (*TRAINING_SPECIMENS, HELD_OUT_SPECIMEN):
        waveforms = recorded_waveforms(
            material, design, (specimen,), REFERENCE_SPEED_MMPS, REFERENCE_FORCE_NEWTONS, seed, design.reference_repeats
        )
        frequency, power = mean_spectrum(waveforms)
        levels.append(20.0 * np.log10(band_level(frequency, power)))
        slopes.append(slope_db_per_octave(frequency, power))
        strokes = np.array([band_level(*mean_spectrum([wave])) for wave in waveforms]).reshape(-1, directions)
        # Directions differ by grain and ribs, which is not the place.
        places.append(np.var(20.0 * np.log10(strokes), axis=0, ddof=1))
    trained = levels[:-1]
    return SpreadMeasurement(
        float(np.std(trained, ddof=1)),
        float(np.std(slopes[:-1], ddof=1)),
        float(np.sqrt(np.mean(places))),
        float(np.mean(trained) - levels[-1]),
    )
