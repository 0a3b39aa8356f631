"""Passes of a pen over a place, rendered by the engine's command line."""

from __future__ import annotations

import json
import math
import tempfile
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from haptoflow_benchmark.engine.engine_render import FULL_SCALE_MPS2, rendered_samples, write_rows

Doubles = NDArray[np.float64]

_STROKE_STEP_SECONDS = 0.004
_DEPTH_METRES = 0.0005


@dataclass(frozen=True)
class Table:
    """A plane of one label. Its place and turn about the vertical must not matter to what a pass over it feels."""

    label: str
    name: str = "table"
    position_metres: tuple[float, float, float] = (0.0, 0.0, 0.0)
    turn_degrees: float = 0.0

    def scene(self, update_rate_hz: float) -> dict[str, object]:
        half = math.radians(0.5 * self.turn_degrees)
        surface = {
            "name": self.name, "shape": {"plane": {}}, "position": list(self.position_metres),
            "rotation": [0.0, math.sin(half), 0.0, math.cos(half)], "material": self.label,
        }  # fmt: skip
        return {"surfaces": [surface], "stylus": {"tip_radius": 0.001}, "update_rate": update_rate_hz}

    def to_world(self, along: Doubles, beside: Doubles) -> Doubles:
        """Points [n, 3] of the tip over the table's own coordinates."""
        angle = math.radians(self.turn_degrees)
        x, z = along * math.cos(angle) + beside * math.sin(angle), beside * math.cos(angle) - along * math.sin(angle)
        return np.stack([x, np.full_like(x, _DEPTH_METRES), z], axis=1) + np.asarray(self.position_metres)


@dataclass(frozen=True)
class Pass:
    """A straight stroke at 1 N from one place to another, `beside_metres` beside the line."""

    start_metres: float = -0.01
    end_metres: float = 0.065
    speed_mps: float = 0.1
    beside_metres: float = 0.0

    @property
    def direction(self) -> float:
        return math.copysign(1.0, self.end_metres - self.start_metres)

    def points(self) -> tuple[Doubles, Doubles, Doubles]:
        """Times, and places along and beside the line, [n] each."""
        seconds = abs(self.end_metres - self.start_metres) / self.speed_mps
        times = np.arange(0.0, seconds, _STROKE_STEP_SECONDS)
        along = self.start_metres + self.direction * self.speed_mps * times
        return times, along, np.full_like(along, self.beside_metres)

    def begun_earlier(self, metres: float) -> Pass:
        return replace(self, start_metres=self.start_metres - self.direction * metres)


@dataclass(frozen=True)
class Rounds:
    """Two rounds of a circle at 1 N."""

    radius_metres: float = 0.015
    speed_mps: float = 0.1

    @property
    def round_seconds(self) -> float:
        return 2.0 * math.pi * self.radius_metres / self.speed_mps

    def points(self) -> tuple[Doubles, Doubles, Doubles]:
        times = np.arange(0.0, 2.0 * self.round_seconds + 0.1, _STROKE_STEP_SECONDS)
        angle = times * self.speed_mps / self.radius_metres
        return times, self.radius_metres * np.cos(angle), self.radius_metres * np.sin(angle)


class Stroke(Protocol):
    """A stroke over a table: times [n] from 0 on, and places along and beside the line, [n] each."""

    def points(self) -> tuple[Doubles, Doubles, Doubles]: ...


@dataclass(frozen=True)
class Renderer:
    """Renders strokes with one engine. Threads may share it."""

    engine: Path
    model: Path
    update_rate_hz: float = 90.0

    def wave(self, table: Table, stroke: Stroke, seed: int = 1) -> Doubles:
        """The vibration [n] in m/s^2 at 2 kHz, from the stroke's first moment on."""
        times, along, beside = stroke.points()
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            scene, csv, wav = folder / "scene.json", folder / "stroke.csv", folder / "out.wav"
            scene.write_text(json.dumps(table.scene(self.update_rate_hz)), encoding="utf-8")
            columns = np.column_stack([times, table.to_world(along, beside), np.ones_like(times)])
            write_rows(csv, columns)
            return rendered_samples(self.engine, scene, csv, wav, model=self.model, seed=seed) * FULL_SCALE_MPS2
