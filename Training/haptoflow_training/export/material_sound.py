"""A material's own level and tone: tables over speed, as the engine reads them.

Documentation~/own-materials.md, "The material file", is the specification. Computed in double precision here; the
engine may round to single.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from haptoflow_training.models.conditioning import REST_FORCE_NEWTONS, REST_SPEED_MPS
from haptoflow_training.waveform import SAMPLE_RATE_HZ

KERNEL_SAMPLES = 64
RESPONSE_SAMPLES = 256
MAXIMUM_LEVEL_SPEEDS = 16
TONE_LIMIT_DB = 30.0

_Doubles = NDArray[np.float64]


@dataclass(frozen=True)
class LevelTable:
    """Natural logarithm of the RMS in m/s^2, before tone, at `force_newtons`, for each of the ascending
    `speeds_mps`."""

    speeds_mps: tuple[float, ...]
    log_levels: tuple[float, ...]
    force_newtons: float
    force_exponent: float

    def log_level(self, speed_mps: ArrayLike, force_newtons: ArrayLike, speed_exponent: float) -> _Doubles:
        """The natural log level at any speed (m/s, 0 or more) and force (N). speed_exponent: of the label, used
        beyond the table's ends."""
        place = np.log(np.asarray(speed_mps, dtype=np.float64) + REST_SPEED_MPS)
        knots = np.log(np.asarray(self.speeds_mps) + REST_SPEED_MPS)
        beyond = place - np.clip(place, knots[0], knots[-1])
        force = np.maximum(np.asarray(force_newtons, dtype=np.float64), REST_FORCE_NEWTONS)
        inside = np.interp(place, knots, np.asarray(self.log_levels))
        pressed = self.force_exponent * np.log(force / self.force_newtons)
        return np.asarray(inside + speed_exponent * beyond + pressed)

    def to_json(self) -> dict[str, Any]:
        return {
            "speeds_mps": list(self.speeds_mps),
            "log_levels": list(self.log_levels),
            "force_newtons": self.force_newtons,
            "force_exponent": self.force_exponent,
        }


@dataclass(frozen=True)
class ToneTable:
    """Gains in dB: `gains_db` has a row for each of the ascending `speeds_mps`, with a value for each of the
    ascending `frequencies_hz`."""

    speeds_mps: tuple[float, ...]
    frequencies_hz: tuple[float, ...]
    gains_db: tuple[tuple[float, ...], ...]

    def gain_db(self, speed_mps: float, frequency_hz: ArrayLike) -> _Doubles:
        """Gains at one speed (m/s) and any frequencies (Hz): linear in log speed and log frequency, constant beyond
        the ends."""
        rows = np.asarray(self.gains_db)
        known = np.log(self.speeds_mps)
        place = float(np.clip(math.log(max(speed_mps, 1e-9)), known[0], known[-1]))
        row = np.array([np.interp(place, known, column) for column in rows.T])
        low, high = self.frequencies_hz[0], self.frequencies_hz[-1]
        wanted = np.log(np.clip(np.asarray(frequency_hz, dtype=np.float64), low, high))
        return np.asarray(np.interp(wanted, np.log(self.frequencies_hz), row))

    def kernel(self, speed_mps: float) -> _Doubles:
        """[64]: the minimum-phase filter at 2 kHz that is applied at this speed."""
        frequency = np.arange(RESPONSE_SAMPLES // 2 + 1) * (SAMPLE_RATE_HZ / RESPONSE_SAMPLES)
        return minimum_phase(self.gain_db(speed_mps, frequency))

    def to_json(self) -> dict[str, Any]:
        return {
            "speeds_mps": list(self.speeds_mps),
            "frequencies_hz": list(self.frequencies_hz),
            "gains_db": [list(row) for row in self.gains_db],
        }


def minimum_phase(gain_db: _Doubles) -> _Doubles:
    """The first 64 samples of the minimum-phase impulse response whose gains in dB at 129 frequencies from 0 to 1000 Hz
    are given.

    Computed by the real cepstrum: folding its negative times onto the positive ones keeps the magnitude and makes the
    phase minimal. (SciPy's `minimum_phase` takes a filter, not a magnitude response, before version 1.14.)
    """
    logarithm = np.asarray(gain_db, dtype=np.float64) * (math.log(10.0) / 20.0)
    cepstrum = np.fft.irfft(logarithm, RESPONSE_SAMPLES)
    half = RESPONSE_SAMPLES // 2
    cepstrum[1:half] *= 2.0
    cepstrum[half + 1 :] = 0.0
    response = np.fft.irfft(np.exp(np.fft.rfft(cepstrum)), RESPONSE_SAMPLES)
    return np.asarray(response[:KERNEL_SAMPLES])
