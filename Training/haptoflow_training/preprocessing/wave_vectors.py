"""Wave vectors of ribs and threads from recordings of a surface: lines of the spectrum that follow the speed, by
direction.

A ruled surface with wave vector k sounds at |k . v|: with the place x on the surface, it is a line at exp(2 pi i k . x),
whatever speed and direction do meanwhile. Recordings are cut into stretches of path; what always sounds (the stylus's
resonances) is flattened over time, each stretch's own spectrum along its path, and the power at every k of a half plane is
averaged. A line that stays in place while the speed changes is averaged out; one speed alone shows nothing.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from scipy import signal
from scipy.ndimage import median_filter

if TYPE_CHECKING:
    from haptoflow_training.recordings.material_recording import MaterialRecording

_Doubles = NDArray[np.float64]
WaveVector = tuple[float, float]

SHORTEST_WAVELENGTH_MM, LONGEST_WAVELENGTH_MM = 0.4, 7.5
_RATE_HZ = 2000.0
_PATH_MM = 30.0
_POINTS = 300
_FEWEST_STRETCHES, _MOST_STRETCHES = 14, 200
_SLOWEST_MMPS, _LARGEST_SPEED_RATIO, _LEAST_STRAIGHT = 12.0, 2.5, 0.9
# Where a line can be told from the hand's own motion and from the end of the band.
_LOWEST_HZ, _HIGHEST_HZ = 28.0, 800.0
_FEWEST_TURNS = 4.0
_STEP_PER_MM = 1.0 / 70.0
_LARGEST_POWER, _LARGEST_ROOT = 20.0, 8.0
_LINE_RADIUS_PER_MM, _OCTAVE_RADIUS_PER_MM = 0.045, 0.03
# A line's main lobe along a stretch of path reaches two of its bins to each side.
_LOBE_PER_MM = 2.2 / _PATH_MM
# The harmonics of a vector that is slightly off, or of ribs that are not quite even, lie further from where they should.
_WIDER_BY_ORDER = 0.12
_NEIGHBOURHOOD_PER_MM = 0.3
# In standard deviations of an average over noise, and times its mean; noise alone stays below 8 and 1.7.
_SURE, _STRONG = 9.0, 1.9
# Where the harmonics of a known vector are left out, there is less to hear a second one in.
_SURE_BESIDE_KNOWN, _FEWEST_BESIDE_KNOWN = 6.0, 20
# Times the mean of noise, of all groups of frequencies and of directions but one; and of a fundamental over its harmonic.
_EVERYWHERE, _SHARE_OF_HARMONIC = 1.3, 0.4
_CANDIDATES, _LARGEST_SUPPORT = 12, 6.0
_LEAST_SPREAD = 0.12
_HARMONICS = 8
_MOST_WAVE_VECTORS = 2


@dataclass(frozen=True)
class _Stretch:
    """values [300] of unit power per bin, evenly spaced along the path; place_mm [300, 2]; speed in mm/s."""

    values: NDArray[np.float32]
    place_mm: NDArray[np.float32]
    speed_mmps: float

    @property
    def chord_mm(self) -> NDArray[np.float32]:
        chord: NDArray[np.float32] = self.place_mm[-1] - self.place_mm[0]
        return chord

    def heard(self, vectors: NDArray[np.floating]) -> NDArray[np.bool_]:
        """Of wave vectors [..., 2]: whose lines this stretch would hold, enough of their waves, inside the band."""
        along = np.abs(vectors @ self.chord_mm)
        hertz = along / np.linalg.norm(self.chord_mm) * self.speed_mmps
        return np.asarray((along > _FEWEST_TURNS) & (hertz > _LOWEST_HZ) & (hertz < _HIGHEST_HZ))


def estimate_wave_vectors(recordings: Sequence[MaterialRecording]) -> tuple[WaveVector, ...]:
    """Up to two wave vectors (x, y) in cycles per millimetre, the clearest first; empty where there are none, or where
    the recordings cannot tell: less than 0.3 m of path, or always the same speed and direction.

    Wavelengths of 0.4 to 7.5 mm. Of a ruled surface that was recorded in one direction only, the vector found lies along
    that direction.
    """
    stretches = _stretches(recordings)
    if len(stretches) < _FEWEST_STRETCHES:
        return ()
    plane = _Plane(stretches)
    found: list[WaveVector] = []
    while len(found) < _MOST_WAVE_VECTORS:
        candidate = plane.clearest(found)
        if candidate is None:
            break
        found.append(plane.refined(plane.fundamental(candidate)))
    return tuple(found)


class _Plane:
    """Power of all stretches over a half plane of wave vectors."""

    def __init__(self, stretches: list[_Stretch]) -> None:
        self._stretches = stretches
        highest = 1.0 / SHORTEST_WAVELENGTH_MM
        self._x = np.arange(0.0, highest + 1e-9, _STEP_PER_MM)
        self._y = np.arange(-round(highest / _STEP_PER_MM), round(highest / _STEP_PER_MM) + 1) * _STEP_PER_MM
        self._vectors = np.stack(np.meshgrid(self._x, self._y, indexing="ij"), axis=-1).astype(np.float32)
        lengths = np.linalg.norm(self._vectors, axis=-1)
        self._allowed = (lengths >= 1.0 / LONGEST_WAVELENGTH_MM) & (lengths <= highest)
        # The other half of the first column is the same waves.
        self._allowed[0, self._y < 0.0] = False
        self._powers = [self._powers_of(stretch) for stretch in stretches]

    def _powers_of(self, stretch: _Stretch) -> NDArray[np.float16]:
        across = np.exp(-2j * np.pi * np.outer(self._x, stretch.place_mm[:, 0])).astype(np.complex64)
        along = np.exp(-2j * np.pi * np.outer(stretch.place_mm[:, 1], self._y)).astype(np.complex64)
        power = np.square(np.abs((across * stretch.values) @ along))
        return np.minimum(power, _LARGEST_POWER).astype(np.float16)

    def _evidence(self, known: Sequence[WaveVector]) -> tuple[_Doubles, _Doubles]:
        """(ratio to the neighbourhood, standard deviations above it) at every vector. Stretches in which a known line
        would be heard in its place are left out there."""
        total = np.zeros(self._vectors.shape[:2])
        count = np.zeros(self._vectors.shape[:2])
        for stretch, power in zip(self._stretches, self._powers, strict=True):
            counted = stretch.heard(self._vectors) & ~_explained(stretch, self._vectors, known)
            total += np.where(counted, power, 0.0)
            count += counted
        mean = total / np.maximum(count, 1.0)
        enough = count >= (_FEWEST_BESIDE_KNOWN if known else _FEWEST_STRETCHES)
        ratio = mean / np.maximum(_neighbourhood(np.where(enough, mean, 1.0)), 1.0)
        ratio[~(enough & self._allowed)] = 0.0
        return ratio, (ratio - 1.0) * np.sqrt(count)

    @cached_property
    def _unaided(self) -> tuple[_Doubles, _Doubles]:
        return self._evidence(())

    def clearest(self, known: Sequence[WaveVector]) -> WaveVector | None:
        """The vector with the clearest line that holds at low frequencies as at high ones; None without one."""
        ratio, sureness = self._evidence(known) if known else self._unaided
        sureness = sureness.copy()
        if known:
            # As clear as a first one in all stretches, and still there in those that cannot be misled.
            _, unaided = self._unaided
            sureness = np.minimum(unaided, sureness * (_SURE / _SURE_BESIDE_KNOWN))
        for vector in known:
            for order in range(1, _HARMONICS + 1):
                near = np.linalg.norm(self._vectors - order * np.array(vector), axis=-1) < 1.5 * _LOBE_PER_MM
                sureness[near] = 0.0
        best: tuple[float, WaveVector | None] = (0.0, None)
        for _ in range(_CANDIDATES):
            place = np.unravel_index(int(sureness.argmax()), sureness.shape)
            if sureness[place] < _SURE:
                break
            vector = self._vectors[place]
            if ratio[place] >= _STRONG and min(self._support(vector, known), self._support(vector, ())) > _EVERYWHERE:
                # Beside a known vector, its harmonics lend support to what is not one.
                weight = 1.0 if known else min(self._support(vector, ()), _LARGEST_SUPPORT)
                best = max(best, (float(sureness[place]) * weight, (float(vector[0]), float(vector[1]))))
            sureness[np.linalg.norm(self._vectors - vector, axis=-1) < _LOBE_PER_MM] = 0.0
        return best[1]

    def _support(self, vector: NDArray[np.floating], known: Sequence[WaveVector]) -> float:
        """Mean power of its line where that is weakest but one: of four groups of the frequencies at which it was passed,
        and of five groups of directions. What only seems to be a wave vector is where harmonics of another one are in
        some directions. 0 where the frequencies hardly differ."""
        rows = []
        for stretch in self._stretches:
            if stretch.heard(vector) and not _explained(stretch, vector, known):
                chord = stretch.chord_mm
                hertz = abs(float(vector @ chord)) / float(np.linalg.norm(chord)) * stretch.speed_mmps
                angle = float(np.arctan2(vector[0] * chord[1] - vector[1] * chord[0], vector @ chord)) % np.pi
                rows.append((hertz, angle, min(_power_at(stretch, vector), _LARGEST_POWER)))
        passed = np.array(rows)
        if len(passed) < _FEWEST_STRETCHES or float(np.log(passed[:, 0]).std()) < _LEAST_SPREAD:
            return 0.0
        weakest = []
        # Beside a known vector, few directions are left to compare.
        for column, groups in ((0, 4),) if known else ((0, 4), (1, 5)):
            powers = passed[np.argsort(passed[:, column], kind="stable"), 2]
            weakest.append(sorted(float(part.mean()) for part in np.array_split(powers, groups))[1])
        return min(weakest)

    def fundamental(self, vector: WaveVector) -> WaveVector:
        """The lowest fraction of a clear line that is a clear line as well: a rib's harmonics may be stronger than it."""
        ratio, sureness = self._unaided
        for order in (4, 3, 2):
            wanted = np.array(vector) / order
            near = np.linalg.norm(self._vectors - wanted, axis=-1) < 1.5 * _STEP_PER_MM
            clear = near & (sureness >= _SURE) & (ratio >= _STRONG)
            if clear.any():
                place = np.unravel_index(int(np.where(clear, sureness, 0.0).argmax()), sureness.shape)
                lower = self._support(self._vectors[place], ())
                if lower > max(_EVERYWHERE, _SHARE_OF_HARMONIC * self._support(np.array(vector), ())):
                    return float(self._vectors[place][0]), float(self._vectors[place][1])
        return vector

    def refined(self, vector: WaveVector) -> WaveVector:
        """The vector to a finer step than the plane's: where the sum of its line and of the line at twice its frequency is
        largest. Uneven threads have no line there: of those, the centre of the line itself."""
        best = np.array(vector)
        if self._has_octave(best):
            for reach in (2.0 * _STEP_PER_MM, _STEP_PER_MM / 2.0, _STEP_PER_MM / 8.0):
                best = max(best + _offsets(reach, 5), key=lambda place: self._strengths(place[None], (1, 2))[0])
        else:
            best = 0.5 * (self._centre(best, _LINE_RADIUS_PER_MM, (1,)) + self._centre(best, _OCTAVE_RADIUS_PER_MM, (1, 2)))
        # The opposite vector is the same ribs.
        sign = 1.0 if best[np.abs(best).argmax()] > 0.0 else -1.0
        return round(sign * float(best[0]), 5), round(sign * float(best[1]), 5)

    def _centre(self, vector: _Doubles, radius_per_mm: float, orders: Sequence[int]) -> _Doubles:
        for _ in range(3):
            offsets = _offsets(radius_per_mm, 9)
            offsets = offsets[np.linalg.norm(offsets, axis=1) <= 1.001 * radius_per_mm]
            strengths = self._strengths(vector + offsets, orders)
            weights = np.maximum(strengths - np.quantile(strengths, 0.4), 0.0)
            vector = vector + weights @ offsets / (weights.sum() + 1e-12)
        return vector

    def _has_octave(self, vector: _Doubles) -> bool:
        ratio, sureness = self._unaided
        near = np.linalg.norm(self._vectors - 2.0 * vector, axis=-1) < 2.0 * _STEP_PER_MM
        return bool((near & (sureness >= _SURE) & (ratio >= _STRONG)).any())

    def _strengths(self, vectors: _Doubles, orders: Sequence[int]) -> _Doubles:
        """Of each vector [n, 2]: the mean root of its line's power, summed over these multiples."""
        total = np.zeros(len(vectors))
        for order in orders:
            roots, count = np.zeros(len(vectors)), np.zeros(len(vectors))
            for stretch in self._stretches:
                heard = stretch.heard(order * vectors)
                waves = np.exp(-2j * np.pi * order * (vectors @ stretch.place_mm.T)) @ stretch.values
                roots += np.where(heard, np.minimum(np.abs(waves), _LARGEST_ROOT), 0.0)
                count += heard
            total += roots / np.maximum(count, 1.0)
        return total


