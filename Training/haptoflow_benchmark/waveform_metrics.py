"""Measures of a generated waveform beside a recorded one. accuracy-and-time.md of the comparison defines every figure.

All waveforms are one-dimensional, 2 kHz, m/s^2.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.waveform import SAMPLE_RATE_HZ

_FLOOR = 1e-9
# A vibration below this cannot be felt, whatever its spectrum.
_UNFELT_MPS2 = 0.01
_GFC_POINTS = 1024

_Wave = NDArray[np.floating]
_Doubles = NDArray[np.float64]


def _frames(wave: _Wave, window: int) -> _Doubles:
    """[frames, window]: Hann-windowed, half overlapped."""
    wave = np.asarray(wave, dtype=np.float64)
    hop = max(1, window // 2)
    return np.lib.stride_tricks.sliding_window_view(wave, window)[::hop] * np.hanning(window + 1)[:-1]


def power_spectrum(wave: _Wave, window: int) -> _Doubles:
    """Mean power over Hann-windowed frames, half overlapped, [window / 2 + 1]."""
    return np.asarray(np.square(np.abs(np.fft.rfft(_frames(wave, window), axis=1))).mean(axis=0))


def gfc_recording(generated: _Wave, recorded: _Wave) -> float:
    """GFC (goodness of fit criterion) of the spectra of whole recordings: window min(L, 1024), 1024-point FFT."""
    first, second = (
        np.abs(np.fft.rfft(_frames(wave, min(_GFC_POINTS, len(wave))), _GFC_POINTS, axis=1)).mean(axis=0)
        for wave in (generated, recorded)
    )
    return float((first * second).sum() / (np.sqrt((first**2).sum() * (second**2).sum()) + _FLOOR))


def rms(wave: _Wave) -> float:
    return float(np.sqrt(np.square(np.asarray(wave, dtype=np.float64)).mean()))


def level_error_db(generated: _Wave, recorded: _Wave) -> float:
    """Signed level error; negative is too weak."""
    return 20.0 * float(np.log10((rms(generated) + _FLOOR) / (rms(recorded) + _FLOOR)))


def log_spectral_distance_db(generated: _Wave, recorded: _Wave, band_hz: tuple[float, float] = (20.0, 1000.0)) -> float:
    """RMS over band_hz of the difference of mean power spectra in dB, 128 ms windows (7.8 Hz), above the spectrum of a
    white vibration of 0.01 m/s^2: nobody feels what recordings without sensor noise have below it."""
    window = 256
    floor = np.square(_UNFELT_MPS2) * np.square(np.hanning(window + 1)[:-1]).sum()
    frequency = np.fft.rfftfreq(window, 1.0 / SAMPLE_RATE_HZ)
    band = (frequency >= band_hz[0]) & (frequency <= band_hz[1])
    difference = 10.0 * np.log10(
        (power_spectrum(generated, window)[band] + floor) / (power_spectrum(recorded, window)[band] + floor)
    )
    return float(np.sqrt(np.square(difference).mean()))
