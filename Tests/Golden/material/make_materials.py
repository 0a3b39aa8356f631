"""Writes material files and what a reader must make of them: *.haptomaterial, expected.json, invalid.json.

Run from the repository root: PYTHONPATH=Training python3 Tests/Golden/material/make_materials.py
"""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from haptoflow_training.export.level_table import LevelTable
from haptoflow_training.export.model_file import ModelFile, model_space, read_model_file

KERNEL_SAMPLES, RESPONSE_SAMPLES, RATE_HZ = 64, 256, 2000.0
_Doubles = NDArray[np.float64]

HERE = Path(__file__).parent
TINY = HERE.parent / "model" / "tiny.haptoflow"
DEFAULT = HERE.parents[2] / "Packages" / "com.haptoflow.runtime" / "Runtime" / "Models" / "default.haptoflow"
SPEEDS_MPS = (0.0, 0.005, 0.02, 0.03, 0.06, 0.1, 0.16, 0.3, 1.0)
FORCES_NEWTONS = (0.0, 0.02, 0.5, 1.0, 2.5)
PROVENANCE = {"statement": "made up for the tests", "recordings": "none", "licence": "MIT", "seconds": 12.5,
              "created": "2026-11-23"}  # fmt: skip
NO_PROVENANCE = {"statement": "", "recordings": "", "licence": "unknown", "seconds": 0.0, "created": ""}


