"""Writes material files and what a reader must make of them: *.haptomaterial, expected.json, invalid.json.

Run from the repository root: PYTHONPATH=Training python3 Tests/Golden/material/make_materials.py
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

from haptoflow_training.export.material_file import (
    Material,
    MaterialProvenance,
    MaterialSeed,
    model_space,
    write_material,
)
from haptoflow_training.export.material_sound import LevelTable, ToneTable
from haptoflow_training.export.model_file import ModelFile, read_model_file

HERE = Path(__file__).parent
TINY = HERE.parent / "model" / "tiny.haptoflow"
DEFAULT = HERE.parents[2] / "Packages" / "com.haptoflow.runtime" / "Runtime" / "Models" / "default.haptoflow"
SPEEDS_MPS = (0.0, 0.005, 0.02, 0.03, 0.06, 0.1, 0.16, 0.3, 1.0)
FORCES_NEWTONS = (0.0, 0.02, 0.5, 1.0, 2.5)
PROVENANCE = MaterialProvenance("made up for the tests", "none", "MIT", 12.5, "2026-11-23")

LEVEL = LevelTable((0.02, 0.06, 0.08, 0.2), (-0.9, -0.2, 1.4, 1.9), 1.2, 0.35)
TONE = ToneTable(
    (0.03, 0.1, 0.3),
    (20.0, 63.0, 125.0, 250.0, 500.0, 900.0),
    (
        (6.0, 3.0, 0.0, -4.0, -9.0, -12.0),
        (2.0, -1.0, 4.0, -3.0, 1.0, -6.0),
        (-8.0, -2.0, 0.0, 5.0, 8.0, 3.0),
    ),
)


def seed(velocity_mps: tuple[float, float], force_newtons: float, number: int, ribs: bool) -> MaterialSeed:
    """Three sines and a little noise, so that a reader which mixes seeds up is found out."""
    time = np.arange(400) / 2000.0
    wave = sum(np.sin(2.0 * np.pi * hertz * time + number) for hertz in (40.0 + 20.0 * number, 150.0, 310.0))
    wave = wave + 0.2 * np.random.default_rng(number).standard_normal(400)
    samples = (wave / np.sqrt(np.square(wave).mean())).astype(np.float32)
    return MaterialSeed(velocity_mps, force_newtons, samples, (0.25, 0.0) if ribs else None)


def materials(tiny: ModelFile, default: ModelFile) -> dict[str, Material]:
    """plain-twin says no more than the label `plain` of the tiny model; ribbed says everything that can be said; denim
    is for the default model, between its cotton and its jute."""
    ribbed = tiny.tensors["embedding"][0] + np.float32(0.125)
    ribbed[-4:] = (0.8, 0.0, 0.0, 0.5)
    names = [label["name"] for label in default.header["labels"]]
    cotton, jute = (default.tensors["embedding"][names.index(name)] for name in ("cotton", "jute"))
    denim = (0.6 * cotton + 0.4 * jute).astype(np.float32)
    denim[-4:] = 0.0
    wide = {"speed_range_mps": (0.0, 0.5), "force_range_newtons": (0.0, 5.0)}
    return {
        "plain-twin": Material(
            model_space(tiny), "plain twin", tiny.tensors["embedding"][0].copy(), **wide, category="test",
            speed_exponent=0.5, force_exponent=0.25, frequency_exponent=0.5, stiffness_newtons_per_metre=600.0,
        ),
        "ribbed": Material(
            model_space(tiny), "ribbed", ribbed, (0.02, 0.2), (0.3, 2.0), category="test",
            description="A material of the tests, with every key.", provenance=PROVENANCE,
            speed_exponent=0.8, force_exponent=0.3, frequency_exponent=1.0, wavelength_metres=0.00125,
            stiffness_newtons_per_metre=450.0, friction_coefficient=0.55,
            impact={"modes": [{"frequency_hz": 120.0, "decay_per_second": 90.0, "gain_per_second": 80.0}],
                    "restitution": 0.1},
            level=LEVEL, tone=TONE, level_offset_db=-1.5,
            seeds=(seed((0.05, 0.0), 1.0, 1, True), seed((0.0, 0.15), 1.5, 2, True)),
        ),
        "denim": Material(
            model_space(default), "denim", denim, (0.02, 0.18), (0.4, 2.0), category="cloth",
            provenance=PROVENANCE, speed_exponent=0.9, force_exponent=0.2, frequency_exponent=0.2,
            friction_coefficient=0.5, level=LEVEL, tone=TONE, seeds=(seed((0.08, 0.0), 1.0, 3, False),),
        ),
    }


def expected(material: Material) -> dict[str, Any]:
    """Levels (natural logarithm of the RMS in m/s^2, `level_offset_db` included) where the material has its own, and the
    kernels of its tone."""
    answer: dict[str, Any] = {"name": material.name, "space": material.space}
    if material.level is not None:
        offset = material.level_offset_db * np.log(10.0) / 20.0
        answer["levels"] = [
            {
                "speed_mps": speed,
                "force_newtons": force,
                "log_level": float(material.level.log_level(speed, force, material.speed_exponent) + offset),
            }
            for speed in SPEEDS_MPS
            for force in FORCES_NEWTONS
        ]
    if material.tone is not None:
        speeds = sorted({*SPEEDS_MPS, *material.tone.speeds_mps})
        answer["kernels"] = [
            {
                "speed_mps": speed,
                "at_table_speed": not material.tone.speeds_mps[0] < speed < material.tone.speeds_mps[-1]
                or speed in material.tone.speeds_mps,
                "taps": [float(value) for value in material.tone.kernel(speed)],
            }
            for speed in speeds
        ]
    return answer


def patch(name: str, key: str, path: str, value: Any, operation: str = "replace") -> dict[str, Any]:
    change = {"op": operation, "path": path} | ({} if operation == "remove" else {"value": value})
    return {"name": name, "key": key, "patch": [change]}


INVALID = [
    patch("not a material file", "format", "/format", "haptoflow"),
    patch("a newer version", "version", "/version", 2),
    patch("a version that is a text", "version", "/version", "1"),
    patch("a space in capitals", "space", "/space", "ABCDEF01"),
    patch("a space of seven digits", "space", "/space", "abcdef0"),
    patch("no name", "name", "/name", None, "remove"),
    patch("an empty name", "name", "/name", " "),
    patch("an embedding of 63 numbers", "embedding", "/embedding/63", None, "remove"),
    patch("an embedding that holds a text", "embedding", "/embedding/5", "0.1"),
    patch("an embedding beyond every range", "embedding", "/embedding/5", 1e30),
    patch("a range that falls", "range.speed_mps", "/range/speed_mps", [0.2, 0.02]),
    patch("no exponents", "level_exponents", "/level_exponents", None, "remove"),
    patch("a periodic material without a wavelength", "periodic", "/wavelength_metres", None),
    patch("no stiffness at all", "stiffness_newtons_per_metre", "/stiffness_newtons_per_metre", 0.0),
    patch("an impact of three modes", "impact.modes", "/impact/modes", [{}, {}, {}]),
    patch("a mode without a decay", "impact.modes[0].decay_per_second", "/impact/modes/0/decay_per_second", None, "remove"),
    patch("speeds of the level that repeat", "level.speeds_mps", "/level/speeds_mps/1", 0.02),
    patch("a level for three of four speeds", "level.log_levels", "/level/log_levels/3", None, "remove"),
    patch("a level at no force", "level.force_newtons", "/level/force_newtons", 0.0),
    patch("a force exponent beyond 4", "level.force_exponent", "/level/force_exponent", 4.5),
    patch("a tone at speed 0", "tone.speeds_mps", "/tone/speeds_mps/0", 0.0),
    patch("a tone with one frequency", "tone.frequencies_hz", "/tone/frequencies_hz", [100.0]),
    patch("a tone below 10 Hz", "tone.frequencies_hz", "/tone/frequencies_hz/0", 5.0),
    patch("a tone with a row too few", "tone.gains_db", "/tone/gains_db/2", None, "remove"),
    patch("a tone of more than 30 dB", "tone.gains_db", "/tone/gains_db/1/1", 31.0),
    patch("an offset of more than 24 dB", "level_offset_db", "/level_offset_db", 25.0),
    patch("17 seeds", "seeds", "/seeds", [{}] * 17),
    patch("a seed of 399 samples", "seeds[1].samples", "/seeds/1/samples/399", None, "remove"),
    patch("a seed of twice the RMS", "seeds[0].samples", "/seeds/0/samples/7", 40.0),
    patch("a rib phase beyond a turn", "seeds[0].rib_phase", "/seeds/0/rib_phase/0", 1.5),
]


def main() -> None:
    tiny, default = read_model_file(TINY), read_model_file(DEFAULT)
    made = materials(tiny, default)
    for name, material in made.items():
        write_material(HERE / f"{name}.haptomaterial", material)
    answers = {
        "spaces": {"tiny": model_space(tiny), "default": model_space(default)},
        "materials": {name: expected(material) for name, material in made.items()},
    }
    (HERE / "expected.json").write_text(json.dumps(answers, indent=1) + "\n", encoding="utf-8")
    cases = {"of": "ribbed.haptomaterial", "cases": INVALID}
    (HERE / "invalid.json").write_text(json.dumps(cases, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
