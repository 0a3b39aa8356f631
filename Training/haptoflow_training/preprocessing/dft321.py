"""Combines three axes of vibration into one (DFT321, Landin et al. 2010), because skin hardly perceives its direction.

Every frame keeps the energy of all axes, |Y|^2 = |X1|^2 + |X2|^2 + |X3|^2, and takes the phase of their sum. Frames
overlap by half and are weighted by a root-Hann window before and after the transform, so that the weights add up to one
and a single moving axis comes back unchanged. Where axes cancel, the phases of neighbouring frames disagree and
overlap-add loses up to 1 dB; `restore_band_energies` restores it for each third octave, over the whole recording.

The library's own (recordings/dft321.cpp) combines axes that are at 2 kHz already; training has irregular times, and
combines at the rate of its spline before it decimates. test_dft321.py holds the two together.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy import fft

_MAXIMUM_CORRECTION = 10.0 ** (6.0 / 20.0)
_CORRECTION_ROUNDS = 3
_MINIMUM_BAND = -19  # third octaves from 1 kHz: 12.4 Hz


def dft321(axes: NDArray[np.floating], rate_hz: float, frame_seconds: float = 0.035) -> NDArray[np.float64]:
    """[n, 3] of any unit to [n] of the same unit; does not high-pass. n may be smaller than a frame."""
    axes = np.asarray(axes, dtype=np.float64)
    hop = max(1, round(frame_seconds * rate_hz / 2))
    combined = _overlap_add(_combine(_spectra(axes, hop)), hop, len(axes))
    return restore_band_energies(combined, axes, rate_hz)


def restore_band_energies(
    combined: NDArray[np.float64], axes: NDArray[np.float64], rate_hz: float
) -> NDArray[np.float64]:
    """Filter `combined` [n] without phase shift to the third-octave energies of all three `axes` [n, 3].

    The gain is smooth in log frequency, constant over the recording and within +-6 dB. Energies agree within 0.5 dB on
    broadband input; a few narrow lines below 50 Hz, closer than a frame resolves, may be off by 1 dB.
    """
    count = len(combined)
    size = fft.next_fast_len(count + round(0.2 * rate_hz), real=True)
    spectrum = fft.rfft(combined, size)
    wanted_power = np.sum(np.abs(fft.rfft(axes, size, axis=0)) ** 2, axis=1)
    frequencies = fft.rfftfreq(size, 1.0 / rate_hz)
    centres = 1000.0 * 2.0 ** (np.arange(_MINIMUM_BAND, 40) / 3.0)
    centres = centres[centres * 2.0 ** (1.0 / 6.0) < rate_hz / 2]
    edges = np.searchsorted(
        frequencies, np.append(centres / 2.0 ** (1.0 / 6.0), centres[-1] * 2.0 ** (1.0 / 6.0))
    )
    full = np.diff(edges) > 0
    if not np.any(full):
        return combined
    starts, stop, centres = edges[:-1][full], int(edges[-1]), centres[full]
    wanted = np.add.reduceat(wanted_power[:stop], starts)
    position = np.log(np.maximum(frequencies, centres[0]))
    power = np.abs(spectrum) ** 2
    band_gain = np.ones(len(centres))
    gain = np.ones(len(spectrum))
    for _ in range(_CORRECTION_ROUNDS):
        found = np.add.reduceat((power * gain**2)[:stop], starts)
        ratio = np.divide(
            wanted, found, out=np.ones_like(wanted), where=found > 1e-20 * max(wanted.max(), 1e-300)
        )
        band_gain = np.clip(band_gain * np.sqrt(ratio), 1.0 / _MAXIMUM_CORRECTION, _MAXIMUM_CORRECTION)
        gain = np.exp(np.interp(position, np.log(centres), np.log(band_gain)))
    return fft.irfft(spectrum * gain, size)[:count]


def _spectra(axes: NDArray[np.float64], hop: int) -> NDArray[np.complex128]:
    """[n, 3] to [3, frames, bins]; half a frame of silence is added before, and enough after to cover every sample."""
    frame_count = -(-len(axes) // hop) + 1
    padded = np.zeros((3, (frame_count + 1) * hop))
    padded[:, hop : hop + len(axes)] = axes.T
    frames = np.lib.stride_tricks.sliding_window_view(padded, 2 * hop, axis=1)[:, ::hop]
    return fft.rfft(frames * _window(hop), axis=-1)


def _combine(spectra: NDArray[np.complex128]) -> NDArray[np.complex128]:
    magnitude = np.sqrt(np.sum(spectra.real**2 + spectra.imag**2, axis=0))
    direction = spectra.sum(axis=0)
    cancelled = np.abs(direction) <= 1e-9 * magnitude
    if np.any(cancelled):
        # Axes that cancel exactly leave no phase; that of the strongest axis is used.
        strongest = np.argmax(np.abs(spectra), axis=0)
        lent = np.take_along_axis(spectra, strongest[None], axis=0)[0]
        direction = np.where(cancelled, lent, direction)
    length = np.abs(direction)
    return direction * np.divide(magnitude, length, out=np.zeros_like(magnitude), where=length > 0)


def _overlap_add(spectra: NDArray[np.complex128], hop: int, count: int) -> NDArray[np.float64]:
    frames = fft.irfft(spectra, 2 * hop, axis=-1) * _window(hop)
    total = np.zeros((len(frames) + 1) * hop)
    total[:-hop] += frames[:, :hop].ravel()
    total[hop:] += frames[:, hop:].ravel()
    return total[hop : hop + count]


def _window(hop: int) -> NDArray[np.float64]:
    return np.sin(np.pi * np.arange(2 * hop) / (2 * hop))
