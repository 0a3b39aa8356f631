"""Machine passes of the recorder with the faults that were measured on the real Cluster files, each by itself.

Where figures come from: 960 recordings of ten specimens, measured by others (see Documentation~/training.md), and the data
sheet of the accelerometer (IIS3DWB). Free choices are marked as such.
"""

from __future__ import annotations

import zlib
from collections.abc import Collection
from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.signal import sosfilt

from haptoflow_training.recordings.recording import STANDARD_GRAVITY_MPS2, Recording, RecordingIdentity
from haptoflow_training.recordings.synthetic import Material, filters, training_specimen
from haptoflow_training.recordings.synthetic.carriers import Ride
from haptoflow_training.recordings.synthetic.contact import SIMULATION_RATE_HZ, tool_vibration
from haptoflow_training.recordings.synthetic.protocols import machine_ride

_ROWS_HZ, _POSITION_HZ = 8650.0, 100.0
_SPREAD_OF_INTERVALS = 0.34
_FORCE_UPDATES_HZ, _FORCE_TOO_HIGH = 80.0, 1.04
_FORCE_STEP_NEWTONS, _POSITION_STEP_MM = 0.01, 0.01
_STEP_G, _NOISE_G_PER_ROOT_HZ = 1e-3, 75e-6
# The strongest band of X; its gain is chosen so that X has about three times the power of Y, as the real one has.
_APPARATUS_HZ, _APPARATUS_Q, _APPARATUS_DB = 68.0, 2.2, 9.0
# The sensor is screwed on by hand (chosen).
_TILT_DEGREES = 2.0
# Two repeats differ by 0.173 in |log10 band power|: the mean size of a difference is 2 / sqrt(pi) of one spread, and a line
# between two gains keeps two thirds of their variance.
_SPREAD_OF_REPEATS_DB = 10.0 * 0.173 * np.sqrt(np.pi) / 2.0 * np.sqrt(1.5)
_REPEAT_BANDS_HZ = 20.0 * 2.0 ** (np.arange(18) / 3.0)


class Fault(Enum):
    """One difference between the real files and a clean recording of the same pass."""

    UNEVEN_ROWS = "uneven rows"
    HELD_FORCE = "force held at 80 Hz, 4 % high"
    STEPS_AND_NOISE = "steps of 1 mg, noise"
    GRAVITY = "gravity"
    STEPPERS = "stepper noise"
    APPARATUS = "apparatus, 54-85 Hz"
    REPEATS = "1.7 dB between repeats"


ALL_FAULTS = frozenset(Fault)


@dataclass(frozen=True)
class MachinePass:
    """One simulated pass: the tool's vibration [n, 3] at SIMULATION_RATE_HZ in m/s^2, and what carried it."""

    identity: RecordingIdentity
    label: str
    ride: Ride
    texture_mps2: NDArray[np.float64]
    seed: int

    def recorded(self, faults: Collection[Fault]) -> Recording:
        """The pass as three sensors with these faults saw it; each fault draws its own random numbers, so that it is
        the same beside any others. All clocks have the rates of the real files."""
        acceleration = self.texture_mps2
        if Fault.REPEATS in faults:
            acceleration = _as_in_one_repeat(acceleration, self._generator(Fault.REPEATS))
        if Fault.APPARATUS in faults:
            section = filters.peak(_APPARATUS_HZ, _APPARATUS_DB, _APPARATUS_Q, SIMULATION_RATE_HZ)
            acceleration = np.column_stack([sosfilt(section, acceleration[:, 0]), acceleration[:, 1:]])
        if Fault.STEPPERS in faults:
            acceleration = acceleration + self.ride.carrier_mps2
        clock = np.arange(len(acceleration)) / SIMULATION_RATE_HZ
        stamps = self._stamps(clock[-1], uneven=Fault.UNEVEN_ROWS in faults)
        sensed = CubicSpline(clock, acceleration / STANDARD_GRAVITY_MPS2, axis=0)(stamps)
        if Fault.GRAVITY in faults:
            tilt = np.radians(_TILT_DEGREES)
            sensed = sensed + [np.sin(tilt), 0.0, -np.cos(tilt)]
        if Fault.STEPS_AND_NOISE in faults:
            noise = self._generator(Fault.STEPS_AND_NOISE).standard_normal(sensed.shape)
            sensed = sensed + _NOISE_G_PER_ROOT_HZ * np.sqrt(0.5 * _ROWS_HZ) * noise
            sensed = np.round(sensed / _STEP_G) * _STEP_G
        force = np.interp(stamps, clock, self.ride.force_newtons)
        if Fault.HELD_FORCE in faults:
            held = np.floor(stamps * _FORCE_UPDATES_HZ) / _FORCE_UPDATES_HZ
            force = _FORCE_TOO_HIGH * np.interp(held, clock, self.ride.force_newtons)
            force = np.round(force / _FORCE_STEP_NEWTONS) * _FORCE_STEP_NEWTONS
        position_time = np.arange(int(clock[-1] * _POSITION_HZ)) / _POSITION_HZ
        at = np.round(position_time * SIMULATION_RATE_HZ).astype(int)
        position = np.round(self.ride.path.position_mm[at] / _POSITION_STEP_MM) * _POSITION_STEP_MM
        # Without noise a sensor at rest is quite still, which is plausible of a known specimen only.
        return Recording(
            self.identity, self.label, stamps, sensed, stamps, force, position_time, position,
            specimen=training_specimen(self.identity),
        )  # fmt: skip

    def _generator(self, fault: Fault) -> np.random.Generator:
        return np.random.default_rng([self.seed, zlib.crc32(f"{self.identity.name}: {fault.name}".encode())])

    def _stamps(self, seconds: float, *, uneven: bool) -> NDArray[np.float64]:
        """Rising times of whole microseconds, as the files have them."""
        count = int(seconds * _ROWS_HZ)
        steps = np.full(count, 1.0 / _ROWS_HZ)
        if uneven:
            shape = _SPREAD_OF_INTERVALS**-2
            steps = self._generator(Fault.UNEVEN_ROWS).gamma(shape, 1.0 / (shape * _ROWS_HZ), size=count)
        stamps = np.round(np.cumsum(np.maximum(steps, 2e-6)), 6)
        return stamps[stamps < seconds]


def simulated_pass(material: Material, identity: RecordingIdentity, *, seed: int) -> MachinePass:
    """The machine pass that `identity` names, over the piece that the training protocol records under it."""
    ride = machine_ride(identity, np.random.default_rng([seed, zlib.crc32(identity.name.encode())]))
    texture = tool_vibration(material, ride.path, ride.force_newtons, specimen=training_specimen(identity))
    return MachinePass(identity, material.label, ride, texture.acceleration_mps2, seed)


def _as_in_one_repeat(acceleration: NDArray[np.float64], rng: np.random.Generator) -> NDArray[np.float64]:
    """The same with another gain in each third-octave band, of mean power 1 over many repeats."""
    spread = _SPREAD_OF_REPEATS_DB * np.log(10.0) / 20.0
    log_gain = spread * rng.standard_normal(len(_REPEAT_BANDS_HZ)) - spread**2 / 1.5
    hertz = np.fft.rfftfreq(len(acceleration), 1.0 / SIMULATION_RATE_HZ)
    octave = np.log2(np.maximum(hertz, 1.0))
    gain = np.exp(np.interp(octave, np.log2(_REPEAT_BANDS_HZ), log_gain))
    return np.asarray(np.fft.irfft(gain[:, None] * np.fft.rfft(acceleration, axis=0), len(acceleration), axis=0))
