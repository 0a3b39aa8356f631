"""From the surface under a moving tip to the acceleration of the tool, at the simulation's uniform rate."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.signal import sosfilt

from haptoflow_training.recordings.synthetic.features import (
    impact_acceleration, rib_wander_turns, ruling_height, slip_acceleration, slips_of
)
from haptoflow_training.recordings.synthetic.materials import MAXIMUM_RULINGS, Material
from haptoflow_training.recordings.synthetic.surface import TipPath, character_of, random_height, surface_gain

SIMULATION_RATE_HZ = 8000.0
# A Hertzian contact's stiffness grows as F^(1/3), and its resonance as the root of the stiffness.
_HERTZ_EXPONENT = 1.0 / 6.0
_FORCE_RANGE_NEWTONS = (0.3, 3.0)
# The contact is also stiffer when deformed faster: about as v^0.24, with the resonance as the root of that.
_RESONANCE_SPEED_EXPONENT = 0.12
_SPEED_RANGE_MMPS = (5.0, 1500.0)
_REFERENCE_SPEED_MMPS = 100.0
# Resonances at which the contact is filtered are this factor apart, with blending between them: closer than the width
# of the narrowest peak.
_RESONANCE_STEP = 1.2
# Relative resonance and damping of the tool along the surface, where it rests against the grip.
_TANGENTIAL_RESONANCE, _TANGENTIAL_DAMPING = 0.8, 1.2
_LATERAL_SHARE = 0.5
# The level at which a tip pressed with 1 N loses contact most of the time.
_BOUNCE_MPS2 = 50.0
_EFFECTIVE_MASS_KG = 0.02
# Below this force the tip leaves the surface: the level goes to zero whatever the force exponent.
_TOUCH_NEWTONS = 0.02


@dataclass(frozen=True)
class ToolVibration:
    """acceleration_mps2: [n, 3], X and Y in the surface, Z along its normal, without gravity or noise; zero where the
    tip rests. wander_turns: [n, 3], the phases that do not follow from the position: for each of two families of ribs by
    how many turns they lie ahead of evenly spaced ones, and the cycles of stick and slip; zero for what the material
    lacks."""

    acceleration_mps2: NDArray[np.float64]
    wander_turns: NDArray[np.float64]


def tool_vibration(
    material: Material, path: TipPath, force_newtons: NDArray[np.float64], *, specimen: int
) -> ToolVibration:
    """The vibration of a tool whose tip follows `path`; path and force_newtons [n] are at SIMULATION_RATE_HZ."""
    rate = SIMULATION_RATE_HZ
    height, tilt = random_height(material, path, specimen=specimen)
    wander_turns = np.zeros((len(height), MAXIMUM_RULINGS + 1))
    for number, ruling in enumerate(material.rulings):
        wander_turns[:, number] = rib_wander_turns(material, ruling, number, path, specimen=specimen)
        height += ruling_height(material, ruling, number, path, wander_turns[:, number])
    impacts = impact_acceleration(material, path, rate, specimen=specimen)
    pulls = 0.5 * impacts
    slips = slips_of(material, path, force_newtons, rate, specimen=specimen)
    if slips is not None:
        wander_turns[:, -1] = slips.turns
        pulls = pulls + slip_acceleration(material, path, slips) / material.tangential_share

    tail = _shared_sections(material, character_of(material, specimen).tilt_db_per_octave, rate)
    speed = np.hypot(*path.velocity_mmps.T)
    stiffening = resonance_steps(speed, force_newtons)
    normal = _through_contact(material, 1e-6 * height, impacts, stiffening, 1.0, 1.0, tail)
    along = material.tangential_share * _through_contact(
        material, 1e-6 * height, pulls, stiffening, _TANGENTIAL_RESONANCE, _TANGENTIAL_DAMPING, tail
    )
    across = _LATERAL_SHARE * material.tangential_share * _through_contact(
        material, 1e-6 * tilt, -0.5 * impacts, stiffening, _TANGENTIAL_RESONANCE, _TANGENTIAL_DAMPING, tail
    )

    heading = path.velocity_mmps / np.sqrt(speed**2 + 1.0)[:, None]
    gain = np.maximum(force_newtons, _TOUCH_NEWTONS) ** material.calibrated.force_exponent
    gain = gain * np.clip(force_newtons / _TOUCH_NEWTONS, 0.0, 1.0)
    gain = gain * surface_gain(material, path.position_mm, specimen)
    if material.nap != 0.0:
        grain = math.radians(material.grain_degrees)
        gain = gain * (1.0 - material.nap * (heading @ np.array([math.cos(grain), math.sin(grain)])))
    gain = gain * _bounce_gain(material, speed, force_newtons)
    acceleration = np.stack(
        [
            gain * (along * heading[:, 0] - across * heading[:, 1]),
            gain * (along * heading[:, 1] + across * heading[:, 0]),
            _pressed(gain * normal, force_newtons),
        ],
        axis=1,
    )
    return ToolVibration(acceleration, wander_turns)


def _shared_sections(material: Material, tilt_db_per_octave: float, rate_hz: float) -> NDArray[np.float64]:
    sections = [absorption(material.calibrated.absorption_db_per_octave + tilt_db_per_octave, rate_hz)]
    sections += [peak(*mode, rate_hz) for mode in material.tool_modes]
    return np.concatenate(sections)


def resonance_steps(speed_mmps: NDArray[np.float64], force_newtons: NDArray[np.float64]) -> NDArray[np.float64]:
    """By how many factors of _RESONANCE_STEP the contact's resonance exceeds that at 100 mm/s and 1 N.

    The contact is Hertzian: it is stiffer when pressed harder. Surface, grip and skin are viscoelastic: they are
    stiffer when deformed faster. Together with the finite tip, which at low speed averages short wavelengths away, this
    makes the spectral centroid rise with speed as in the published statistics of tool-held textures, about as v^0.15
    pooled over textures; the speed exponent was chosen for that. With a fixed resonance, a power-law surface would give
    each label one spectrum whose level alone depends on speed.
    """
    force = np.clip(force_newtons, *_FORCE_RANGE_NEWTONS)
    speed = np.clip(speed_mmps, *_SPEED_RANGE_MMPS) / _REFERENCE_SPEED_MMPS
    ratio = _HERTZ_EXPONENT * np.log(force) + _RESONANCE_SPEED_EXPONENT * np.log(speed)
    return ratio / math.log(_RESONANCE_STEP)


def _through_contact(
    material: Material,
    height_metres: NDArray[np.float64],
    acceleration: NDArray[np.float64],
    stiffening: NDArray[np.float64],
    relative_resonance: float,
    relative_damping: float,
    tail: NDArray[np.float64],
) -> NDArray[np.float64]:
    """The contact filtered at resonances of whole numbers of steps, blended sample by sample to `stiffening` steps."""
    rate, damping = SIMULATION_RATE_HZ, material.contact_damping * relative_damping
    struck = bool(np.any(acceleration))
    blended = np.zeros(len(height_metres))
    for step in range(math.floor(stiffening.min()), math.ceil(stiffening.max()) + 1):
        share = np.clip(1.0 - np.abs(stiffening - step), 0.0, 1.0)
        resonance = material.calibrated.contact_resonance_hz * relative_resonance * _RESONANCE_STEP**step
        from_height = contact_from_height(resonance, damping, rate)
        part = sosfilt(from_height, height_metres - height_metres[0])
        if struck:
            part += sosfilt(contact_from_acceleration(resonance, damping, rate), acceleration)
        blended += share * part
    return sosfilt(tail, blended)


def _bounce_gain(
    material: Material, speed_mmps: NDArray[np.float64], force_newtons: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Below 1 where the level at full contact would throw the tip off: the level saturates with speed."""
    targets = material.targets
    force = np.maximum(force_newtons, 0.05)
    level = targets.k * (speed_mmps / 100.0) ** targets.p * force**targets.q
    return (1.0 + (level / (_BOUNCE_MPS2 * force**0.2)) ** 2) ** -0.5


