"""What a label's ribs and slips do beyond its wave vectors, from the synthetic recorder's materials."""

from __future__ import annotations

from dataclasses import dataclass

from haptoflow_training.recordings.synthetic.features import JITTER_WAVELENGTHS, SLIP_WANDER, SLIP_WANDER_MM
from haptoflow_training.recordings.synthetic.materials import Material


@dataclass(frozen=True)
class StickSlip:
    """length_metres: the stretch before a slip at 1 N. wander: the SD of its logarithm from place to place.
    wander_metres: the wavelength over which it varies."""

    length_metres: float
    wander: float
    wander_metres: float


@dataclass(frozen=True)
class RibWander:
    """turns: the SD of the displacement of one family of ribs, in its wavelengths. wavelength_metres: over which it
    varies."""

    turns: float
    wavelength_metres: float


def stick_slip_of(material: Material) -> StickSlip | None:
    """None for a material that does not slip."""
    if material.stick_slip_strength <= 0.0:
        return None
    return StickSlip(1e-3 * material.stick_slip_length_mm, SLIP_WANDER, 1e-3 * SLIP_WANDER_MM)


def rib_wander_of(material: Material) -> tuple[RibWander, ...]:
    """One for each family of ribs, in the order of the wave vectors; empty if all of them are evenly spaced."""
    if not any(ruling.jitter > 0.0 for ruling in material.rulings):
        return ()
    return tuple(
        RibWander(ruling.jitter, 1e-3 * JITTER_WAVELENGTHS * ruling.wavelength_mm) for ruling in material.rulings
    )
