"""The height profile h(x, y): a self-affine random field as periodic tiles, one an octave of wavelength.

The same spot of a surface always gives the same height. Each octave is band-limited and faded out before the
frequency v / wavelength at which the tip meets it nears the simulation's limit: nothing aliases at any speed.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import map_coordinates

from haptoflow_training.recordings.synthetic.materials import Material

TILE_CELLS = 256
CELLS_PER_WAVELENGTH = 6.0
# Centre wavelengths of the octaves in millimetres: 0.03, 0.06 ... 61.
OCTAVE_WAVELENGTHS_MM = tuple(0.03 * 2.0**index for index in range(12))
# An octave is silent below and above these rates, whole between them; the sensors' band of interest is
# 20-1000 Hz.
_FADE_IN_HZ = (4.0, 8.0)
_FADE_OUT_HZ = (1250.0, 2000.0)


@dataclass(frozen=True)
class TipPath:
    """What the tip does on the surface: position_mm [n, 2], velocity_mmps [n, 2], on a uniform clock."""

    position_mm: NDArray[np.float64]
    velocity_mmps: NDArray[np.float64]


def band_weight(rate_hz: NDArray[np.float64]) -> NDArray[np.float64]:
    """Gain of a component met at `rate_hz`: 1 in the band that is simulated, smoothly 0 outside it."""
    return _rise(rate_hz, *_FADE_IN_HZ) * (1.0 - _rise(rate_hz, *_FADE_OUT_HZ))


def upper_weight(rate_hz: NDArray[np.float64]) -> NDArray[np.float64]:
    """As `band_weight`, without the fade at low rates: for deterministic profiles."""
    return 1.0 - _rise(rate_hz, *_FADE_OUT_HZ)


def _rise(values: NDArray[np.float64], low: float, high: float) -> NDArray[np.float64]:
    share = np.clip((values - low) / (high - low), 0.0, 1.0)
    return share * share * (3.0 - 2.0 * share)


@lru_cache(maxsize=12 * 24)
def octave_tile(surface_seed: int, octave: int) -> NDArray[np.float32]:
    """A periodic field of RMS 1 whose wavelengths lie within about 0.65 octaves of CELLS_PER_WAVELENGTH
    cells.

    The values are cubic B-spline coefficients; the spline's own response is divided out.
    """
    rng = np.random.default_rng([surface_seed, octave])
    frequency = np.fft.fftfreq(TILE_CELLS)
    radius = np.hypot(frequency[:, None], frequency[None, :])
    octaves_off = np.abs(np.log2(np.maximum(radius, 1e-9) * CELLS_PER_WAVELENGTH))
    ring = np.cos(0.5 * math.pi * np.clip((octaves_off - 0.35) / 0.3, 0.0, 1.0)) / np.maximum(radius, 1e-9)
    spline = (np.sinc(frequency)[:, None] * np.sinc(frequency)[None, :]) ** 4
    spectrum = np.fft.fft2(rng.standard_normal((TILE_CELLS, TILE_CELLS))) * ring
    field = np.fft.ifft2(spectrum).real
    coefficients = np.fft.ifft2(spectrum / np.maximum(spline, 0.05)).real
    return (coefficients / np.std(field)).astype(np.float32)


def read_tile(
    tile: NDArray[np.float32], position_mm: NDArray[np.float64], wavelength_mm: float, angle: float
) -> NDArray[np.float64]:
    """The field at each position [n, 2], the tile scaled to `wavelength_mm` and turned by `angle`
    (radians).
    """
    scale = CELLS_PER_WAVELENGTH / wavelength_mm
    cosine, sine = scale * math.cos(angle), scale * math.sin(angle)
    x, y = position_mm[:, 0], position_mm[:, 1]
    cells = np.empty((2, len(position_mm)))
    cells[0] = cosine * x - sine * y
    cells[1] = sine * x + cosine * y
    return map_coordinates(tile, cells, output=np.float64, order=3, mode="grid-wrap", prefilter=False)


def random_height(material: Material, path: TipPath) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Heights [n] in micrometres under the tip, and the sideways tilt that neighbouring octaves give it.

    Along the grain the field is stretched by the material's anisotropy. The tip's finite contact patch passes
    wavelengths below it less and less.
    """
    calibrated = material.calibrated
    position = _grain_frame(material, path.position_mm)
    speed = np.hypot(*_grain_frame(material, path.velocity_mmps).T)
    angles = np.random.default_rng([material.surface_seed, 77]).uniform(0.0, 2.0 * math.pi, 12)
    height = np.zeros(len(position))
    tilt = np.zeros(len(position))
    for octave, wavelength in enumerate(OCTAVE_WAVELENGTHS_MM):
        weight = band_weight(speed / wavelength)
        felt = np.flatnonzero(weight)
        if felt.size == 0:
            continue
        amplitude = octave_height(material, wavelength)
        part = amplitude * weight[felt] * read_tile(
            octave_tile(material.surface_seed, octave), position[felt], wavelength, angles[octave]
        )
        height[felt] += part
        tilt[felt] += part if octave % 2 else -part
    return calibrated.height_micrometres * height, calibrated.height_micrometres * tilt


def octave_height(material: Material, wavelength_mm: float) -> float:
    """RMS height of the octave around a wavelength, over that at 1 mm, as the tip's patch feels it."""
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
