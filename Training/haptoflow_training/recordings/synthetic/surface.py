"""The height profile h(x, y): a self-affine random field, the sum of one non-repeating field for each octave of
wavelength.

The same place on a specimen always has the same height. Each octave is band-limited and faded out before the frequency
v / wavelength at which the tip meets it reaches the simulation's limit, so that nothing aliases at any speed.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.recordings.synthetic.materials import Material
from haptoflow_training.recordings.synthetic.random_field import RandomField

# Centre wavelengths of the octaves in millimetres: 0.0075, 0.015 ... 61. At 10 mm/s the finest corresponds to 1.3 kHz.
OCTAVE_WAVELENGTHS_MM = tuple(0.0075 * 2.0**index for index in range(14))
# An octave is faded out beyond these rates; the sensors' band of interest is 20-1000 Hz.
_FADE_IN_HZ = (4.0, 8.0)
_FADE_OUT_HZ = (1250.0, 2000.0)


@dataclass(frozen=True)
class TipPath:
    """The tip's path on the surface: position_mm [n, 2], velocity_mmps [n, 2], on a uniform clock."""

    position_mm: NDArray[np.float64]
    velocity_mmps: NDArray[np.float64]


def band_weight(rate_hz: NDArray[np.float64]) -> NDArray[np.float64]:
    """Gain of a component met at `rate_hz`: 1 in the simulated band, smoothly falling to 0 outside it."""
    return _rise(rate_hz, *_FADE_IN_HZ) * (1.0 - _rise(rate_hz, *_FADE_OUT_HZ))


def upper_weight(rate_hz: NDArray[np.float64]) -> NDArray[np.float64]:
    """As `band_weight`, without the fade at low rates: for deterministic profiles."""
    return 1.0 - _rise(rate_hz, *_FADE_OUT_HZ)


def _rise(values: NDArray[np.float64], low: float, high: float) -> NDArray[np.float64]:
    share = np.clip((values - low) / (high - low), 0.0, 1.0)
    return share * share * (3.0 - 2.0 * share)


def random_height(
    material: Material, path: TipPath, *, specimen: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Heights [n] in micrometres under the tip, and the lateral tilt that neighbouring octaves give it.

    Along the grain the field is stretched by the material's anisotropy. The tip's finite contact patch attenuates
    wavelengths shorter than itself.
    """
    calibrated = material.calibrated
    position = _grain_frame(material, path.position_mm)
    speed = np.hypot(*_grain_frame(material, path.velocity_mmps).T)
    height = np.zeros(len(position))
    tilt = np.zeros(len(position))
    for octave, wavelength in enumerate(OCTAVE_WAVELENGTHS_MM):
        weight = band_weight(speed / wavelength)
        audible = np.flatnonzero(weight)
        if audible.size == 0:
            continue
        field = RandomField(material.surface_seed, specimen, octave, wavelength)
        part = octave_height(material, wavelength) * weight[audible] * field.at(position[audible])
        height[audible] += part
        tilt[audible] += part if octave % 2 else -part
    return calibrated.height_micrometres * height, calibrated.height_micrometres * tilt


def octave_height(material: Material, wavelength_mm: float) -> float:
    """RMS height of the octave around a wavelength, relative to that at 1 mm, as averaged by the tip's contact
    patch."""
    patch = 1.0 / (1.0 + (material.tip_patch_mm / wavelength_mm) ** 2)
    return patch * wavelength_mm ** (0.5 * (material.calibrated.height_exponent - 1.0))


def _grain_frame(material: Material, vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    if material.anisotropy == 1.0:
        return vectors
    angle = math.radians(material.grain_degrees)
    along = vectors[:, 0] * math.cos(angle) + vectors[:, 1] * math.sin(angle)
    across = -vectors[:, 0] * math.sin(angle) + vectors[:, 1] * math.cos(angle)
    root = math.sqrt(material.anisotropy)
    return np.stack([along / root, across * root], axis=1)
