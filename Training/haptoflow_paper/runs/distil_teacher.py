"""The model that is distilled: one tier of a model file, in the engine."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from haptoflow_benchmark.engine_library import EngineLibrary
from haptoflow_paper.rows.engine_generator import SOLVED_KINDS, EngineGenerator
from haptoflow_training.errors import InputError
from haptoflow_training.export.model_file import read_model_file
from haptoflow_training.recordings.recording import RecordingIdentity
from haptoflow_training.recordings.synthetic.carriers import guided_ride, hand_ride
from haptoflow_training.recordings.synthetic.contact import SIMULATION_RATE_HZ
from haptoflow_training.waveform import SAMPLE_RATE_HZ

STROKE_SECONDS = 8.0
# Of ten strokes, as in the shipped model's recipe: passes for the pitch of ribs, holds for levels, hands for changes.
_KINDS = ("guided", "pass", "guided", "hand", "guided", "pass", "guided", "guided", "pass", "guided")
# Slower tips count as resting; the logarithm of a speed has to begin somewhere.
_SLOWEST_MPS, _LIGHTEST_NEWTONS = 0.01, 0.15
# Additive recurrences of irrational steps cover speeds, forces and directions evenly, however many strokes there are.
_STEPS = (0.7548776662466927, 0.5698402909980532, 0.6180339887498949)
# Holds last from .6 to 3.3 times the median, hands from rest to twice: a median within these of the range's ends.
_HOLD_MARGINS = (1.7, 3.0)

_Floats = NDArray[np.float32]


@dataclass(frozen=True)
class MotionRange:
    """Speeds in m/s and forces in N that a model was trained on."""

    speed_mps: tuple[float, float]
    force_newtons: tuple[float, float]

    @property
    def includes_rest(self) -> bool:
        return self.speed_mps[0] < _SLOWEST_MPS


@dataclass(frozen=True)
class Stroke:
    """motion [n, 3]: vx, vy in m/s, force in N, at 2 kHz."""

    identity: RecordingIdentity
    kind: str
    motion: _Floats


def strokes_of(label: int, count: int, within: MotionRange, seed: int) -> Iterator[Stroke]:
    """`count` strokes on one label; the first ones of more strokes are the same."""
    start = np.random.default_rng([seed, label, 5]).random(len(_STEPS))
    for number in range(count):
        speed_at, force_at, direction_at = (start + np.multiply(number, _STEPS)) % 1.0
        kind = _KINDS[number % len(_KINDS)]
        low, high = max(within.speed_mps[0], _SLOWEST_MPS), within.speed_mps[1]
        light, heavy = max(within.force_newtons[0], _LIGHTEST_NEWTONS), within.force_newtons[1]
        force = _between(light, heavy, force_at)
        direction = 360.0 * direction_at
        rng = np.random.default_rng([seed, label, number])
        if kind == "pass":
            speed = _between(low, high, speed_at)
            motion = _pass(speed, force, direction)
        else:
            shrink = min(1.0, math.sqrt(high / low) / math.sqrt(math.prod(_HOLD_MARGINS)))
            speed = _between(low * _HOLD_MARGINS[0] ** shrink, high / _HOLD_MARGINS[1] ** shrink, speed_at)
            ride = (guided_ride if kind == "guided" else hand_ride)(
                rng, duration_seconds=STROKE_SECONDS, median_speed_mmps=1e3 * speed, median_force_newtons=force
            )
            stride = int(SIMULATION_RATE_HZ) // SAMPLE_RATE_HZ
            motion = np.column_stack([1e-3 * ride.path.velocity_mmps, ride.force_newtons])[::stride]
        yield Stroke(
            _identity(label, kind, number, speed, force, direction), kind, _inside(motion, within).astype(np.float32)
        )


def _between(low: float, high: float, share: float) -> float:
    return float(low * (max(high, low) / low) ** share)


def _pass(speed: float, force: float, degrees: float) -> NDArray[np.float64]:
    angle = math.radians(degrees)
    held = [speed * math.cos(angle), speed * math.sin(angle), force]
    return np.tile(held, (round(STROKE_SECONDS * SAMPLE_RATE_HZ), 1))


def _inside(motion: NDArray[np.float64], within: MotionRange) -> NDArray[np.float64]:
    """The motion with its speed brought into the range, in its own direction, and its force too. A tip at rest moves
    on in the direction that it had, where the range has no rest."""
    speed = np.hypot(motion[:, 0], motion[:, 1])
    kept = np.clip(speed, 0.0 if within.includes_rest else within.speed_mps[0], within.speed_mps[1])
    moving = np.maximum.accumulate(np.where(speed > 1e-6, np.arange(len(speed)), -1))
    moving[moving < 0] = int(np.argmax(speed > 1e-6))
    heading = motion[moving, :2] / np.maximum(speed[moving], 1e-6)[:, None]
    return np.column_stack([kept[:, None] * heading, np.clip(motion[:, 2], *within.force_newtons)])


def _identity(label: int, kind: str, number: int, speed: float, force: float, degrees: float) -> RecordingIdentity:
    direction = round(degrees) % 360 if kind == "pass" else None
    return RecordingIdentity(label, direction, round(1e3 * speed), round(1e3 * force), number)


@dataclass(frozen=True)
class TaughtLabel:
    """name, category, spring in N/m and kinetic friction; index: among the labels of the file. others: further labels of the
    file that have the same embedding, under names and with springs of their own."""

    name: str
    index: int
    category: str
    stiffness_newtons_per_metre: float
    friction_coefficient: float
    others: tuple[dict[str, Any], ...] = field(default=(), hash=False)


@dataclass(frozen=True)
class Teacher:
    """solver: of SOLVERS; steps: 0 for the tier's own."""

    model: Path
    tier: str
    solver: str
    steps: int
    labels: tuple[TaughtLabel, ...]
    within: MotionRange
    name: str
    licence: str
    statement: str
    level_is_assumed: bool

    @classmethod
    def of_file(
        cls, model: Path, tier: str | None, solver: str, steps: int, labels: tuple[str, ...] = ()
    ) -> Teacher:
        """The file's default tier, or `tier`; labels: only these. InputError if there is no such tier or label."""
        header = read_model_file(model).header
        names = [entry["name"] for entry in header["tiers"]]
        chosen = tier or header["default_tier"]
        if chosen not in names:
            raise InputError(f"{model}: no tier '{chosen}'; it has {', '.join(names)}")
        kind = next(entry["kind"] for entry in header["tiers"] if entry["name"] == chosen)
        if steps and kind not in SOLVED_KINDS:
            raise InputError(f"{model}: tier '{chosen}' is not solved in steps; leave out --steps")
        known = _labels(header["labels"])
        names_of = {label.name: {label.name, *(str(other["name"]) for other in label.others)} for label in known}
        missing = set(labels).difference(*names_of.values())
        if missing:
            listed = ", ".join(name for label in known for name in sorted(names_of[label.name]))
            raise InputError(f"{model}: no label {', '.join(sorted(missing))}; it has {listed}")
        kept = tuple(label for label in known if not labels or names_of[label.name] & set(labels))
        provenance = header["provenance"]
        return cls(
            model, chosen, solver, steps, kept,
            MotionRange(tuple(header["range"]["speed_mps"]), tuple(header["range"]["force_newtons"])),
            header["name"], provenance["licence"], provenance["statement"],
            bool(header["normalisation"].get("assumed", False)),
        )  # fmt: skip

    @property
    def solved_words(self) -> str:
        """The tier, and how it is solved where that is not its own way."""
        steps = f", {self.steps} {self.solver} step{'' if self.steps == 1 else 's'}" if self.steps else ""
        return f"{self.tier}{steps}"

    @property
    def origin(self) -> str:
        """Where the recordings come from, as the distilled file states it."""
        return f"recordings generated by {self.name} ({self.solved_words}), which was {self.statement}"

    def open(self, engine: EngineLibrary, batch: int) -> EngineGenerator:
        return EngineGenerator(engine, self.model, self.tier, self.solver, self.steps, maximum_batch=batch)


def checked_solver(solver: str, steps: int) -> tuple[str, int]:
    """Solver and steps of the command line; InputError if only one of them is stated."""
    if (solver == "tier") != (steps == 0):
        raise InputError("--solver and --steps go together; leave out both for the tier's own")
    return solver, steps


def _labels(entries: list[dict[str, Any]]) -> list[TaughtLabel]:
    """One label for each embedding, the first that has it."""
    by_row: dict[int, list[tuple[int, dict[str, Any]]]] = {}
    for index, entry in enumerate(entries):
        by_row.setdefault(entry["embedding_row"], []).append((index, entry))
    return [
        TaughtLabel(
            first["name"], index, first["category"], first["stiffness_newtons_per_metre"], first["friction_coefficient"],
            tuple(other for _, other in others),
        )
        for (index, first), *others in by_row.values()
    ]  # fmt: skip