def _pressed(normal: NDArray[np.float64], force_newtons: NDArray[np.float64]) -> NDArray[np.float64]:
    """Off the surface, only force and weight accelerate the tip: downwards it is limited to F / mass + g."""
    floor = np.maximum(force_newtons, 0.0) / _EFFECTIVE_MASS_KG + 9.81
    falling = np.minimum(normal, 0.0) / floor
    return np.maximum(normal, 0.0) + floor * falling / (1.0 + falling**4) ** 0.25


Section = NDArray[np.float64]

_TILT_CORNERS_HZ = tuple(30.0 * 2.0**index for index in range(6))


def _denominator(frequency_hz: float, damping: float, rate_hz: float) -> tuple[float, float, float, float]:
    k = math.tan(math.pi * min(frequency_hz, 0.45 * rate_hz) / rate_hz)
    a0 = 1.0 + 2.0 * damping * k + k * k
    return k, a0, 2.0 * (k * k - 1.0) / a0, (1.0 - 2.0 * damping * k + k * k) / a0


def contact_from_acceleration(frequency_hz: float, damping: float, rate_hz: float) -> Section:
    """A mass on its contact spring: w^2 / (s^2 + 2 d w s + w^2), unity at rest."""
    k, a0, a1, a2 = _denominator(frequency_hz, damping, rate_hz)
    gain = k * k / a0
    return np.array([[gain, 2.0 * gain, gain, 1.0, a1, a2]])


