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
_BUMP_DISTANCE_METRES = 0.003


@dataclass(frozen=True)
class Profile:
    """A wave over place: values at `start_metres` + n STEP_METRES."""

    start_metres: float
    values: Doubles

    def between(self, low_metres: float, high_metres: float, shift_metres: float = 0.0) -> Doubles:
        places = np.arange(low_metres, high_metres, STEP_METRES) + shift_metres
        known = self.start_metres + STEP_METRES * np.arange(len(self.values))
        return np.interp(places, known, self.values)


def over_place(wave: Doubles, stroke: Pass) -> Profile:
    """The wave of a pass, resampled from its own samples per millimetre, in the direction of growing places."""
    ratio = Fraction(stroke.speed_mps / SAMPLE_RATE_HZ / STEP_METRES).limit_denominator(1000)
    values = resample_poly(wave, ratio.numerator, ratio.denominator)
    if stroke.direction > 0.0:
        return Profile(stroke.start_metres, values)
    return Profile(stroke.start_metres - STEP_METRES * (len(values) - 1), values[::-1])


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


def bumps(profile: Profile, low_metres: float, high_metres: float, count: int) -> Doubles:
    """Places of the highest peaks, 3 mm apart or more: the outsized asperities."""
    size = np.abs(profile.between(low_metres, high_metres))
    peaks, _ = find_peaks(size, distance=round(_BUMP_DISTANCE_METRES / STEP_METRES))
    highest = peaks[np.argsort(size[peaks])[::-1][:count]]
    places: Doubles = low_metres + STEP_METRES * highest
    return places


def share_found_again(first: Doubles, second: Doubles, within_metres: float = 1e-3) -> float:
    """Share of the first places that have one of the second near them."""
    near = np.abs(first[:, None] - second[None, :]).min(axis=1) <= within_metres
    return float(near.mean())
