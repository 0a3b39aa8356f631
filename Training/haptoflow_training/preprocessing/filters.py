"""Zero-phase filters of the preprocessing, and the decimation to the training rate."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy import signal


def zero_phase_high_pass(
    values: NDArray[np.floating], cutoff_hz: float, rate_hz: float
) -> NDArray[np.float64]:
    """4th-order Butterworth, forward and backward (-6 dB at the cutoff), along the first axis."""
    # Even reflection: an odd reflection of an oscillation makes a step, and a step rings through a high-pass filter.
    return _both_ways(values, 4, cutoff_hz, "highpass", rate_hz, "even")


def zero_phase_low_pass(
    values: NDArray[np.floating], cutoff_hz: float, rate_hz: float, order: int = 4
) -> NDArray[np.float64]:
    """Butterworth, forward and backward (-6 dB at the cutoff), along the first axis."""
    return _both_ways(values, order, cutoff_hz, "lowpass", rate_hz, "odd")


def decimate(values: NDArray[np.floating], rate_hz: int, target_rate_hz: int) -> NDArray[np.float64]:
    """Keep every (rate / target)th sample after a linear-phase filter; sample 0 stays sample 0.

    Flat to 95 % of the target's Nyquist frequency, -6 dB at Nyquist, -60 dB 5 % above it: at 2 kHz, aliases fall above
    950 Hz, where they cannot be distinguished by touch. A skirt that ends below Nyquist would have to be steeper than
    hops of 14 ms can reproduce. `rate_hz` is a whole multiple of `target_rate_hz`.
    """
    factor = rate_hz // target_rate_hz
    padded = np.pad(values, (0, factor), mode="edge")
    return signal.resample_poly(padded, 1, factor, window=_decimation_filter(factor), padtype="line")[
        : -(-len(values) // factor)
    ]


@lru_cache(maxsize=8)
def _decimation_filter(factor: int) -> NDArray[np.float64]:
    width = 0.1 / factor
    taps, beta = signal.kaiserord(66.0, width)
    return signal.firwin(taps | 1, 1.0 / factor, window=("kaiser", beta))


def _both_ways(
    values: NDArray[np.floating], order: int, cutoff_hz: float, kind: str, rate_hz: float, reflection: str
) -> NDArray[np.float64]:
    sections = _butterworth(order, cutoff_hz, kind, rate_hz)
    settle = round(1.5 * rate_hz / cutoff_hz)
    reach = min(len(values) - 1, max(settle, 30))
    return signal.sosfiltfilt(sections, values, axis=0, padtype=reflection, padlen=reach)


@lru_cache(maxsize=32)
def _butterworth(order: int, cutoff_hz: float, kind: str, rate_hz: float) -> NDArray[np.float64]:
    return signal.butter(order, cutoff_hz, kind, fs=rate_hz, output="sos")
