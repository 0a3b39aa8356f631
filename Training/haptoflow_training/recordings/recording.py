"""One recording of a stylus on a surface, the common form of all readers and recorders."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

Protocol = Literal["machine", "hand"]

STANDARD_GRAVITY_MPS2 = 9.80665

_NAME_PATTERN = re.compile(r"^(\d+)_(\d+|hand)_(\d+)_(\d+)_(\d+)$")


@dataclass(frozen=True, order=True)
class RecordingIdentity:
    """The parts of the name `<texture_id>_<direction>_<velocity>_<force>_<repeat>`.

    `direction_degrees` is clockwise (0, 45 ... 315) for the `machine` protocol and None for `hand`, whose names contain
    the word `hand` instead; `speed_mmps` and `force_millinewtons` are then the requested medians. file_name: of an own
    recording whose name has no such parts; otherwise empty.
    """

    texture_id: int
    direction_degrees: int | None
    speed_mmps: int
    force_millinewtons: int
    repeat: int
    file_name: str = ""

    @property
    def protocol(self) -> Protocol:
        return "hand" if self.direction_degrees is None else "machine"

    @property
    def name(self) -> str:
        if self.file_name:
            return self.file_name
        direction = "hand" if self.direction_degrees is None else str(self.direction_degrees)
        return f"{self.texture_id}_{direction}_{self.speed_mmps}_{self.force_millinewtons}_{self.repeat}"

    @classmethod
    def parse(cls, name: str) -> RecordingIdentity:
        """Read a file's stem; ValueError names what is wrong."""
        match = _NAME_PATTERN.match(name)
        if match is None:
            raise ValueError(
                f"'{name}' is not <texture_id>_<direction>_<velocity>_<force>_<repeat> (for example 0_135_40_500_0)"
            )
        texture, direction, speed, force, repeat = match.groups()
        return cls(
            int(texture), None if direction == "hand" else int(direction), int(speed), int(force), int(repeat)
        )


@dataclass(frozen=True)
class Wander:
    """Phases that do not follow from the position, known of synthetic recordings only.

    time_seconds: [j] float64, evenly spaced. turns: [j, 3] float64: for each of two families of ribs (in the order of
    the label's wave vectors) by how many turns the ribs under the tip lie ahead of evenly spaced ones; and the cycles of
    stick and slip since the recording began. Zero for what the label lacks.
    """

    time_seconds: NDArray[np.float64]
    turns: NDArray[np.float64]


@dataclass(frozen=True)
class Recording:
    """Three sensors with their own clocks; nothing resampled, nothing filtered.

    acceleration_time_seconds: [n] float64, increasing, irregular. acceleration_g: [n, 3] float, g, gravity on Z; or [n,
    1] for a single axis. force_time_seconds: [m] float64. force_newtons: [m] float. position_time_seconds: [k] float64.
    position_mm: [k, 2] float, millimetres, X and Y of the scan area. specimen: the piece of the material that a
    synthetic recording is of; None for files. velocity_mps: [k, 2] at position_time_seconds if velocity was recorded
    and the position is its integral; None if it is to be derived from the position. wander: None for files.
    has_sensor_noise: whether preparation is to find the accelerometer's noise and remove it. notes: what its reader
    ignored or corrected, one sentence each. is_generated: a model's output, one axis in the band; all clocks are then the
    same 2 kHz, and preparation filters and trims nothing.
    """

    identity: RecordingIdentity
    label: str
    acceleration_time_seconds: NDArray[np.float64]
    acceleration_g: NDArray[np.floating]
    force_time_seconds: NDArray[np.float64]
    force_newtons: NDArray[np.floating]
    position_time_seconds: NDArray[np.float64]
    position_mm: NDArray[np.floating]
    specimen: int | None = None
    velocity_mps: NDArray[np.floating] | None = None
    wander: Wander | None = None
    has_sensor_noise: bool = False
    notes: tuple[str, ...] = ()
    is_generated: bool = False

    @property
    def vibration_g(self) -> NDArray[np.float64]:
        """[n, axes]: the acceleration without its mean, and therefore without gravity."""
        acceleration = np.asarray(self.acceleration_g, dtype=np.float64)
        return acceleration - acceleration.mean(axis=0)

    @property
    def speeds_mmps(self) -> NDArray[np.float64]:
        """[k - 1]: speed from each position to the next, unsmoothed."""
        steps_mm = np.linalg.norm(np.diff(np.asarray(self.position_mm, dtype=np.float64), axis=0), axis=1)
        speeds: NDArray[np.float64] = steps_mm / np.maximum(np.diff(self.position_time_seconds), 1e-6)
        return speeds

    @property
    def duration_seconds(self) -> float:
        return float(self.acceleration_time_seconds[-1] - self.acceleration_time_seconds[0])
