"""What the engine needs to know about a label beyond its vibration: the defaults of its surface."""

from __future__ import annotations

from dataclasses import dataclass

from haptoflow_training.recordings.landing import Landing, RibWander, StickSlip


@dataclass(frozen=True)
class LabelInfo:
    """Defaults of a material: spring stiffness, kinetic friction, and the wavelength of a ruled or woven surface.

    wave_vectors_per_mm: (x, y) of each family of ribs in cycles per millimetre, perpendicular to the ribs. landing: the
    vibration at touch-down; if None, the model file has no such entry and the engine derives the impact from the
    stiffness. stick_slip: None for a label that is not known to slip. rib_wander: for each wave vector; empty if the
    ribs are not known to wander.
    """

    name: str
    category: str
    stiffness_newtons_per_metre: float
    friction_coefficient: float
    wavelength_metres: float | None = None
    wave_vectors_per_mm: tuple[tuple[float, float], ...] = ()
    landing: Landing | None = None
    stick_slip: StickSlip | None = None
    rib_wander: tuple[RibWander, ...] = ()

    @property
    def known_wave_vectors(self) -> tuple[tuple[float, float], ...]:
        """The wave vectors. If only a wavelength is known, the ribs are assumed to be perpendicular to the
        recordings' x axis."""
        if self.wave_vectors_per_mm or self.wavelength_metres is None:
            return self.wave_vectors_per_mm
        return ((1e-3 / self.wavelength_metres, 0.0),)

    @property
    def periodic(self) -> bool:
        return self.wavelength_metres is not None
