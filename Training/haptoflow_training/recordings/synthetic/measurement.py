"""Measures a material as the published field statistics were measured: laws fitted to a sweep of speed and force."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray
from scipy.signal import welch
from scipy.stats import skew

from haptoflow_training.preprocessing.pipeline import preprocess_recording
from haptoflow_training.preprocessing.settings import PreprocessingSettings
from haptoflow_training.recordings.synthetic.materials import Material, Targets
from haptoflow_training.recordings.synthetic.recorder import record_condition
from haptoflow_training.recordings.synthetic.specimens import HELD_OUT_SPECIMEN

REFERENCE_SPEED_MMPS, REFERENCE_FORCE_NEWTONS = 100.0, 1.0
_LEVEL_BAND_HZ = (20.0, 500.0)
_SLOPE_BAND_HZ = (60.0, 450.0)
_RESOLUTION_HZ = 5.0
_SPECTRUM_FLOOR = 1e-12


@dataclass(frozen=True)
class Design:
    """The conditions that are measured; powers are averaged over the directions. fast_speeds_mmps: at 1 N only, for
    the centroid's exponent up to there; empty for none."""

    speeds_mmps: tuple[float, ...] = (20.0, 50.0, 100.0, 150.0, 200.0)
    forces_newtons: tuple[float, ...] = (0.3, 1.0, 2.0)
    directions_degrees: tuple[float, ...] = (0.0, 45.0, 90.0, 135.0)
    duration_seconds: float = 1.8
    reference_repeats: int = 3
    fast_speeds_mmps: tuple[float, ...] = (400.0, 800.0, 1500.0)


@dataclass(frozen=True)
class Measurement(Targets):
    """The result in the terms of `Targets`, with the spectrum at the reference condition.

    frequency_hz [n]; spectrum [n] in (m/s^2)^2/Hz; crest: the 99.9th percentile of |a| over its RMS; skewness: 0 if the
    vibration goes up as strongly as down. centroid_exponent: the centroid grows as speed^this over the design's speeds;
    fast_centroid_exponent: from the fastest of these to the fastest of all, None without fast speeds.
    """

    crest: float
    skewness: float
    centroid_exponent: float
    fast_centroid_exponent: float | None
    frequency_hz: NDArray[np.float64]
    spectrum: NDArray[np.float64]

    def targets(self) -> Targets:
        return Targets(self.k, self.p, self.q, self.centroid_hz, self.slope_db_per_octave)


@dataclass(frozen=True)
class Deviation:
    """Measured minus target: level in dB, exponents, centroid as a share, slope in dB per octave."""

    level_db: float
    p: float
    q: float
    centroid: float
    slope_db_per_octave: float

    @classmethod
    def of(cls, measured: Targets, targets: Targets) -> Deviation:
        return cls(
            20.0 * float(np.log10(measured.k / targets.k)),
            measured.p - targets.p,
            measured.q - targets.q,
            measured.centroid_hz / targets.centroid_hz - 1.0,
            measured.slope_db_per_octave - targets.slope_db_per_octave,
        )

    def passes(self) -> bool:
        return all(abs(getattr(self, name)) <= limit for name, limit in asdict(TOLERANCE).items())


# The largest accepted deviation of a calibrated material from its published targets.
TOLERANCE = Deviation(1.5, 0.15, 0.15, 0.15, 2.0)


def measure(
    material: Material, *, seed: int, design: Design = Design(), specimens: Sequence[int] = (HELD_OUT_SPECIMEN,)
) -> Measurement:
    """Record the design's conditions, prepare the recordings as training does, and fit RMS = k (v/100)^p F^q.

    Directions alternate between `specimens`, all with the label's typical statistics: targets are of a label, not of a
    piece. The sensor's own noise, measured at rest, is subtracted as power. p and q are a least-squares fit of log RMS over
    all conditions; k, centroid, slope are those of the reference condition, 100 mm/s and 1 N.
    """
    record = partial(recorded_waveforms, material.without_spread, design, specimens)
    resting = mean_spectrum(record(0.0, 1.0, seed, 1))
    rows, levels, centroids = [], [], []
    for speed in design.speeds_mmps:
        for force in design.forces_newtons:
            frequency, power = mean_spectrum(record(speed, force, seed, 1))
            rows.append([1.0, np.log(speed / REFERENCE_SPEED_MMPS), np.log(force / REFERENCE_FORCE_NEWTONS)])
            texture = np.maximum(power - resting[1], _SPECTRUM_FLOOR)
            levels.append(np.log(band_level(frequency, texture)))
            centroids.append(np.log(centroid_hz(frequency, texture)))
    _, p, q = np.linalg.lstsq(np.array(rows), np.array(levels), rcond=None)[0]
    _, centroid_exponent, _ = np.linalg.lstsq(np.array(rows), np.array(centroids), rcond=None)[0]

    waveforms = record(REFERENCE_SPEED_MMPS, REFERENCE_FORCE_NEWTONS, seed + 1000, design.reference_repeats)
    frequency, power = mean_spectrum(waveforms)
    power = np.maximum(power - resting[1], _SPECTRUM_FLOOR)
    crest = float(np.mean([np.percentile(np.abs(each), 99.9) / np.std(each) for each in waveforms]))
    skewness = float(np.mean([skew(each) for each in waveforms]))
    return Measurement(
        band_level(frequency, power), float(p), float(q), centroid_hz(frequency, power),
        slope_db_per_octave(frequency, power), crest, skewness, float(centroid_exponent),
        _fast_centroid_exponent(record, design, resting[1], seed), frequency, power,
    )


