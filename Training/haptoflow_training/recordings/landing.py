"""The vibration at touch-down: decaying sinusoids, from the material's stiffness, damping and resonances in the
recorder.

A tip of mass m that lands with speed v on a spring k vibrates as v sqrt(k/m) e^(-Bt) sin(sqrt(k/m) t) (Okamura,
Cutkosky, Dennerlein 2001, fit the same form to taps on real materials). The spring is that of the virtual surface, so
that a stiffer surface also sounds harder; a resonance of the specimen is added. The mass, the restitution and the decay
were chosen by listening and from plots, not measured: rubber, wood and stone come to about 90, 170 and 320 Hz. For labels
of which it knows a usual piece, the engine keeps the restitution only, and taps on that piece instead.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from haptoflow_training.recordings.synthetic.features import JITTER_WAVELENGTHS, SLIP_WANDER, SLIP_WANDER_MM
from haptoflow_training.recordings.synthetic.materials import Material

# A tip of about 1 g: the stylus's own mass is coupled to the hand.
_TIP_KILOGRAMS = 1.0 / (2.0 * math.pi * 5.0) ** 2
_MINIMUM_HZ, _MAXIMUM_HZ = 25.0, 450.0
_SHARE_LEFT_BY_THE_HAND = 0.15
_MINIMUM_DECAY_PER_SECOND, _DECAY_PER_HERTZ = 60.0, 0.15
_USUAL_DAMPING = 0.4
_SHARE_OF_A_RESONANCE = 0.3
# A tip does not bounce off the softest material; each tenfold stiffness adds this to the share of speed that it keeps.
_RESTITUTION_PER_DECADE, _SOFTEST_NEWTONS_PER_METRE, _MAXIMUM_RESTITUTION = 0.2, 200.0, 0.35


@dataclass(frozen=True)
class LandingMode:
    """frequency_hz; decay_per_second: B of e^(-Bt); gain_per_second: amplitude in m/s^2 for each m/s of landing
    speed."""

    frequency_hz: float
    decay_per_second: float
    gain_per_second: float


@dataclass(frozen=True)
class Landing:
    """modes: first the tip on the contact's spring, then the specimen's strongest resonance if it has one below 950
    Hz. restitution: the share of its speed that the tip keeps when it bounces, 0 to 0.35."""

    modes: tuple[LandingMode, ...]
    restitution: float


def landing_of(material: Material) -> Landing:
    """The touch-down vibration of one material of the recorder."""
    damping = material.contact_damping / _USUAL_DAMPING
    return landing_of_spring(material.stiffness_newtons_per_metre, damping, material.tool_modes)


def landing_of_spring(
    stiffness: float, damping: float = 1.0, tool_modes: Sequence[tuple[float, float, float]] = ()
) -> Landing:
    """The touch-down vibration on a spring in N/m; of a recorded label nothing else is known. damping: 1 is usual.
    tool_modes: as of Material."""
    frequency = math.sqrt(stiffness / _TIP_KILOGRAMS) / (2.0 * math.pi)
    frequency = min(max(frequency, _MINIMUM_HZ), _MAXIMUM_HZ)
    gain = _SHARE_LEFT_BY_THE_HAND * 2.0 * math.pi * frequency
    modes = [LandingMode(frequency, damping * (_MINIMUM_DECAY_PER_SECOND + _DECAY_PER_HERTZ * frequency), gain)]
    ringing = [mode for mode in tool_modes if mode[1] > 0.0 and mode[0] < 950.0]
    if ringing:
        ring_hz, gain_db, quality = max(ringing, key=lambda mode: mode[1])
        share = _SHARE_OF_A_RESONANCE * min(1.0, 10.0 ** ((gain_db - 6.0) / 20.0))
        modes.append(LandingMode(ring_hz, max(_MINIMUM_DECAY_PER_SECOND, math.pi * ring_hz / quality), share * gain))
    decades = max(0.0, math.log10(stiffness / _SOFTEST_NEWTONS_PER_METRE))
    return Landing(tuple(modes), min(_MAXIMUM_RESTITUTION, _RESTITUTION_PER_DECADE * decades))


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
