"""Finds the physical parameters with which a material meets its targets."""

from __future__ import annotations

from dataclasses import astuple, replace

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares
from scipy.signal import sosfreqz

from haptoflow_training.recordings.synthetic import filters
from haptoflow_training.recordings.synthetic.contact import SIMULATION_RATE_HZ
from haptoflow_training.recordings.synthetic.materials import Calibrated, Material
from haptoflow_training.recordings.synthetic.measurement import (
    TOLERANCE,
    Design,
    Deviation,
    Measurement,
    centroid_hz,
    measure,
    slope_db_per_octave,
)
from haptoflow_training.recordings.synthetic.specimens import TRAINING_SPECIMENS

_RESONANCE_HZ = (30.0, 700.0)
_ABSORPTION_DB_PER_OCTAVE = (-7.0, 7.0)
_HEIGHT_EXPONENT = (1.3, 4.5)


def calibrate(
    material: Material, *, seed: int, design: Design = Design(), rounds: int = 6
) -> tuple[Material, Measurement]:
    """Measure the training specimens, correct, and measure again; returns the round that came nearest to the targets,
    with its measurement.

    Level and force exponent respond one to one, the speed exponent by half of the height exponent; resonance and
    absorption are solved for together on the measured spectrum, reweighted by the new filters.
    """
    design = replace(design, fast_speeds_mmps=())
    best: tuple[float, Material, Measurement] | None = None
    for _ in range(rounds):
        measured = measure(material, seed=seed, design=design, specimens=TRAINING_SPECIMENS)
        distance = _distance(Deviation.of(measured.targets(), material.targets))
        if best is None or distance < best[0]:
            best = (distance, material, measured)
        if distance < 0.3:
            break
        material = _corrected(material, measured)
    assert best is not None
    return best[1], best[2]


def _distance(deviation: Deviation) -> float:
    """The worst deviation as a share of its tolerance."""
    return max(abs(value) / limit for value, limit in zip(astuple(deviation), astuple(TOLERANCE)))


def _corrected(material: Material, measured: Measurement) -> Material:
    now, targets = material.calibrated, material.targets
    resonance, absorption = _spectral_fit(material, measured)
    gain = _reweighting(material, measured.frequency_hz, resonance, absorption)
    inside = (measured.frequency_hz >= 20.0) & (measured.frequency_hz <= 500.0)
    refiltered = np.sqrt(np.sum((measured.spectrum * gain)[inside]) / np.sum(measured.spectrum[inside]))
    exponent = now.height_exponent + 1.5 * (targets.p - measured.p)
    return material.with_calibrated(
        height_micrometres=now.height_micrometres * targets.k / (measured.k * float(refiltered)),
        height_exponent=float(np.clip(exponent, *_HEIGHT_EXPONENT)),
        force_exponent=now.force_exponent + targets.q - measured.q,
        contact_resonance_hz=resonance,
        absorption_db_per_octave=absorption,
    )


def _spectral_fit(material: Material, measured: Measurement) -> tuple[float, float]:
    now, targets = material.calibrated, material.targets

    def errors(unknown: NDArray[np.float64]) -> list[float]:
        gain = _reweighting(material, measured.frequency_hz, float(np.exp(unknown[0])), float(unknown[1]))
        spectrum = measured.spectrum * gain
        return [
            (centroid_hz(measured.frequency_hz, spectrum) / targets.centroid_hz - 1.0) / TOLERANCE.centroid,
            (slope_db_per_octave(measured.frequency_hz, spectrum) - targets.slope_db_per_octave)
            / TOLERANCE.slope_db_per_octave,
            # Many pairs meet both targets; stay near the present one.
            0.02 * (unknown[0] - np.log(now.contact_resonance_hz)),
            0.005 * (unknown[1] - now.absorption_db_per_octave),
        ]

    low = [np.log(_RESONANCE_HZ[0]), _ABSORPTION_DB_PER_OCTAVE[0]]
    high = [np.log(_RESONANCE_HZ[1]), _ABSORPTION_DB_PER_OCTAVE[1]]
    start = np.clip([np.log(now.contact_resonance_hz), now.absorption_db_per_octave], low, high)
    found = least_squares(errors, start, bounds=(low, high), diff_step=1e-3).x
    return float(np.exp(found[0])), float(found[1])


def _reweighting(
    material: Material, frequency_hz: NDArray[np.float64], resonance_hz: float, absorption: float
) -> NDArray[np.float64]:
    """Power gain [n] of new filters over the present ones."""
    now: Calibrated = material.calibrated
    new = _response(material, frequency_hz, resonance_hz, absorption)
    return new / _response(material, frequency_hz, now.contact_resonance_hz, now.absorption_db_per_octave)


def _response(
    material: Material, frequency_hz: NDArray[np.float64], resonance_hz: float, absorption: float
) -> NDArray[np.float64]:
    rate = SIMULATION_RATE_HZ
    contact = filters.contact_from_acceleration(resonance_hz, material.contact_damping, rate)
    sections = np.concatenate([contact, filters.absorption(absorption, rate)])
    return np.abs(sosfreqz(sections, frequency_hz, fs=rate)[1]) ** 2
