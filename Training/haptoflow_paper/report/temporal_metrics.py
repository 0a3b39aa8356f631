"""Measures in time of a generated waveform beside a recorded one: impacts, modulation of the envelope, and ribs.

Averaged spectra do not show these: Gaussian noise with the right spectrum would pass. Waveforms are one-dimensional, 2
kHz, m/s^2. haptoflow_paper/results/accuracy-and-time.md repeats the definitions.
"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.recordings.synthetic.materials import Material
from haptoflow_training.waveform import SAMPLE_RATE_HZ

# Frames of 5 ms: shorter than the hand's resolution in time, longer than the periods of perceived pitch.
ENVELOPE_SAMPLES = 10
ENVELOPE_RATE_HZ = SAMPLE_RATE_HZ / ENVELOPE_SAMPLES
MODULATION_EDGES_HZ = (2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0, 24.0, 32.0, 48.0, 64.0, 100.0)
# A band without any modulation counts as this much.
_WORST_BAND_DB = 20.0
# Ribs at other rates are neither a line nor followed for half a second.
RIB_RATES_HZ = (4.0, 800.0)
_DEPTH_WINDOW_SECONDS = 0.5
_FLOOR = 1e-12

_Wave = NDArray[np.floating]
_Doubles = NDArray[np.float64]


def kurtosis(values: _Wave) -> float:
    """E[(x - m)^4] / E[(x - m)^2]^2: 3 for Gaussian noise, 1.5 for a sine, more with rare events.
    (scipy.stats.kurtosis(fisher=False), written out for silent input.)"""
    centred = np.asarray(values, dtype=np.float64) - np.mean(values)
    power = np.square(centred).mean()
    return float(np.mean(centred**4) / (power**2 + _FLOOR**2)) if power > 0.0 else 0.0


def crest_factor(wave: _Wave) -> float:
    """99.9th percentile of |x| over the RMS: 3.29 for Gaussian noise, 1.41 for a sine."""
    magnitude = np.abs(np.asarray(wave, dtype=np.float64))
    return float(np.quantile(magnitude, 0.999) / (np.sqrt(np.square(magnitude).mean()) + _FLOOR))


def envelope(wave: _Wave) -> _Doubles:
    """RMS in frames of 10 samples without overlap, [n / 10]: 200 values a second."""
    count = len(wave) // ENVELOPE_SAMPLES
    frames = np.asarray(wave[: count * ENVELOPE_SAMPLES], dtype=np.float64).reshape(count, ENVELOPE_SAMPLES)
    return np.sqrt(np.square(frames).mean(axis=1))


def variation(values: _Doubles) -> float:
    """Coefficient of variation: standard deviation over mean."""
    return float(np.std(values) / (np.mean(values) + _FLOOR))


def modulation_spectrum_db(wave: _Wave) -> _Doubles:
    """Power of the envelope in bands of modulation frequency, dB over its squared mean, [11].

    The envelope is divided by its mean; Hann windows of one second, half overlapped, each without its mean. 0 dB in a
    band is a modulation of 100 % RMS, and the level has no effect.
    """
    values = envelope(wave)
    values = values / (values.mean() + _FLOOR)
    length = min(len(values), int(ENVELOPE_RATE_HZ))
    window = np.hanning(length + 1)[:-1]
    frames = np.lib.stride_tricks.sliding_window_view(values, length)[:: max(1, length // 2)]
    frames = (frames - frames.mean(axis=1, keepdims=True)) * window
    # Parseval: one-sided sums of this are the mean square of the frame.
    power = 2.0 * np.square(np.abs(np.fft.rfft(frames, axis=1))).mean(axis=0) / (length * np.square(window).sum())
    frequency = np.fft.rfftfreq(length, 1.0 / ENVELOPE_RATE_HZ)
    bands = pairwise(MODULATION_EDGES_HZ)
    sums = [power[(frequency >= low) & (frequency < high)].sum() for low, high in bands]
    return np.asarray(10.0 * np.log10(np.array(sums) + 1e-8))


def modulation_error_db(generated: _Wave, recorded: _Wave) -> float:
    """Mean over bands from 2 to 100 Hz of the absolute difference of modulation spectra in dB, limited to 20 dB in
    each band."""
    difference = np.abs(modulation_spectrum_db(generated) - modulation_spectrum_db(recorded))
    return float(np.minimum(difference, _WORST_BAND_DB).mean())


def rib_rates_hz(material: Material, speed_mps: float, direction_degrees: float) -> tuple[float, ...]:
    """|k . v| of each family of ribs, the dominant first; those outside 4-800 Hz are left out."""
    families = sorted(material.rulings, key=lambda ruling: -ruling.relative_height)
    rates = []
    for ruling in families:
        crossing = math.cos(math.radians(direction_degrees - ruling.direction_degrees))
        rates.append(abs(1000.0 * speed_mps * crossing) / ruling.wavelength_mm)
    return tuple(rate for rate in rates if RIB_RATES_HZ[0] <= rate <= RIB_RATES_HZ[1])


def rib_modulation_depth(wave: _Wave, rib_rate_hz: float) -> float:
    """Depth m of the power's modulation at the rib rate: x^2 = P (1 + m cos(2 pi f t) + ...), 0 to 2.

    m^2 = 4 mean over windows of |sum w x^2 e^(-2 pi i f t)|^2 / (sum w)^2 / P^2, less the same at frequencies beside f,
    which noise alone would give. Hann windows of half a second or four ribs, half overlapped.
    """
    power = np.square(np.asarray(wave, dtype=np.float64))
    mean = power.mean()
    length = min(len(power), int(SAMPLE_RATE_HZ * max(_DEPTH_WINDOW_SECONDS, 4.0 / rib_rate_hz)))
    window = np.hanning(length + 1)[:-1]
    frames = np.lib.stride_tricks.sliding_window_view(power, length)[:: max(1, length // 2)] - mean
    spacing = SAMPLE_RATE_HZ / length
    beside = [rib_rate_hz + sign * step * spacing for step in (3, 4, 5, 6) for sign in (-1, 1)]
    frequencies = np.array([rib_rate_hz, *(entry for entry in beside if entry > spacing)])
    time = np.arange(length) / SAMPLE_RATE_HZ
    kernel = window[:, None] * np.exp(-2j * np.pi * time[:, None] * frequencies[None, :])
    found = 4.0 * np.square(np.abs(frames @ kernel)).mean(axis=0) / window.sum() ** 2 / (mean**2 + _FLOOR)
    return float(np.sqrt(max(found[0] - np.median(found[1:]), 0.0)))


def rib_modulation_error_db(generated: _Wave, recorded: _Wave, rib_rate_hz: float) -> float:
    """20 log10 of the generated depth over the recorded one; negative if the ribs are too weak. A depth below 0.01
    counts as 0.01."""
    depths = [max(0.01, rib_modulation_depth(wave, rib_rate_hz)) for wave in (generated, recorded)]
    return 20.0 * float(np.log10(depths[0] / depths[1]))


def folded(ratio: float) -> float:
    """The smaller of a ratio and its inverse, so that too much and too little count alike; 0 for 0."""
    return min(ratio, 1.0 / ratio) if ratio > 0.0 else 0.0


def log_ratio(generated: float, recorded: float) -> float:
    """ln of generated over recorded, signed; both at least 0.01."""
    return float(np.log(max(generated, 0.01) / max(recorded, 0.01)))
