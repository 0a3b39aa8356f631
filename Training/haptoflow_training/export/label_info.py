"""What the engine wants to know of a label beyond its sound: the defaults of its surface."""

from __future__ import annotations

from dataclasses import dataclass

from haptoflow_training.recordings.landing import Landing


@dataclass(frozen=True)
class LabelInfo:
    """Defaults of a material: spring stiffness, kinetic friction, and the wavelength of a ruled or woven surface.

    wave_vectors_per_mm: (x, y) of each family of ribs in cycles per millimetre, across the ribs. landing: the
    vibration of a tip that lands; None leaves it out of the model file, and the engine answers by the stiffness.
    """

    name: str
    category: str
    stiffness_newtons_per_metre: float
    friction_coefficient: float
    wavelength_metres: float | None = None
    wave_vectors_per_mm: tuple[tuple[float, float], ...] = ()
    landing: Landing | None = None

    @property
    def known_wave_vectors(self) -> tuple[tuple[float, float], ...]:
        """Where only a wavelength is known, its ribs are taken to lie across the x axis of the recordings."""
        if self.wave_vectors_per_mm or self.wavelength_metres is None:
            return self.wave_vectors_per_mm
        return ((1e-3 / self.wavelength_metres, 0.0),)

    @property
    def periodic(self) -> bool:
        return self.wavelength_metres is not None
