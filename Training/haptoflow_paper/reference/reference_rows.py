"""Reference rows without a network: an independent recording, a codec alone, noise, and silence."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from haptoflow_benchmark.waveform_metrics import power_spectrum
from haptoflow_paper.reference.reference_set import ReferencePair

REFERENCE_ROWS = ("independent-draw", "another-specimen", "mean-spectrum", "white-noise", "silence")
# The recordings encoded and decoded by the small codec: the best that a row in its latents can score.
CODEC_ROW = "small-codec-reconstruction"
_ENVELOPE_SAMPLES = 200
_SPECTRUM_WINDOW = 400

_Floats = NDArray[np.float32]


def _true_level(wave: NDArray[np.floating]) -> NDArray[np.float64]:
    """Moving RMS over 100 ms, [n]."""
    kernel = np.ones(_ENVELOPE_SAMPLES) / _ENVELOPE_SAMPLES
    power = np.convolve(np.square(np.asarray(wave, dtype=np.float64)), kernel, mode="same")
    return np.sqrt(power + 1e-12)


def _shaped_noise(spectrum: NDArray[np.float64], samples: int, generator: np.random.Generator) -> NDArray[np.float64]:
    """Gaussian noise of RMS 1 whose power spectrum is proportional to `spectrum` (any number of bins, 0 to 1 kHz)."""
    white = np.fft.rfft(generator.standard_normal(samples))
    places = np.linspace(0.0, 1.0, len(white))
    gain = np.sqrt(np.interp(places, np.linspace(0.0, 1.0, len(spectrum)), spectrum))
    shaped = np.fft.irfft(white * gain, samples)
    return np.asarray(shaped / np.sqrt(np.square(shaped).mean() + 1e-30))


def _of_another_specimen(pair: ReferencePair) -> _Floats:
    if pair.other_specimen is None:
        raise ValueError(f"{pair.condition}: nothing was recorded of another specimen")
    return pair.other_specimen


def reference_waves(name: str, pairs: list[ReferencePair], seed: int) -> list[_Floats]:
    """One waveform for each pair, as long as its recording, m/s^2.

    independent-draw: another recording of the same condition, on the same specimen. another-specimen: on another piece
    of the material. mean-spectrum: noise with the label's mean spectrum over all its conditions, at the recording's own
    level. white-noise: at that level too.
    """
    generator = np.random.default_rng(seed)
    if name == "independent-draw":
        return [pair.independent for pair in pairs]
    if name == "another-specimen":
        return [_of_another_specimen(pair) for pair in pairs]
    if name == "silence":
        return [np.zeros_like(pair.recorded) for pair in pairs]
    if name == "white-noise":
        return [
            (_true_level(pair.recorded) * generator.standard_normal(len(pair.recorded))).astype(np.float32)
            for pair in pairs
        ]
    if name == "mean-spectrum":
        shapes: dict[str, list[NDArray[np.float64]]] = {}
        for pair in pairs:
            spectrum = power_spectrum(pair.independent, _SPECTRUM_WINDOW)
            shapes.setdefault(pair.condition.label, []).append(spectrum / spectrum.sum())
        means = {label: np.mean(spectra, axis=0) for label, spectra in shapes.items()}
        return [
            (
                _true_level(pair.recorded)
                * _shaped_noise(means[pair.condition.label], len(pair.recorded), generator)
            ).astype(np.float32)
            for pair in pairs
        ]
    raise ValueError(f"unknown reference row '{name}', expected one of {', '.join(REFERENCE_ROWS)}")