@dataclass(frozen=True)
class ToneTable:
    """Gains in dB: `gains_db` has a row for each of the ascending `speeds_mps`, with a value for each of the
    ascending `frequencies_hz`."""

    speeds_mps: tuple[float, ...]
    frequencies_hz: tuple[float, ...]
    gains_db: tuple[tuple[float, ...], ...]

    def gain_db(self, speed_mps: float, frequency_hz: ArrayLike) -> _Doubles:
        """Gains at one speed (m/s) and any frequencies (Hz): linear in log speed and log frequency, constant beyond
        the ends."""
        rows = np.asarray(self.gains_db)
        known = np.log(self.speeds_mps)
        place = float(np.clip(math.log(max(speed_mps, 1e-9)), known[0], known[-1]))
        row = np.array([np.interp(place, known, column) for column in rows.T])
        low, high = self.frequencies_hz[0], self.frequencies_hz[-1]
        wanted = np.log(np.clip(np.asarray(frequency_hz, dtype=np.float64), low, high))
        return np.asarray(np.interp(wanted, np.log(self.frequencies_hz), row))

    def kernel(self, speed_mps: float) -> _Doubles:
        """[64]: the minimum-phase filter at 2 kHz that is applied at this speed."""
        frequency = np.arange(RESPONSE_SAMPLES // 2 + 1) * (RATE_HZ / RESPONSE_SAMPLES)
        return minimum_phase(self.gain_db(speed_mps, frequency))

    def to_json(self) -> dict[str, Any]:
        return {
            "speeds_mps": list(self.speeds_mps),
            "frequencies_hz": list(self.frequencies_hz),
            "gains_db": [list(row) for row in self.gains_db],
        }


def minimum_phase(gain_db: _Doubles) -> _Doubles:
    """The first 64 samples of the minimum-phase impulse response whose gains in dB at 129 frequencies from 0 to 1000 Hz
    are given.

    Computed by the real cepstrum: folding its negative times onto the positive ones keeps the magnitude and makes the
    phase minimal. (SciPy's `minimum_phase` takes a filter, not a magnitude response, before version 1.14.)
    """
    logarithm = np.asarray(gain_db, dtype=np.float64) * (math.log(10.0) / 20.0)
    cepstrum = np.fft.irfft(logarithm, RESPONSE_SAMPLES)
    half = RESPONSE_SAMPLES // 2
    cepstrum[1:half] *= 2.0
    cepstrum[half + 1 :] = 0.0
    response = np.fft.irfft(np.exp(np.fft.rfft(cepstrum)), RESPONSE_SAMPLES)
    return np.asarray(response[:KERNEL_SAMPLES])


LEVEL = (0.02, 0.06, 0.08, 0.2), (-0.9, -0.2, 1.4, 1.9), 1.2, 0.35
TONE = ToneTable(
    (0.03, 0.1, 0.3),
    (20.0, 63.0, 125.0, 250.0, 500.0, 900.0),
    (
        (6.0, 3.0, 0.0, -4.0, -9.0, -12.0),
        (2.0, -1.0, 4.0, -3.0, 1.0, -6.0),
        (-8.0, -2.0, 0.0, 5.0, 8.0, 3.0),
    ),
)


def seed(velocity_mps: list[float], force_newtons: float, number: int, ribs: bool) -> dict[str, Any]:
    """Three sines and a little noise, so that a reader which mixes seeds up is found out."""
    time = np.arange(400) / RATE_HZ
    wave = sum(np.sin(2.0 * np.pi * hertz * time + number) for hertz in (40.0 + 20.0 * number, 150.0, 310.0))
    wave = wave + 0.2 * np.random.default_rng(number).standard_normal(400)
    samples = (wave / np.sqrt(np.square(wave).mean())).astype(np.float32)
    return {
        "velocity_mps": velocity_mps,
        "force_newtons": force_newtons,
        **({"rib_phase": [0.25, 0.0]} if ribs else {}),
        "samples": [round(float(value), 4) for value in samples],
    }


def material(
    model: ModelFile, name: str, embedding: NDArray[np.float32], speeds: list[float], forces: list[float], **keys: Any
) -> dict[str, Any]:
    """A material file's content; `keys` beyond the mandatory ones are written as given, in the order of a label's."""
    periodic = keys.get("wavelength_metres") is not None
    label = {
        "name": name,
        "category": "test",
        "frequency_exponent": 0.0,
        "periodic": periodic,
        "wavelength_metres": None,
        "stiffness_newtons_per_metre": 1000.0,
        "friction_coefficient": 0.3,
    }
    order = ("name", "category", "level_exponents", "frequency_exponent", "periodic", "wavelength_metres",
             "stiffness_newtons_per_metre", "friction_coefficient", "impact", "level", "tone", "level_offset_db")  # fmt: skip
    label |= {key: value for key, value in keys.items() if key in order}
    return {
        "format": "haptoflow-material",
        "version": 1,
        "space": model_space(model),
        "description": keys.get("description", ""),
        "provenance": keys.get("provenance", NO_PROVENANCE),
        "embedding": [float(value) for value in embedding],
        "range": {"speed_mps": speeds, "force_newtons": forces},
        **{key: label[key] for key in order if key in label},
        **({"seeds": keys["seeds"]} if keys.get("seeds") else {}),
    }


def materials(tiny: ModelFile, default: ModelFile) -> dict[str, dict[str, Any]]:
    """plain-twin says no more than the label `plain` of the tiny model; ribbed says everything that can be said; denim
    is for the default model, between its cotton and its jute."""
    ribbed = tiny.tensors["embedding"][0] + np.float32(0.125)
    ribbed[-4:] = (0.8, 0.0, 0.0, 0.5)
    names = [label["name"] for label in default.header["labels"]]
    cotton, jute = (default.tensors["embedding"][names.index(name)] for name in ("cotton", "jute"))
    denim = (0.6 * cotton + 0.4 * jute).astype(np.float32)
    denim[-4:] = 0.0
    tables = {"level": LevelTable(*LEVEL, 0.0).to_json(), "tone": TONE.to_json()}
    return {
        "plain-twin": material(
            tiny, "plain twin", tiny.tensors["embedding"][0], [0.0, 0.5], [0.0, 5.0],
            level_exponents={"speed": 0.5, "force": 0.25}, frequency_exponent=0.5, stiffness_newtons_per_metre=600.0,
        ),
        "ribbed": material(
            tiny, "ribbed", ribbed, [0.02, 0.2], [0.3, 2.0],
            description="A material of the tests, with every key.", provenance=PROVENANCE,
            level_exponents={"speed": 0.8, "force": 0.3}, frequency_exponent=1.0, wavelength_metres=0.00125,
            stiffness_newtons_per_metre=450.0, friction_coefficient=0.55,
            impact={"modes": [{"frequency_hz": 120.0, "decay_per_second": 90.0, "gain_per_second": 80.0}],
                    "restitution": 0.1},
            **tables, level_offset_db=-1.5,
            seeds=[seed([0.05, 0.0], 1.0, 1, True), seed([0.0, 0.15], 1.5, 2, True)],
        ),
        "denim": material(
            default, "denim", denim, [0.02, 0.18], [0.4, 2.0], category="cloth", provenance=PROVENANCE,
            level_exponents={"speed": 0.9, "force": 0.2}, frequency_exponent=0.2, friction_coefficient=0.5,
            **tables, seeds=[seed([0.08, 0.0], 1.0, 3, False)] if "seed_bank" in default.header else [],
        ),
    }  # fmt: skip


def expected(content: dict[str, Any]) -> dict[str, Any]:
    """Levels (natural logarithm of the RMS in m/s^2, `level_offset_db` included) where the material has its own, and
    the kernels of its tone."""
    answer: dict[str, Any] = {"name": content["name"], "space": content["space"]}
    if "level" in content:
        level = LevelTable(*LEVEL, content["level_exponents"]["speed"])
        offset = content.get("level_offset_db", 0.0) * np.log(10.0) / 20.0
        answer["levels"] = [
            {"speed_mps": speed, "force_newtons": force, "log_level": float(level.log_level(speed, force) + offset)}
            for speed in SPEEDS_MPS
            for force in FORCES_NEWTONS
        ]
    if "tone" in content:
        answer["kernels"] = [
            {
                "speed_mps": speed,
                "at_table_speed": not TONE.speeds_mps[0] < speed < TONE.speeds_mps[-1] or speed in TONE.speeds_mps,
                "taps": [float(value) for value in TONE.kernel(speed)],
            }
            for speed in sorted({*SPEEDS_MPS, *TONE.speeds_mps})
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
    patch(
        "a mode without a decay",
        "impact.modes[0].decay_per_second",
        "/impact/modes/0/decay_per_second",
        None,
        "remove",
    ),
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
    for name, content in made.items():
        text = json.dumps(content, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
        (HERE / f"{name}.haptomaterial").write_text(text, encoding="utf-8")
    answers = {
        "spaces": {"tiny": model_space(tiny), "default": model_space(default)},
        "materials": {name: expected(content) for name, content in made.items()},
    }
    (HERE / "expected.json").write_text(json.dumps(answers, indent=1) + "\n", encoding="utf-8")
    cases = {"of": "ribbed.haptomaterial", "cases": INVALID}
    (HERE / "invalid.json").write_text(json.dumps(cases, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
