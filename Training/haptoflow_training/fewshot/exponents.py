"""The frequency exponent of a material, for speeds beyond the recorded ones."""

from __future__ import annotations

import numpy as np

from haptoflow_training.fewshot.level_law import MINIMUM_SPEED_MPS
from haptoflow_training.fewshot.stroke_recording import Windows
from haptoflow_training.waveform import SAMPLE_RATE_HZ

_MINIMUM_WINDOWS = 12
_BAND_HZ = (20.0, 900.0)
# The spectra of the published textures hardly move with the speed.
_EXPECTED, _CERTAINTY = 0.1, 4.0


def frequency_exponent(windows: Windows) -> float:
    """Slope of the log spectral centroid over log speed in the faster half, 0 to 1, from windows [n, 400] of a
    surface without ribs. With little data the result is drawn towards 0.1."""
    speed = windows.speed_mps
    sliding = (speed > max(MINIMUM_SPEED_MPS, float(np.median(speed)))) & (windows.unsteadiness < 0.5)
    if sliding.sum() < _MINIMUM_WINDOWS:
        return _EXPECTED
    waves = windows.waves[sliding] * np.hanning(windows.waves.shape[1])
    power = np.square(np.abs(np.fft.rfft(waves, axis=1)))
    frequency = np.fft.rfftfreq(windows.waves.shape[1], 1.0 / SAMPLE_RATE_HZ)
    band = (frequency >= _BAND_HZ[0]) & (frequency <= _BAND_HZ[1])
    centroid = (power[:, band] * frequency[band]).sum(axis=1) / (power[:, band].sum(axis=1) + 1e-12)
    place = np.log(speed[sliding])
    place = place - place.mean()
    pitch = np.log(centroid) - np.log(centroid).mean()
    slope = (place @ pitch + _CERTAINTY * _EXPECTED) / (place @ place + _CERTAINTY)
    return float(np.clip(slope, 0.0, 1.0))
