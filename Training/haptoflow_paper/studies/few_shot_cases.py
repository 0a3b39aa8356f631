"""Held-out materials of the few-shot study: recordings to fit, and reference recordings of other motions."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_toeplitz
from scipy.signal import lfilter

from haptoflow_paper.studies.unseen_materials import RIDE_SECONDS, make_rides, unseen_materials
from haptoflow_paper.report.temporal_metrics import rib_rates_hz
from haptoflow_training.preprocessing.signals import zero_phase_high_pass
from haptoflow_training.preprocessing.pipeline import preprocess_recording
from haptoflow_training.preprocessing.settings import SETTINGS
from haptoflow_training.recordings.native_recording import MaterialRecording
from haptoflow_training.recordings.synthetic import Material, load_materials, record_condition
from haptoflow_training.recordings.synthetic.surface import HELD_OUT_SPECIMEN, TRAINING_SPECIMENS
from haptoflow_training.waveform import SAMPLE_RATE_HZ

ORDER = 20
HIGH_PASS_HZ = SETTINGS.high_pass_hz
_BLOCK_SAMPLES = 40
_BINS = 513
_COSINES = 10
# Deviations of the natural log amplitude: of the mean, of its change over ln speed and ln force, and of their product.
_MEAN, _SLOPE, _PRODUCT = 0.7, 0.3, 0.15
_MIDDLE_SPEED_MPS, _MIDDLE_FORCE_NEWTONS = 0.08, 0.9

_Doubles = NDArray[np.float64]


@dataclass(frozen=True)
class FilteredSurface:
    """A random texture without ribs or impacts.

    cosines: [4, 10] weights over a warped frequency: the mean, over ln speed, over ln force and over their product.
    level_exponents: of speed and force; bend: of the log level over the square of ln speed.
    """

    label: str
    cosines: _Doubles
    level_mps2: float
    level_exponents: tuple[float, float]
    bend: float
    # What surfaces of the recorder have and these lack.
    rulings: tuple[()] = field(default=())
    wave_vectors_per_mm: tuple[()] = field(default=())
    impact_strength: float = 0.0

    def wave(self, motion: NDArray[np.floating], seed: int) -> NDArray[np.float32]:
        """The vibration [n] in m/s^2 along a motion [n, 3] (vx, vy in m/s, force in N)."""
        settling = 1000
        motion = np.concatenate([np.repeat(motion[:1], settling, axis=0), motion]).astype(np.float64)
        noise = np.random.default_rng(seed).standard_normal(len(motion))
        out, state = np.empty(len(motion)), np.zeros(ORDER)
        for start in range(0, len(motion), _BLOCK_SAMPLES):
            part = slice(start, start + _BLOCK_SAMPLES)
            x, y = conditions(motion[part])
            predictor, drive = self.filter_at(float(x.mean()), float(y.mean()))
            out[part], state = lfilter([drive], np.concatenate([[1.0], predictor]), noise[part], zi=state)
        x, y = conditions(motion)
        # As recordings are: without gravity and slow drift.
        felt = zero_phase_high_pass((out * np.exp(self.log_level(x, y)))[settling:], HIGH_PASS_HZ, SAMPLE_RATE_HZ)
        return felt.astype(np.float32)

    def log_level(self, x: _Doubles, y: _Doubles) -> _Doubles:
        """Natural log of the RMS in m/s^2, before the high-pass, at a condition (see `conditions`)."""
        speed, force = self.level_exponents
        return np.asarray(np.log(self.level_mps2) + speed * x + force * y + self.bend * x**2)

    def filter_at(self, x: float, y: float) -> tuple[_Doubles, float]:
        """a_1 to a_20 of the filter at a condition, and the drive's RMS that gives a wave of RMS 1."""
        hertz = np.linspace(0.0, SAMPLE_RATE_HZ / 2.0, _BINS)
        warped = np.log1p(hertz / 120.0)
        turns = np.cos(np.pi * np.arange(_COSINES)[:, None] * warped / warped[-1])
        # A tool's vibrations are strongest near 140 Hz and fall off by some 20 dB to both ends of the band.
        tool = -0.5 * (np.log((hertz + 60.0) / 200.0) / 0.7) ** 2
        log_amplitude = tool + np.array([1.0, x, y, x * y]) @ self.cosines @ turns
        lags = np.fft.irfft(np.exp(2.0 * log_amplitude))[: ORDER + 1]
        lags /= lags[0]
        predictor = solve_toeplitz(lags[:-1], -lags[1:])
        return np.asarray(predictor), float(np.sqrt(1.0 + predictor @ lags[1:]))


def conditions(motion: NDArray[np.floating]) -> tuple[_Doubles, _Doubles]:
    """x = ln(speed / 80 mm/s) and y = ln(force / 0.9 N) of a motion [n, 3]."""
    speed = np.maximum(np.hypot(motion[:, 0], motion[:, 1]), 1e-3)
    return np.log(speed / _MIDDLE_SPEED_MPS), np.log(np.maximum(motion[:, 2], 0.02) / _MIDDLE_FORCE_NEWTONS)


def filtered_surfaces(count: int, seed: int) -> tuple[FilteredSurface, ...]:
    """`count` surfaces, named `filtered-01` on."""
    made = []
    for number in range(count):
        rng = np.random.default_rng([seed, 500 + number])
        spread = np.array([_MEAN, _SLOPE, _SLOPE, _PRODUCT])[:, None] / np.sqrt(1.0 + (np.arange(_COSINES) / 2.0) ** 2)
        weights = rng.standard_normal((4, _COSINES)) * spread
        made.append(
            FilteredSurface(
                f"filtered-{number + 1:02d}",
                weights,
                float(np.exp(rng.uniform(np.log(0.3), np.log(3.0)))),
                (float(rng.normal(0.9, 0.25)), float(rng.normal(0.3, 0.15))),
                float(rng.normal(0.0, 0.12)),
            )
        )
    return tuple(made)


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
        ride._replace(
            vibration_mps2=surface.wave(ride.motion, 1000 * seed + 100 * number + place),
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
    return FewShotCase(
        material,
        rides,
        tuple(_condition(material, number, seed) for number in range(len(_CONDITIONS))),
    )


def _condition(material: Material, number: int, seed: int) -> FewShotCondition:
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
                duration_seconds=_CONDITION_SECONDS + 2.0 * SETTINGS.trim_seconds,
                seed=seed + 900 + number,
                specimen=specimen,
            ),
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
    return MaterialRecording(recording.vibration_mps2[:count], recording.motion[:count])
