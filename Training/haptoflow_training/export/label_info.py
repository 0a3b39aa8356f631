"""What the engine wants to know of a label beyond its sound: the defaults of its surface."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class LabelInfo:
    """Defaults of a material: spring stiffness, kinetic friction, and the wavelength of a ruled or woven surface."""

    name: str
    category: str
    stiffness_newtons_per_metre: float
    friction_coefficient: float
    wavelength_metres: float | None = None

    @property
    def periodic(self) -> bool:
        return self.wavelength_metres is not None
