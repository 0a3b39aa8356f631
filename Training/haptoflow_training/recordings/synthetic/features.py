"""Surface features that are not random fields: ribs, threads, asperities that strike, friction that slips."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.recordings.synthetic.materials import Material, Ruling
from haptoflow_training.recordings.synthetic.random_field import RandomField, field_key, place_fractions
from haptoflow_training.recordings.synthetic.surface import TipPath, octave_height, upper_weight

# Numbers of the features' random fields, beyond the octaves' 0 to 13.
_RULING_JITTER, _SLIP_WANDER, _ASPERITY_SIZE, _ASPERITY_PLACE = 100, 200, 300, 301
_RULING_HARMONICS = 14
_SLIP_HARMONICS = 6


def ruling_height(
    material: Material, ruling: Ruling, number: int, path: TipPath, *, specimen: int
) -> NDArray[np.float64]:
    """Heights [n] in micrometres of one family of ribs.

    Harmonics fall as n^(-a/2), as in the random field, and are faded out before their frequency n |v . direction| /
    wavelength reaches the simulation's limit. Phases are fixed and belong to the label, so all ribs look alike: apart
    from jitter, every specimen has its ribs in the same places.
    """
    angle = math.radians(ruling.direction_degrees)
    direction = np.array([math.cos(angle), math.sin(angle)])
    across = path.position_mm @ direction / ruling.wavelength_mm
    rate = np.abs(path.velocity_mmps @ direction) / ruling.wavelength_mm
    if ruling.jitter > 0.0:
        field = RandomField(
            material.surface_seed, specimen, _RULING_JITTER + number, 7.0 * ruling.wavelength_mm
        )
        across = across + ruling.jitter * field.at(path.position_mm)
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


def impact_acceleration(
    material: Material, path: TipPath, rate_hz: float, *, specimen: int
) -> NDArray[np.float64]:
    """Impulses [n] in m/s^2, one where the tip meets the asperity of a cell of the surface that holds one.

    Their rate is proportional to speed; the velocity that each gives the tip grows so that the overall level follows
    the random field's law. Sizes are exponentially distributed: the tails are heavy. An asperity lies anywhere in its
    cell, so that impacts have no regular beat.
    """
    impulses = np.zeros(len(path.position_mm))
    if material.impact_strength <= 0.0 or material.impact_density <= 0.0:
        return impulses
    cells = np.floor(path.position_mm / material.impact_spacing_mm).astype(np.int64)
    entered = 1 + np.flatnonzero(np.any(np.diff(cells, axis=0) != 0, axis=1))
    i, j = cells[entered].T
    held, side, quantile, _ = place_fractions(field_key(material.surface_seed, specimen, _ASPERITY_SIZE), i, j)
    hits = held < material.impact_density
    size = np.where(side < 0.5, -1.0, 1.0) * -np.log1p(-quantile)
    struck = _samples_of_closest_approach(material, path, entered, specimen)
    hits &= struck < len(impulses)
    struck = struck[hits]
    speed = np.hypot(*path.velocity_mmps[struck].T) / 100.0
    exponent = 0.5 * (material.calibrated.height_exponent - 1.0) - 0.5
    jump_mmps = material.impact_strength * material.calibrated.height_micrometres * size[hits] * speed**exponent
    np.add.at(impulses, struck, 1e-3 * jump_mmps * rate_hz)
    return impulses


def _samples_of_closest_approach(
    material: Material, path: TipPath, entered: NDArray[np.int64], specimen: int
) -> NDArray[np.int64]:
    """For each sample at which a cell is entered, that at which the tip has come nearest to the cell's asperity; the
    path's length where it ends before.
    """
    cells = np.floor(path.position_mm[entered] / material.impact_spacing_mm)
    key = field_key(material.surface_seed, specimen, _ASPERITY_PLACE)
    x, y, _, _ = place_fractions(key, *cells.astype(np.int64).T)
    asperity_mm = material.impact_spacing_mm * (cells + np.stack([x, y], axis=1))
    velocity = path.velocity_mmps[entered]
    heading = velocity / np.maximum(np.hypot(*velocity.T), 1e-9)[:, None]
    ahead_mm = np.maximum(np.sum((asperity_mm - path.position_mm[entered]) * heading, axis=1), 0.0)
    steps = np.hypot(*np.diff(path.position_mm, axis=0).T)
    travelled = np.concatenate([[0.0], np.cumsum(steps)])
    return np.searchsorted(travelled, travelled[entered] + ahead_mm)


def slip_acceleration(
    material: Material, path: TipPath, force_newtons: NDArray[np.float64], rate_hz: float, *, specimen: int
) -> NDArray[np.float64]:
    """Relaxation oscillation [n] in m/s^2 along the movement: the tip sticks, is stretched, and slips.

    The stretch before a slip grows with force and wanders with the place; above the critical speed the
    friction's fall with speed is spent and the oscillation dies.
    """
    if material.stick_slip_strength <= 0.0:
        return np.zeros(len(force_newtons))
    speed = np.hypot(*path.velocity_mmps.T)
    wander = RandomField(material.surface_seed, specimen, _SLIP_WANDER, 4.0).at(path.position_mm)
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
