"""How alike two passes are, compared over place."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from scipy.signal import find_peaks, resample_poly

from haptoflow_paper.place.passes import Doubles, Pass
from haptoflow_training.waveform import SAMPLE_RATE_HZ

# One sample at 100 mm/s.
STEP_METRES = 5e-5
SHIFT_METRES = 1e-3
# From one value of a profile to the next: a straight line between values as far apart as samples would swallow high
# frequencies.
VALUE_METRES = STEP_METRES / 8.0
_BUMP_DISTANCE_METRES = 0.003
# Of the RMS. A Gaussian wave exceeds the first once in fifteen metres, the second twice a metre.
_BUMP_SIZE, _FOUND_SIZE = 4.5, 3.5


@dataclass(frozen=True)
class Profile:
    """A wave over place: values at `start_metres` + n VALUE_METRES."""

    start_metres: float
    values: Doubles

    def between(self, low_metres: float, high_metres: float, shift_metres: float = 0.0) -> Doubles:
        places = np.arange(low_metres, high_metres, STEP_METRES) + shift_metres
        known = self.start_metres + VALUE_METRES * np.arange(len(self.values))
        return np.interp(places, known, self.values)


def over_place(wave: Doubles, stroke: Pass) -> Profile:
    """The wave of a pass, resampled from its own samples per millimetre, in the direction of growing places."""
    ratio = Fraction(stroke.speed_mps / SAMPLE_RATE_HZ / VALUE_METRES).limit_denominator(1000)
    values = resample_poly(wave, ratio.numerator, ratio.denominator)
    if stroke.direction > 0.0:
        return Profile(stroke.start_metres, values)
    return Profile(stroke.start_metres - VALUE_METRES * (len(values) - 1), values[::-1])


@dataclass(frozen=True)
class Likeness:
    """Correlation after the best shift within a millimetre, that shift, and the correlation without one."""

    correlation: float
    shift_metres: float
    unshifted: float


def likeness(first: Profile, second: Profile, low_metres: float, high_metres: float) -> Likeness:
    reference = first.between(low_metres, high_metres)

    def at(shift: float) -> float:
        return float(np.corrcoef(reference, second.between(low_metres, high_metres, shift))[0, 1])

    shifts = np.arange(-SHIFT_METRES, SHIFT_METRES + 1e-9, 0.5 * STEP_METRES)
    found = [at(shift) for shift in shifts]
    best = int(np.argmax(found))
    return Likeness(found[best], float(shifts[best]), at(0.0))


def bumps(profile: Profile, low_metres: float, high_metres: float) -> Doubles:
    """Places of the outsized asperities: peaks, 3 mm apart or more, above 4.5 times the RMS."""
    size = _relative_size(profile.between(low_metres, high_metres))
    distance = round(_BUMP_DISTANCE_METRES / STEP_METRES)
    peaks, _ = find_peaks(size, distance=distance, height=_BUMP_SIZE)
    places: Doubles = low_metres + STEP_METRES * peaks
    return places


def found_again(places: Doubles, second: Profile, low_metres: float, high_metres: float) -> int:
    """Number of the places within a millimetre of which the second pass exceeds 3.5 times its RMS."""
    size = _relative_size(second.between(low_metres, high_metres))
    at = low_metres + STEP_METRES * np.arange(len(size))
    return sum(bool(np.any(size[np.abs(at - place) <= SHIFT_METRES] >= _FOUND_SIZE)) for place in places)


def _relative_size(wave: Doubles) -> Doubles:
    return np.abs(wave) / np.sqrt(np.mean(np.square(wave)))