def _offsets(reach: float, points: int) -> _Doubles:
    """[points^2, 2]: a square grid about 0."""
    steps = np.linspace(-reach, reach, points)
    return np.stack(np.meshgrid(steps, steps, indexing="ij"), axis=-1).reshape(-1, 2)


def _power_at(stretch: _Stretch, vector: NDArray[np.floating]) -> float:
    return float(np.square(np.abs(np.exp(-2j * np.pi * (stretch.place_mm @ vector)) @ stretch.values)))


def _explained(
    stretch: _Stretch, vectors: NDArray[np.floating], known: Sequence[WaveVector]
) -> NDArray[np.bool_] | np.bool_:
    """Which vectors [..., 2] this stretch cannot tell from a harmonic of a known one."""
    direction = stretch.chord_mm / np.linalg.norm(stretch.chord_mm)
    along = np.abs(vectors @ direction)
    explained: NDArray[np.bool_] | np.bool_ = np.zeros(np.shape(along), dtype=np.bool_)
    for vector in known:
        fundamental = abs(float(np.array(vector) @ direction))
        for order in range(_HARMONICS + 1):
            explained = explained | (np.abs(along - order * fundamental) < (1.0 + _WIDER_BY_ORDER * order) * _LOBE_PER_MM)
    return explained


