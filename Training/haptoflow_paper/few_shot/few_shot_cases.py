"""Held-out materials of the few-shot study: recordings to fit, and reference recordings of other motions."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from haptoflow_paper.few_shot.filtered_surfaces import FilteredSurface
from haptoflow_benchmark.few_shot.unseen import RIDE_SECONDS, make_rides, unseen_materials
from haptoflow_paper.metrics.temporal_metrics import rib_rates_hz
from haptoflow_training.preprocessing.pipeline import preprocess_recording
from haptoflow_training.preprocessing.settings import PreprocessingSettings
from haptoflow_training.recordings.material_recording import MaterialRecording
from haptoflow_training.recordings.synthetic import Material, load_materials, record_condition
from haptoflow_training.recordings.synthetic.specimens import HELD_OUT_SPECIMEN, TRAINING_SPECIMENS
from haptoflow_training.waveform import SAMPLE_RATE_HZ

SECONDS = (5.0, 10.0, 20.0, 60.0)
_MINIMUM_RIDE_SECONDS = 1.5
# Speeds between those of every protocol; forces and directions cover their ranges.
_CONDITIONS = ((0.02, 0.5, 20.0), (0.034, 1.35, 110.0), (0.056, 0.9, 200.0), (0.085, 0.6, 300.0), (0.13, 1.8, 65.0),
               (0.18, 1.1, 160.0))  # fmt: skip
_CONDITION_SECONDS = 6.0
_RULED_STEP_DEGREES = 35.0


@dataclass(frozen=True)
class FewShotCondition:
    """motion [n, 3] in the recorder's frame; recorded and other_draw [n] in m/s^2: of the held-out specimen, and of
    a specimen that was fitted."""

    speed_mps: float
    force_newtons: float
    direction_degrees: float
    rib_rates_hz: tuple[float, ...]
    motion: NDArray[np.float32]
    recorded: NDArray[np.float32]
    other_draw: NDArray[np.float32]


@dataclass(frozen=True)
class FewShotCase:
    """rides: 5 s each, used in order."""

    material: Material | FilteredSurface
    rides: tuple[MaterialRecording, ...]
    conditions: tuple[FewShotCondition, ...]

    def recordings(self, seconds: float) -> list[MaterialRecording]:
        """The first seconds: whole rides, or a part of each of the first two."""
        if seconds < 2.0 * RIDE_SECONDS:
            return [_cut(ride, max(_MINIMUM_RIDE_SECONDS, seconds / 2.0)) for ride in self.rides[:2]]
        return [_cut(ride, RIDE_SECONDS) for ride in self.rides[: round(seconds / RIDE_SECONDS)]]


def study_materials(count: int, seed: int) -> tuple[Material, ...]:
    return unseen_materials(load_materials(), count, seed)


def make_filtered_case(surface: FilteredSurface, seed: int, longest_seconds: float = SECONDS[-1]) -> FewShotCase:
    """The case of a surface in the published form, stroked as a material of the recorder is."""
    number = int(surface.label.rsplit("-", 1)[1])
    (plain,) = study_materials(1, seed + number)
    case = make_case(plain, seed, longest_seconds)
    rides = tuple(
        replace(
            ride,
            label=surface.label,
            vibration_mps2=surface.wave(
                np.column_stack([ride.velocity_mps, ride.force_newtons]), 1000 * seed + 100 * number + place
            ),
        )
        for place, ride in enumerate(case.rides)
    )
    conditions = tuple(
        replace(
            condition,
            recorded=surface.wave(condition.motion, 1000 * seed + 100 * number + 50 + place),
            other_draw=surface.wave(condition.motion, 1000 * seed + 100 * number + 70 + place),
        )
        for place, condition in enumerate(case.conditions)
    )
    return FewShotCase(surface, rides, conditions)


def make_case(material: Material, seed: int, longest_seconds: float = SECONDS[-1]) -> FewShotCase:
    """The case of a material; deterministic by material and seed.

    All pieces are typical: how pieces differ says nothing about a learner, who gets one of them.
    """
    material = material.without_spread
    rides = make_rides(material, seed, max(2, round(longest_seconds / RIDE_SECONDS)))
    settings = PreprocessingSettings()
    return FewShotCase(
        material,
        rides,
        tuple(_condition(material, number, seed, settings) for number in range(len(_CONDITIONS))),
    )


def _condition(material: Material, number: int, seed: int, settings: PreprocessingSettings) -> FewShotCondition:
    speed, force, direction = _CONDITIONS[number]
    if material.rulings:
        # Across the ribs, at most 35 degrees off.
        across = max(material.rulings, key=lambda ruling: ruling.relative_height).direction_degrees
        direction = across + _RULED_STEP_DEGREES * (number % 3 - 1) + 180.0 * (number % 2)
    angle = math.radians(direction)
    velocity = speed * math.cos(angle), speed * math.sin(angle)
    pieces = [
        preprocess_recording(
            record_condition(
                material,
                velocity_mps=velocity,
                force_newtons=force,
                duration_seconds=_CONDITION_SECONDS + 2.0 * settings.trim_seconds,
                seed=seed + 900 + number,
                specimen=specimen,
            ),
            settings,
        )
        for specimen in (HELD_OUT_SPECIMEN, TRAINING_SPECIMENS[0])
    ]
    return FewShotCondition(
        speed,
        force,
        direction % 360.0,
        rib_rates_hz(material, speed, direction),
        pieces[0].motion,
        pieces[0].waveform_mps2,
        pieces[1].waveform_mps2,
    )


def _cut(recording: MaterialRecording, seconds: float) -> MaterialRecording:
    count = round(SAMPLE_RATE_HZ * seconds)
    return MaterialRecording(
        recording.name,
        recording.label,
        recording.vibration_mps2[:count],
        recording.velocity_mps[:count],
        recording.force_newtons[:count],
        recording.licence,
        recording.source,
    )
