"""Surface features that are not random fields: ribs, threads, asperities that strike, friction that slips."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.recordings.synthetic.materials import Material, Ruling
from haptoflow_training.recordings.synthetic.surface import (
    RandomField, TipPath, field_key, octave_height, place_fractions, upper_weight
)

# Numbers of the features' random fields, beyond the octaves' 0 to 13.
_RULING_JITTER, _SLIP_WANDER, _ASPERITY_SIZE, _ASPERITY_PLACE = 100, 200, 300, 301
_RULING_HARMONICS = 14
_SLIP_HARMONICS = 6
# The jitter of ribs varies over this many of their wavelengths.
JITTER_WAVELENGTHS = 7.0
# The stretch before a slip varies by this (SD of its logarithm) over this distance, and grows as force^this.
SLIP_WANDER, SLIP_WANDER_MM = 0.25, 4.0
SLIP_FORCE_EXPONENT, LIGHTEST_SLIP_NEWTONS = 0.4, 0.05


def rib_wander_turns(
    material: Material, ruling: Ruling, number: int, path: TipPath, *, specimen: int
) -> NDArray[np.float64]:
    """By how many turns [n] the ribs under the tip lie ahead of evenly spaced ones."""
    if ruling.jitter <= 0.0:
        return np.zeros(len(path.position_mm))
    field = RandomField(
        material.surface_seed, specimen, _RULING_JITTER + number, JITTER_WAVELENGTHS * ruling.wavelength_mm
    )
    return ruling.jitter * field.at(path.position_mm)


def ruling_height(
    material: Material, ruling: Ruling, number: int, path: TipPath, wander_turns: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Heights [n] in micrometres of one family of ribs, displaced by its wander [n].

    Harmonics fall as n^(-a/2), as in the random field, and are faded out before their frequency n |v . direction| /
    wavelength reaches the simulation's limit. Phases are fixed and belong to the label, so all ribs look alike: apart
    from jitter, every specimen has its ribs in the same places.
    """
    angle = math.radians(ruling.direction_degrees)
    direction = np.array([math.cos(angle), math.sin(angle)])
    across = path.position_mm @ direction / ruling.wavelength_mm + wander_turns
    rate = np.abs(path.velocity_mmps @ direction) / ruling.wavelength_mm
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


def impact_acceleration(material: Material, path: TipPath, rate_hz: float, *, specimen: int) -> NDArray[np.float64]:
    """Impulses [n] in m/s^2, one where the tip meets the asperity of a cell of the surface that holds one.

    Their rate is proportional to speed; the velocity that each gives the tip grows so that the overall level follows
    the random field's law. Sizes are exponentially distributed: the tails are heavy. Most push the tip up; what they
    give it on average is taken away evenly, because a tip that is pressed on falls back between them. An asperity lies
    anywhere in its cell, so that impacts have no regular beat.
    """
    impulses = np.zeros(len(path.position_mm))
    if material.impact_strength <= 0.0 or material.impact_density <= 0.0:
        return impulses
    cells = np.floor(path.position_mm / material.impact_spacing_mm).astype(np.int64)
    entered = 1 + np.flatnonzero(np.any(np.diff(cells, axis=0) != 0, axis=1))
    i, j = cells[entered].T
    held, side, quantile, _ = place_fractions(field_key(material.surface_seed, specimen, _ASPERITY_SIZE), i, j)
    hits = held < material.impact_density
    size = np.where(side < material.impact_upward_share, 1.0, -1.0) * -np.log1p(-quantile)
    struck = _samples_of_closest_approach(material, path, entered, specimen)
    hits &= struck < len(impulses)
    struck = struck[hits]
    usual_jump_mps = _usual_jump_mps(material, path)
    np.add.at(impulses, struck, usual_jump_mps[struck] * size[hits] * rate_hz)
    cells_per_second = np.abs(path.velocity_mmps).sum(axis=1) / material.impact_spacing_mm
    mean_size = material.impact_density * (2.0 * material.impact_upward_share - 1.0)
    return impulses - mean_size * usual_jump_mps * cells_per_second


def _usual_jump_mps(material: Material, path: TipPath) -> NDArray[np.float64]:
    """The velocity [n] that an asperity of size 1 gives the tip; 0 at rest."""
    speed = np.hypot(*path.velocity_mmps.T) / 100.0
    exponent = 0.5 * (material.calibrated.height_exponent - 1.0) - 0.5
    growth = np.maximum(speed, 1e-9) ** exponent
    return np.where(speed > 0.0, 1e-3 * material.impact_strength * material.calibrated.height_micrometres * growth, 0.0)


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


@dataclass(frozen=True)
class Slips:
    """The cycles of stick and slip under a moving tip: rate_hz [n], and turns [n], the cycles since the path began."""

    rate_hz: NDArray[np.float64]
    turns: NDArray[np.float64]


def slips_of(
    material: Material, path: TipPath, force_newtons: NDArray[np.float64], rate_hz: float, *, specimen: int
) -> Slips | None:
    """The stretch before a slip grows with force and wanders with the place. None for a material that does not slip."""
    if material.stick_slip_strength <= 0.0:
        return None
    wander = RandomField(material.surface_seed, specimen, _SLIP_WANDER, SLIP_WANDER_MM).at(path.position_mm)
    pressed = np.maximum(force_newtons, LIGHTEST_SLIP_NEWTONS) ** SLIP_FORCE_EXPONENT
    length_mm = material.stick_slip_length_mm * np.exp(SLIP_WANDER * wander) * pressed
    rate = np.hypot(*path.velocity_mmps.T) / length_mm
    return Slips(rate, np.cumsum(rate) / rate_hz)


def slip_acceleration(material: Material, path: TipPath, slips: Slips) -> NDArray[np.float64]:
    """Relaxation oscillation [n] in m/s^2 along the movement: the tip sticks, is stretched, and slips.

    Above the critical speed the friction's fall with speed is spent and the oscillation dies.
    """
    speed = np.hypot(*path.velocity_mmps.T)
    turn = np.exp(2j * math.pi * slips.turns)
    harmonic = np.ones(len(speed), dtype=np.complex128)
    wave = np.zeros(len(speed))
    for order in range(1, _SLIP_HARMONICS + 1):
        harmonic *= turn
        wave += upper_weight(order * slips.rate_hz) * harmonic.imag / order
    alive = speed / (speed + 10.0) * np.exp(-((speed / material.stick_slip_critical_mmps) ** 2))
    strength = material.stick_slip_strength * material.calibrated.height_micrometres
    return strength * alive * wave
