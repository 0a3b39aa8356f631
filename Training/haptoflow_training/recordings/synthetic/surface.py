"""The height profile h(x, y): a self-affine random field, the sum of one non-repeating field for each octave of
wavelength.

The same place on a specimen always has the same height. Each octave is band-limited and faded out before the frequency
v / wavelength at which the tip meets it reaches the simulation's limit, so that nothing aliases at any speed.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from statistics import NormalDist

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import map_coordinates

from haptoflow_training.recordings.recording import RecordingIdentity
from haptoflow_training.recordings.synthetic.materials import Material

TILE_CELLS = 512
CELLS_PER_WAVELENGTH = 6.0
# Squares as wide as 27 wavelengths, cross-faded over more than three.
_PATCH_CELLS, _FADE_CELLS = 160.0, 20.0
_TILES_KEPT = 12

_Integers = NDArray[np.uint64]
_Floats = NDArray[np.float64]


@dataclass(frozen=True)
class RandomField:
    """One field of a specimen, identified by `number`: RMS 1, wavelengths within about 0.65 octaves of
    `wavelength_mm`."""

    surface_seed: int
    specimen: int
    number: int
    wavelength_mm: float

    def at(self, position_mm: _Floats) -> _Floats:
        """The field at each position [n, 2] in millimetres; the same position always gives the same value."""
        x, y = (_squares(place) for place in self._cells(position_mm))
        total = x.own_weight * y.own_weight * self._patch(x.cells, y.cells, x.own, y.own)
        beside, above = np.flatnonzero(x.faded), np.flatnonzero(y.faded)
        corner = beside[y.faded[beside]]
        for rows, i, j, weight in (
            (beside, x.neighbour, y.own, x.neighbour_weight[beside] * y.own_weight[beside]),
            (above, x.own, y.neighbour, x.own_weight[above] * y.neighbour_weight[above]),
            (corner, x.neighbour, y.neighbour, x.neighbour_weight[corner] * y.neighbour_weight[corner]),
        ):
            if rows.size:
                total[rows] += weight * self._patch(x.cells[rows], y.cells[rows], i[rows], j[rows])
        return total

    def _cells(self, position_mm: _Floats) -> tuple[_Floats, _Floats]:
        """Positions in cells of the tile, rotated and shifted by a hash, so that squares of two fields do not align."""
        here = np.zeros(1, np.int64)
        turn, shift_x, shift_y, _ = (float(each[0]) for each in place_fractions(self._key, here, here))
        scale = CELLS_PER_WAVELENGTH / self.wavelength_mm
        cosine, sine = scale * math.cos(2.0 * math.pi * turn), scale * math.sin(2.0 * math.pi * turn)
        x, y = position_mm[:, 0], position_mm[:, 1]
        return cosine * x - sine * y + _PATCH_CELLS * shift_x, sine * x + cosine * y + _PATCH_CELLS * shift_y

    @property
    def _key(self) -> int:
        return field_key(self.surface_seed, self.specimen, self.number)

    def _patch(self, x: _Floats, y: _Floats, i: NDArray[np.int64], j: NDArray[np.int64]) -> _Floats:
        """The content of the squares (i, j) [n] at the cells (x, y) [n]; a run of one square is hashed once."""
        starts = np.flatnonzero(np.concatenate([[True], (i[1:] != i[:-1]) | (j[1:] != j[:-1])]))
        lengths = np.diff(np.append(starts, len(i)))
        turns, offset_x, offset_y, _ = place_fractions(self._key, i[starts], j[starts])
        cosine, sine = np.cos(2.0 * math.pi * turns), np.sin(2.0 * math.pi * turns)
        centre_x, centre_y = _PATCH_CELLS * (i[starts] + 0.5), _PATCH_CELLS * (j[starts] + 0.5)
        # Tile coordinates = rotation (cells - centre) + offset, with the terms that are constant along a run combined.
        constant_x = TILE_CELLS * offset_x - cosine * centre_x + sine * centre_y
        constant_y = TILE_CELLS * offset_y - sine * centre_x - cosine * centre_y
        cosine, sine, constant_x, constant_y = (
            np.repeat(each, lengths) for each in (cosine, sine, constant_x, constant_y)
        )
        read = np.empty((2, len(x)))
        read[0] = cosine * x - sine * y + constant_x
        read[1] = sine * x + cosine * y + constant_y
        tile = _tile(self.surface_seed, self.specimen)
        return map_coordinates(tile, read, output=np.float64, order=3, mode="grid-wrap", prefilter=False)


@dataclass(frozen=True)
class _Squares:
    """Along one axis, for each cell coordinate [n]: its square and, where `faded`, the neighbour it is cross-faded
    with."""

    cells: _Floats
    own: NDArray[np.int64]
    own_weight: _Floats
    faded: NDArray[np.bool_]
    neighbour: NDArray[np.int64]
    neighbour_weight: _Floats


def _squares(cells: _Floats) -> _Squares:
    squares = cells / _PATCH_CELLS
    own = np.floor(squares)
    off_edge = squares - np.rint(squares)
    faded = np.abs(off_edge) < 0.5 * _FADE_CELLS / _PATCH_CELLS
    # From 0 on the edge to 1 half a fade away from it: the powers of a square and its neighbour add up to 1.
    reach = np.abs(off_edge[faded]) * (2.0 * _PATCH_CELLS / _FADE_CELLS)
    turn = 0.25 * math.pi * (1.0 + reach * (15.0 - 10.0 * reach**2 + 3.0 * reach**4) / 8.0)
    own_weight, neighbour_weight = np.ones(len(cells)), np.zeros(len(cells))
    own_weight[faded], neighbour_weight[faded] = np.sin(turn), np.cos(turn)
    neighbour = np.where(off_edge >= 0.0, own - 1.0, own + 1.0)
    return _Squares(cells, own.astype(np.int64), own_weight, faded, neighbour.astype(np.int64), neighbour_weight)


def field_key(surface_seed: int, specimen: int, number: int) -> int:
    """The key that identifies one field of one specimen of one surface in the hashes."""
    return (surface_seed * 1_000_003 + specimen) * 1_009 + number


def place_fractions(key: int, i: NDArray[np.int64], j: NDArray[np.int64]) -> tuple[_Floats, _Floats, _Floats, _Floats]:
    """Four independent numbers in [0, 1) for each place (i, j) [n] of the lattice of `key`: a hash without period."""
    place = _mixed(_mixed(_mixed(np.full(1, key, np.uint64)) + i.astype(np.uint64)) + j.astype(np.uint64))
    second = _mixed(place)
    low = np.uint64(0xFFFFFFFF)
    halves = (place >> np.uint64(32), place & low, second >> np.uint64(32), second & low)
    first, other, third, fourth = (half.astype(np.float64) / 2.0**32 for half in halves)
    return first, other, third, fourth


def _mixed(values: _Integers) -> _Integers:
    """SplitMix64 (Steele, Lea and Flood 2014): every bit of the result depends on every bit of the value."""
    values = values + np.uint64(0x9E3779B97F4A7C15)
    values = (values ^ (values >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    values = (values ^ (values >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return values ^ (values >> np.uint64(31))


@lru_cache(maxsize=1)
def _ring() -> tuple[_Floats, _Floats]:
    """Spectral amplitude of a tile in rfft2's layout, divided by the cubic B-spline's response."""
    rows, columns = np.fft.fftfreq(TILE_CELLS), np.fft.rfftfreq(TILE_CELLS)
    radius = np.maximum(np.hypot(rows[:, None], columns[None, :]), 1e-9)
    octaves_off = np.abs(np.log2(radius * CELLS_PER_WAVELENGTH))
    ring = np.cos(0.5 * math.pi * np.clip((octaves_off - 0.35) / 0.3, 0.0, 1.0)) / radius
    return ring, np.maximum((np.sinc(rows)[:, None] * np.sinc(columns)[None, :]) ** 4, 0.05)


@lru_cache(maxsize=_TILES_KEPT)
def _tile(surface_seed: int, specimen: int) -> NDArray[np.float32]:
    """Cubic B-spline coefficients of a periodic field of RMS 1, with CELLS_PER_WAVELENGTH cells to its wavelength."""
    rng = np.random.default_rng([surface_seed, specimen, 60])
    ring, spline = _ring()
    spectrum = np.fft.rfft2(rng.standard_normal((TILE_CELLS, TILE_CELLS))) * ring
    field = np.fft.irfft2(spectrum)
    return (np.fft.irfft2(spectrum / spline) / np.std(field)).astype(np.float32)


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


# Specimens of a material: pieces with the same label that differ in everything random.
# Another specimen has another random surface, other asperities and another jitter of the ribs, and is a little louder
# or softer, brighter or duller (SpecimenSpread). Calibrated values and ribs (wavelength, direction, profile, place)
# are the same. One specimen is held out: its level and tilt are the label's, and no training protocol records it,
# only the evaluation does. Further specimens are for figures between two pieces.
TRAINING_SPECIMENS = (0, 1, 2, 3, 4, 5, 6, 7)
HELD_OUT_SPECIMEN = 8
FURTHER_SPECIMENS = (9, 10, 11, 12)
# The steps of the machine protocol.
_DEGREES, _MMPS, _MILLINEWTONS = 45, 10, 500


def training_specimen(identity: RecordingIdentity) -> int:
    """The specimen that the training protocols record under this identity, one of TRAINING_SPECIMENS.

    Hand recordings cycle through the specimens by repeat; each cycle begins one earlier than the cycle before, so that
    conditions that recur every second, fourth or seventh time meet all specimens. Machine recordings move on by
    direction, speed, force and repeat together, so that each direction, speed and force meets several specimens, and
    repeats of a pass are on different ones.
    """
    count = len(TRAINING_SPECIMENS)
    if identity.direction_degrees is None:
        return TRAINING_SPECIMENS[(identity.repeat - identity.repeat // count) % count]
    place = identity.direction_degrees // _DEGREES + identity.speed_mmps // _MMPS
    place += 2 * (identity.force_millinewtons // _MILLINEWTONS) + 3 * identity.repeat
    return TRAINING_SPECIMENS[place % count]


# The number of the places' random field, beyond those of octaves and features.
_PLACE_LEVEL = 400
_PLACE_WAVELENGTH_MM = 60.0
_FURTHEST_SCORE = 2.0
# Numbers of the random draws, beyond those of the recorder's other generators.
_TRAINING_ORDER, _FURTHER_SCORES = 30, 31


@dataclass(frozen=True)
class SpecimenCharacter:
    """A specimen's difference from its label: level in dB, and spectral tilt in dB per octave around 100 Hz."""

    level_db: float
    tilt_db_per_octave: float