def _neighbourhood(values: _Doubles) -> _Doubles:
    """The median about each point: of every third one, which is the same and quicker."""
    reach = round(_NEIGHBOURHOOD_PER_MM / (3.0 * _STEP_PER_MM)) | 1
    coarse = median_filter(values[::3, ::3], size=(reach, reach), mode="reflect")
    return np.asarray(np.repeat(np.repeat(coarse, 3, axis=0), 3, axis=1)[: values.shape[0], : values.shape[1]])


def _stretches(recordings: Sequence[MaterialRecording]) -> list[_Stretch]:
    """Of a fairly straight path and a fairly steady speed; spread evenly over what there is."""
    moving = [one for one in recordings if len(one.vibration_mps2) > 256]
    found: list[_Stretch] = []
    for recording, flat in zip(moving, _flattened(moving), strict=True):
        velocity = 1000.0 * recording.velocity_mps.astype(np.float64)
        place = np.cumsum(velocity, axis=0) / _RATE_HZ
        speed = np.linalg.norm(velocity, axis=1)
        path = np.cumsum(speed) / _RATE_HZ
        for number in range(int(path[-1] / _PATH_MM)):
            first, last = np.searchsorted(path, [number * _PATH_MM, (number + 1) * _PATH_MM])
            part = slice(int(first), int(last))
            steady = speed[part].max(initial=0.0) < _LARGEST_SPEED_RATIO * speed[part].min(initial=1e9)
            if last - first < 32 or not steady or speed[part].min() < _SLOWEST_MMPS:
                continue
            if np.linalg.norm(place[last - 1] - place[first]) < _LEAST_STRAIGHT * _PATH_MM:
                continue
            mean_speed = float(speed[part].mean())
            stretch = _stretch(flat[part], place[part] - place[first], path[part] - path[first], mean_speed)
            if stretch is not None:
                found.append(stretch)
    if len(found) > _MOST_STRETCHES:
        found = [found[place] for place in np.linspace(0, len(found) - 1, _MOST_STRETCHES).round().astype(int)]
    return found


