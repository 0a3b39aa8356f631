"""Biquads of tool and sensor, by the bilinear transform; sections as SciPy's `sosfilt` takes them."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Section = NDArray[np.float64]

_TILT_CORNERS_HZ = tuple(30.0 * 2.0**index for index in range(6))


def _denominator(frequency_hz: float, damping: float, rate_hz: float) -> tuple[float, float, float, float]:
    k = math.tan(math.pi * min(frequency_hz, 0.45 * rate_hz) / rate_hz)
    a0 = 1.0 + 2.0 * damping * k + k * k
    return k, a0, 2.0 * (k * k - 1.0) / a0, (1.0 - 2.0 * damping * k + k * k) / a0


def contact_from_acceleration(frequency_hz: float, damping: float, rate_hz: float) -> Section:
    """A mass on its contact spring: w^2 / (s^2 + 2 d w s + w^2), unity at rest."""
    k, a0, a1, a2 = _denominator(frequency_hz, damping, rate_hz)
    gain = k * k / a0
    return np.array([[gain, 2.0 * gain, gain, 1.0, a1, a2]])


def contact_from_height(frequency_hz: float, damping: float, rate_hz: float) -> Section:
    """The same contact fed by a height in metres: s^2 w^2 / (...), acceleration without a derivative."""
    k, a0, a1, a2 = _denominator(frequency_hz, damping, rate_hz)
    gain = (2.0 * rate_hz * k) ** 2 / a0
    return np.array([[gain, -2.0 * gain, gain, 1.0, a1, a2]])


def absorption(db_per_octave: float, rate_hz: float) -> Section:
    """A tilt of `db_per_octave` between 20 Hz and 1 kHz, 0 dB at 100 Hz: pole-zero pairs an octave apart."""
    ratio = 2.0 ** (db_per_octave / 6.0206)
    sections = []
    gain_at_100 = 1.0
    for corner in _TILT_CORNERS_HZ:
        zero, pole = corner / math.sqrt(ratio), corner * math.sqrt(ratio)
        wz, wp = (math.tan(math.pi * min(each, 0.45 * rate_hz) / rate_hz) for each in (zero, pole))
        b0, b1, a0, a1 = (1.0 + wz) / wz, (wz - 1.0) / wz, (1.0 + wp) / wp, (wp - 1.0) / wp
        sections.append([b0 / a0, b1 / a0, 0.0, 1.0, a1 / a0, 0.0])
        turn = np.exp(-2j * math.pi * 100.0 / rate_hz)
        gain_at_100 *= abs((b0 + b1 * turn) / (a0 + a1 * turn))
    result = np.array(sections)
    result[0, :3] /= gain_at_100
    return result


def peak(frequency_hz: float, gain_db: float, q: float, rate_hz: float) -> Section:
    """A resonance (or an absorption, with negative gain) of a tool or a sensor mount; 0 dB far away."""
    w = 2.0 * math.pi * min(frequency_hz, 0.45 * rate_hz) / rate_hz
    amplitude, alpha = 10.0 ** (gain_db / 40.0), math.sin(w) / (2.0 * q)
    a0 = 1.0 + alpha / amplitude
    return np.array(
        [[
            (1.0 + alpha * amplitude) / a0, -2.0 * math.cos(w) / a0, (1.0 - alpha * amplitude) / a0,
            1.0, -2.0 * math.cos(w) / a0, (1.0 - alpha / amplitude) / a0,
        ]]
    )