def character_of(material: Material, specimen: int) -> SpecimenCharacter:
    """The character of a specimen, 0 or more. That of the held-out specimen is typical: zero."""
    level, tilt = _scores(material.surface_seed, specimen)
    return SpecimenCharacter(material.specimen_spread_db * level, material.specimen_tilt_db_per_octave * tilt)


def _scores(surface_seed: int, specimen: int) -> tuple[float, float]:
    """Standard scores of level and tilt."""
    if specimen == HELD_OUT_SPECIMEN:
        return 0.0, 0.0
    count = len(TRAINING_SPECIMENS)
    if specimen in TRAINING_SPECIMENS:
        # Two orders, so that a louder specimen is not always a brighter one.
        rng = np.random.default_rng([surface_seed, _TRAINING_ORDER])
        level, tilt = (int(rng.permutation(count)[specimen]) for _ in range(2))
        return NormalDist().inv_cdf((level + 0.5) / count), NormalDist().inv_cdf((tilt + 0.5) / count)
    drawn = np.random.default_rng([surface_seed, specimen, _FURTHER_SCORES]).standard_normal(2)
    level_score, tilt_score = np.clip(drawn, -_FURTHEST_SCORE, _FURTHEST_SCORE)
    return float(level_score), float(tilt_score)


def surface_gain(material: Material, position_mm: NDArray[np.float64], specimen: int) -> NDArray[np.float64]:
    """The factor on the vibration at each position [n, 2]: the specimen's level, and its slow change with the place."""
    level_db = np.full(len(position_mm), character_of(material, specimen).level_db)
    if material.place_spread_db > 0.0:
        field = RandomField(material.surface_seed, specimen, _PLACE_LEVEL, _PLACE_WAVELENGTH_MM)
        level_db += material.place_spread_db * field.at(position_mm)
    return 10.0 ** (level_db / 20.0)