def _flattened(recordings: Sequence[MaterialRecording]) -> list[_Doubles]:
    """Without what sounds at the same frequency whatever the speed: the label's median spectrum is divided out."""
    size = 256
    spectra = []
    for recording in recordings:
        frequency, _, frames = signal.stft(
            recording.vibration_mps2.astype(np.float64), _RATE_HZ, nperseg=size, noverlap=size // 2, boundary=None
        )
        middles = np.minimum(np.arange(frames.shape[1]) * (size // 2) + size // 2, len(recording.velocity_mps) - 1)
        moves = np.linalg.norm(recording.velocity_mps[middles], axis=1) > 1e-3 * _SLOWEST_MMPS
        logarithms = np.log(np.square(np.abs(frames[:, moves])) + 1e-12)
        spectra.append((logarithms - logarithms.mean(axis=0)).T)
    together = np.concatenate(spectra) if spectra else np.zeros((0, size // 2 + 1))
    if len(together) == 0:
        return [one.vibration_mps2.astype(np.float64) for one in recordings]
    usual = median_filter(np.median(together, axis=0), size=5, mode="nearest")
    flat = []
    for recording in recordings:
        count = len(recording.vibration_mps2)
        padded = 1 << (count + size).bit_length()
        hertz = np.fft.rfftfreq(padded, 1.0 / _RATE_HZ)
        gain = np.exp(-0.5 * np.interp(hertz, frequency, usual)) * ((hertz > 12.0) & (hertz < 920.0))
        spectrum = np.fft.rfft(recording.vibration_mps2.astype(np.float64), padded)
        flat.append(np.fft.irfft(spectrum * gain, padded)[:count])
    return flat


def _stretch(values: _Doubles, place_mm: _Doubles, path_mm: _Doubles, speed_mmps: float) -> _Stretch | None:
    """Evenly spaced along its path, its own spectrum flattened; None where the band leaves too little of it."""
    edges = np.linspace(0.0, path_mm[-1], _POINTS + 1)
    spacing = path_mm[-1] / _POINTS
    # Means over each step: of slow motion they are many samples.
    sums = np.concatenate([[0.0], np.cumsum(values * np.gradient(path_mm))])
    even = np.diff(np.interp(edges, np.concatenate([[0.0], path_mm]), sums)) / spacing
    middles = 0.5 * (edges[1:] + edges[:-1])
    place = np.column_stack([np.interp(middles, path_mm, axis) for axis in place_mm.T])
    spectrum = np.fft.rfft((even - even.mean()) * np.hanning(_POINTS))
    hertz = np.fft.rfftfreq(_POINTS, spacing) * speed_mmps
    band = (hertz > 22.0) & (hertz < 880.0)
    if band.sum() < 12:
        return None
    logarithms = np.log(np.square(np.abs(spectrum[band])) + 1e-12)
    # The median of a chi-squared variable of two degrees is 0.69 of its mean.
    usual = np.exp(median_filter(logarithms, size=15, mode="mirror")) / 0.69
    spectrum[~band] = 0.0
    spectrum[band] /= np.sqrt(usual)
    flat = np.fft.irfft(spectrum, _POINTS)
    return _Stretch(flat.astype(np.float32), place.astype(np.float32), speed_mmps)
