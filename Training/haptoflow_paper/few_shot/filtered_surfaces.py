"""Surfaces in the form in which textures are published: an autoregressive filter for each speed and force.

Culbertson, Unwin and Kuchenbecker ("Modeling and rendering realistic textures from unconstrained tool-surface
interactions", 2014) describe a texture by filters of order 20 over speed and force, driven by Gaussian noise. The
filters here are drawn from a seed, not taken from a data set. That form is also the rivals' own, and the recorder has
no part in it: whoever learns both kinds well has not merely learnt the recorder.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_toeplitz
from scipy.signal import lfilter

from haptoflow_training.preprocessing.filters import zero_phase_high_pass
from haptoflow_training.preprocessing.settings import PreprocessingSettings
from haptoflow_training.waveform import SAMPLE_RATE_HZ

ORDER = 20
HIGH_PASS_HZ = PreprocessingSettings().high_pass_hz
_BLOCK_SAMPLES = 40
_BINS = 513
_COSINES = 10
# Deviations of the natural log amplitude: of the mean, of its change over ln speed and ln force, and of their product.
_MEAN, _SLOPE, _PRODUCT = 0.7, 0.3, 0.15
_MIDDLE_SPEED_MPS, _MIDDLE_FORCE_NEWTONS = 0.08, 0.9

_Doubles = NDArray[np.float64]


@dataclass(frozen=True)
class FilteredSurface:
    """A random texture without ribs or impacts.

    cosines: [4, 10] weights over a warped frequency: the mean, over ln speed, over ln force and over their product.
    level_exponents: of speed and force; bend: of the log level over the square of ln speed.
    """

    label: str
    cosines: _Doubles
    level_mps2: float
    level_exponents: tuple[float, float]
    bend: float
    # What surfaces of the recorder have and these lack.
    rulings: tuple[()] = field(default=())
    wave_vectors_per_mm: tuple[()] = field(default=())
    impact_strength: float = 0.0

    def wave(self, motion: NDArray[np.floating], seed: int) -> NDArray[np.float32]:
        """The vibration [n] in m/s^2 along a motion [n, 3] (vx, vy in m/s, force in N)."""
        settling = 1000
        motion = np.concatenate([np.repeat(motion[:1], settling, axis=0), motion]).astype(np.float64)
        noise = np.random.default_rng(seed).standard_normal(len(motion))
        out, state = np.empty(len(motion)), np.zeros(ORDER)
        for start in range(0, len(motion), _BLOCK_SAMPLES):
            part = slice(start, start + _BLOCK_SAMPLES)
            x, y = conditions(motion[part])
            predictor, drive = self.filter_at(float(x.mean()), float(y.mean()))
            out[part], state = lfilter([drive], np.concatenate([[1.0], predictor]), noise[part], zi=state)
        x, y = conditions(motion)
        # As recordings are: without gravity and slow drift.
        felt = zero_phase_high_pass((out * np.exp(self.log_level(x, y)))[settling:], HIGH_PASS_HZ, SAMPLE_RATE_HZ)
        return felt.astype(np.float32)

    def log_level(self, x: _Doubles, y: _Doubles) -> _Doubles:
        """Natural log of the RMS in m/s^2, before the high-pass, at a condition (see `conditions`)."""
        speed, force = self.level_exponents
        return np.asarray(np.log(self.level_mps2) + speed * x + force * y + self.bend * x**2)

    def filter_at(self, x: float, y: float) -> tuple[_Doubles, float]:
        """a_1 to a_20 of the filter at a condition, and the drive's RMS that gives a wave of RMS 1."""
        hertz = np.linspace(0.0, SAMPLE_RATE_HZ / 2.0, _BINS)
        warped = np.log1p(hertz / 120.0)
        turns = np.cos(np.pi * np.arange(_COSINES)[:, None] * warped / warped[-1])
        # A tool's vibrations are strongest near 140 Hz and fall off by some 20 dB to both ends of the band.
        tool = -0.5 * (np.log((hertz + 60.0) / 200.0) / 0.7) ** 2
        log_amplitude = tool + np.array([1.0, x, y, x * y]) @ self.cosines @ turns
        lags = np.fft.irfft(np.exp(2.0 * log_amplitude))[: ORDER + 1]
        lags /= lags[0]
        predictor = solve_toeplitz(lags[:-1], -lags[1:])
        return np.asarray(predictor), float(np.sqrt(1.0 + predictor @ lags[1:]))


def conditions(motion: NDArray[np.floating]) -> tuple[_Doubles, _Doubles]:
    """x = ln(speed / 80 mm/s) and y = ln(force / 0.9 N) of a motion [n, 3]."""
    speed = np.maximum(np.hypot(motion[:, 0], motion[:, 1]), 1e-3)
    return np.log(speed / _MIDDLE_SPEED_MPS), np.log(np.maximum(motion[:, 2], 0.02) / _MIDDLE_FORCE_NEWTONS)


def filtered_surfaces(count: int, seed: int) -> tuple[FilteredSurface, ...]:
    """`count` surfaces, named `filtered-01` on."""
    made = []
    for number in range(count):
        rng = np.random.default_rng([seed, 500 + number])
        spread = np.array([_MEAN, _SLOPE, _SLOPE, _PRODUCT])[:, None] / np.sqrt(1.0 + (np.arange(_COSINES) / 2.0) ** 2)
        weights = rng.standard_normal((4, _COSINES)) * spread
        made.append(
            FilteredSurface(
                f"filtered-{number + 1:02d}",
                weights,
                float(np.exp(rng.uniform(np.log(0.3), np.log(3.0)))),
                (float(rng.normal(0.9, 0.25)), float(rng.normal(0.3, 0.15))),
                float(rng.normal(0.0, 0.12)),
            )
        )
    return tuple(made)