def _fast_centroid_exponent(
    record: Callable[[float, float, int, int], list[NDArray[np.float64]]],
    design: Design,
    resting: NDArray[np.float64],
    seed: int,
) -> float | None:
    if not design.fast_speeds_mmps:
        return None
    speeds = (max(design.speeds_mmps), *design.fast_speeds_mmps)
    centroids = []
    for speed in speeds:
        frequency, power = mean_spectrum(record(speed, REFERENCE_FORCE_NEWTONS, seed, 1))
        centroids.append(centroid_hz(frequency, np.maximum(power - resting, _SPECTRUM_FLOOR)))
    return float(np.polyfit(np.log(speeds), np.log(centroids), 1)[0])


def band_level(frequency_hz: NDArray[np.float64], spectrum: NDArray[np.float64]) -> float:
    """RMS in m/s^2 between 20 and 500 Hz of a power spectral density."""
    inside = (frequency_hz >= _LEVEL_BAND_HZ[0]) & (frequency_hz <= _LEVEL_BAND_HZ[1])
    return float(np.sqrt(np.sum(spectrum[inside]) * (frequency_hz[1] - frequency_hz[0])))


def centroid_hz(frequency_hz: NDArray[np.float64], spectrum: NDArray[np.float64]) -> float:
    """Power-weighted mean frequency between 20 and 500 Hz."""
    inside = (frequency_hz >= _LEVEL_BAND_HZ[0]) & (frequency_hz <= _LEVEL_BAND_HZ[1])
    return float(np.sum(frequency_hz[inside] * spectrum[inside]) / np.sum(spectrum[inside]))


def slope_db_per_octave(frequency_hz: NDArray[np.float64], spectrum: NDArray[np.float64]) -> float:
    """Slope of a straight line through third-octave means of the density in dB, 60-450 Hz.

    Third octaves weigh all octaves alike, and give the comb of a ruled surface the slope of its envelope.
    """
    edges = _SLOPE_BAND_HZ[0] * (_SLOPE_BAND_HZ[1] / _SLOPE_BAND_HZ[0]) ** np.linspace(0.0, 1.0, 10)
    means = [
        np.mean(spectrum[(frequency_hz >= low) & (frequency_hz < high)])
        for low, high in zip(edges[:-1], edges[1:])
    ]
    octaves = 0.5 * (np.log2(edges[:-1]) + np.log2(edges[1:]))
    return float(np.polyfit(octaves, 10.0 * np.log10(means), 1)[0])


def recorded_waveforms(
    material: Material,
    design: Design,
    specimens: Sequence[int],
    speed_mmps: float,
    force_newtons: float,
    seed: int,
    repeats: int,
) -> list[NDArray[np.float64]]:
    """The prepared waveforms of one condition: in each repeat, one for each direction."""
    waveforms = []
    for repeat in range(repeats):
        for number, degrees in enumerate(design.directions_degrees):
            angle = np.radians(degrees)
            recording = record_condition(
                material,
                velocity_mps=(1e-3 * speed_mmps * np.cos(angle), 1e-3 * speed_mmps * np.sin(angle)),
                force_newtons=force_newtons,
                duration_seconds=design.duration_seconds,
                seed=seed + 10 * number + 100 * repeat,
                specimen=specimens[number % len(specimens)],
            )
            prepared = preprocess_recording(recording, PreprocessingSettings())
            waveforms.append(prepared.waveform_mps2.astype(np.float64))
    return waveforms


def mean_spectrum(waveforms: Sequence[NDArray[np.float64]]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Frequencies [n] in Hz and the mean density [n] in (m/s^2)^2/Hz."""
    rate = PreprocessingSettings().sample_rate_hz
    size = int(rate / _RESOLUTION_HZ)
    spectra = [welch(waveform, rate, nperseg=size)[1] for waveform in waveforms]
    return np.fft.rfftfreq(size, 1.0 / rate), np.mean(spectra, axis=0)
