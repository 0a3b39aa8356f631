"""Features of a surface that are no random field: ribs, threads, striking asperities, slipping friction."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.recordings.synthetic.materials import Material, Ruling
from haptoflow_training.recordings.synthetic.surface import (
    TipPath,
    octave_height,
    octave_tile,
    read_tile,
    upper_weight,
)

_ASPERITY_CELLS = 512
_RULING_HARMONICS = 14
_SLIP_HARMONICS = 6


def ruling_height(material: Material, ruling: Ruling, number: int, path: TipPath) -> NDArray[np.float64]:
    """Heights [n] in micrometres of one family of ribs.

    Harmonics fall as n^(-a/2), the random field's own law, and leave before their frequency
    n |v . direction| / wavelength nears the simulation's limit. Phases are fixed, so every rib looks alike.
    """
    angle = math.radians(ruling.direction_degrees)
    direction = np.array([math.cos(angle), math.sin(angle)])
    across = path.position_mm @ direction / ruling.wavelength_mm
    rate = np.abs(path.velocity_mmps @ direction) / ruling.wavelength_mm
    if ruling.jitter > 0.0:
        tile = octave_tile(material.surface_seed, 20 + number)
        across = across + ruling.jitter * read_tile(tile, path.position_mm, 7.0 * ruling.wavelength_mm, 0.4)
    turn = np.exp(2j * math.pi * across)
    rng = np.random.default_rng([material.surface_seed, 20, number])
    phases = rng.uniform(0.0, 2.0 * math.pi, _RULING_HARMONICS)
    phases *= np.linspace(0.0, 1.0, _RULING_HARMONICS)
    profile = np.zeros(len(across))
    harmonic = np.ones(len(across), dtype=np.complex128)
    for order in range(1, _RULING_HARMONICS + 1):
        harmonic *= turn
        size = math.sqrt(2.0) * order ** (-0.5 * material.calibrated.height_exponent)
        profile += size * upper_weight(order * rate) * (harmonic * np.exp(1j * phases[order - 1])).real
    unit = material.calibrated.height_micrometres * octave_height(material, ruling.wavelength_mm)
    return unit * ruling.relative_height * profile


@lru_cache(maxsize=24)
def _asperities(surface_seed: int, density: float) -> NDArray[np.float32]:
    rng = np.random.default_rng([surface_seed, 88])
    shape = (_ASPERITY_CELLS, _ASPERITY_CELLS)
    size = rng.exponential(1.0, shape) * np.where(rng.random(shape) < 0.5, -1.0, 1.0)
    return np.where(rng.random(shape) < density, size, 0.0).astype(np.float32)


def impact_acceleration(material: Material, path: TipPath, rate_hz: float) -> NDArray[np.float64]:
    """Impulses [n] in m/s^2: one wherever the tip enters a cell of the surface that holds an asperity.

    Their rate is proportional to speed; the velocity each one lends the tip grows so that, together, the
    level follows the random field's law. Sizes are exponential: the tails are heavy.
    """
    impulses = np.zeros(len(path.position_mm))
    if material.impact_strength <= 0.0 or material.impact_density <= 0.0:
        return impulses
    cells = np.floor(path.position_mm / material.impact_spacing_mm).astype(np.int64)
    entered = 1 + np.flatnonzero(np.any(np.diff(cells, axis=0) != 0, axis=1))
    table = _asperities(material.surface_seed, material.impact_density)
    size = table[cells[entered, 0] % _ASPERITY_CELLS, cells[entered, 1] % _ASPERITY_CELLS]
    speed = np.hypot(*path.velocity_mmps[entered].T) / 100.0
    exponent = 0.5 * (material.calibrated.height_exponent - 1.0) - 0.5
    jump_mmps = material.impact_strength * material.calibrated.height_micrometres * size * speed**exponent
    impulses[entered] = 1e-3 * jump_mmps * rate_hz
    return impulses


def slip_acceleration(
    material: Material, path: TipPath, force_newtons: NDArray[np.float64], rate_hz: float
) -> NDArray[np.float64]:
    """Relaxation oscillation [n] in m/s^2 along the movement: the tip sticks, is stretched, and slips.

    The stretch before a slip grows with force and wanders with the place; above the critical speed the
    friction's fall with speed is spent and the oscillation dies.
    """
    if material.stick_slip_strength <= 0.0:
        return np.zeros(len(force_newtons))
    speed = np.hypot(*path.velocity_mmps.T)
    wander = read_tile(octave_tile(material.surface_seed, 30), path.position_mm, 4.0, 0.9)
    length = material.stick_slip_length_mm * np.exp(0.25 * wander) * np.maximum(force_newtons, 0.05) ** 0.4
    rate = speed / length
    turn = np.exp(2j * math.pi * np.cumsum(rate) / rate_hz)
    harmonic = np.ones(len(rate), dtype=np.complex128)
    wave = np.zeros(len(rate))
    for order in range(1, _SLIP_HARMONICS + 1):
        harmonic *= turn
        wave += upper_weight(order * rate) * harmonic.imag / order
    alive = speed / (speed + 10.0) * np.exp(-((speed / material.stick_slip_critical_mmps) ** 2))
    strength = material.stick_slip_strength * material.calibrated.height_micrometres
    return strength * alive * wave