def contact_from_height(frequency_hz: float, damping: float, rate_hz: float) -> Section:
    """The same contact fed by a height in metres: s^2 w^2 / (...), acceleration without a derivative."""
    k, a0, a1, a2 = _denominator(frequency_hz, damping, rate_hz)
    gain = (2.0 * rate_hz * k) ** 2 / a0
    return np.array([[gain, -2.0 * gain, gain, 1.0, a1, a2]])


def absorption(db_per_octave: float, rate_hz: float) -> Section:
    """A filter whose gain changes by `db_per_octave` from 20 Hz to 1 kHz and is 0 dB at 100 Hz, made of pairs of a pole and
    a zero, an octave apart."""
    ratio = 2.0 ** (db_per_octave / 6.0206)
    sections = []
    gain_at_100 = 1.0
    for corner in _TILT_CORNERS_HZ:
        zero, pole = corner / math.sqrt(ratio), corner * math.sqrt(ratio)
        wz, wp = (math.tan(math.pi * min(each, 0.45 * rate_hz) / rate_hz) for each in (zero, pole))
        b0, b1, a0, a1 = (1.0 + wz) / wz, (wz - 1.0) / wz, (1.0 + wp) / wp, (wp - 1.0) / wp
        sections.append([b0 / a0, b1 / a0, 0.0, 1.0, a1 / a0, 0.0])
        turn = np.exp(-2j * math.pi * 100.0 / rate_hz)
        gain_at_100 *= abs((b0 + b1 * turn) / (a0 + a1 * turn))
    result = np.array(sections)
    result[0, :3] /= gain_at_100
    return result


def peak(frequency_hz: float, gain_db: float, q: float, rate_hz: float) -> Section:
    """A resonance (or an absorption, with negative gain) of a tool or a sensor mount; 0 dB far away."""
    w = 2.0 * math.pi * min(frequency_hz, 0.45 * rate_hz) / rate_hz
    amplitude, alpha = 10.0 ** (gain_db / 40.0), math.sin(w) / (2.0 * q)
    a0 = 1.0 + alpha / amplitude
    return np.array(
        [[
            (1.0 + alpha * amplitude) / a0, -2.0 * math.cos(w) / a0, (1.0 - alpha * amplitude) / a0,
            1.0, -2.0 * math.cos(w) / a0, (1.0 - alpha / amplitude) / a0,
        ]]
    )
