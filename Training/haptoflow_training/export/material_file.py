"""Material files (`NAME.haptomaterial`): one material beside an unchanged model file.

JSON of at most 1 MiB; Documentation~/own-materials.md, "The material file", is the specification. A material is a label
with its embedding, so it is valid only for models with the same embedding space.
"""

from __future__ import annotations

import json
import zlib
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.errors import InputError
from haptoflow_training.export.material_checks import Checked
from haptoflow_training.export.material_sound import (
    FORCE_EXPONENT_LIMIT,
    FORCE_RANGE_NEWTONS,
    LEVEL_OFFSET_LIMIT_DB,
    MAXIMUM_LEVEL_SPEEDS,
    MAXIMUM_TONE_FREQUENCIES,
    MAXIMUM_TONE_SPEEDS,
    TONE_FREQUENCY_RANGE_HZ,
    TONE_LIMIT_DB,
    LevelTable,
    ToneTable,
)
from haptoflow_training.export.model_file import ModelFile
from haptoflow_training.whole_file import write_whole

FORMAT, VERSION = "haptoflow-material", 1
SUFFIX = ".haptomaterial"
MAXIMUM_BYTES = 1 << 20
MAXIMUM_SEEDS = 16
SEED_SAMPLES = 400
EMBEDDING_SIZE = 64
UNKNOWN_LICENCE = "unknown"
# A label's own waveform is scaled to RMS 1; rounding to few decimals leaves it within this tolerance.
_SEED_RMS_TOLERANCE = 0.02


@dataclass(frozen=True)
class MaterialProvenance:
    """Where the recording comes from. seconds: how much of it was used; created: ISO date or empty."""

    statement: str = ""
    recordings: str = ""
    licence: str = UNKNOWN_LICENCE
    seconds: float = 0.0
    created: str = ""

    def to_json(self) -> dict[str, Any]:
        return dict(vars(self))


@dataclass(frozen=True)
class MaterialSeed:
    """samples [400] of RMS 1 before tone, recorded at velocity_mps and force_newtons; rib_phase: turns along each wave
    vector at sample 200."""

    velocity_mps: tuple[float, float]
    force_newtons: float
    samples: NDArray[np.float32]
    rib_phase: tuple[float, float] | None = None

    def to_json(self) -> dict[str, Any]:
        return {
            "velocity_mps": list(self.velocity_mps),
            "force_newtons": self.force_newtons,
            **({} if self.rib_phase is None else {"rib_phase": list(self.rib_phase)}),
            "samples": [round(float(value), 4) for value in self.samples],
        }


@dataclass(frozen=True)
class Material:
    """A material as its file states it. embedding [64]; the other fields as in a label of a model file."""

    space: str
    name: str
    embedding: NDArray[np.float32]
    speed_range_mps: tuple[float, float]
    force_range_newtons: tuple[float, float]
    category: str = ""
    description: str = ""
    provenance: MaterialProvenance = MaterialProvenance()
    speed_exponent: float = 0.0
    force_exponent: float = 0.0
    frequency_exponent: float = 0.0
    wavelength_metres: float | None = None
    stiffness_newtons_per_metre: float = 1000.0
    friction_coefficient: float = 0.3
    impact: dict[str, Any] | None = None
    level: LevelTable | None = None
    tone: ToneTable | None = None
    level_offset_db: float = 0.0
    seeds: tuple[MaterialSeed, ...] = field(default=())

    @property
    def periodic(self) -> bool:
        return self.wavelength_metres is not None

    def label_keys(self) -> dict[str, Any]:
        """The keys that a label of a model file and a material file have in common, `name` and `category` first."""
        return {
            "name": self.name,
            "category": self.category,
            "level_exponents": {"speed": self.speed_exponent, "force": self.force_exponent},
            "frequency_exponent": self.frequency_exponent,
            "periodic": self.periodic,
            "wavelength_metres": self.wavelength_metres,
            "stiffness_newtons_per_metre": self.stiffness_newtons_per_metre,
            "friction_coefficient": self.friction_coefficient,
            **({} if self.impact is None else {"impact": self.impact}),
            **({} if self.level is None else {"level": self.level.to_json()}),
            **({} if self.tone is None else {"tone": self.tone.to_json()}),
            **({} if self.level_offset_db == 0.0 else {"level_offset_db": self.level_offset_db}),
        }

    def to_json(self) -> dict[str, Any]:
        return {
            "format": FORMAT,
            "version": VERSION,
            "space": self.space,
            "description": self.description,
            "provenance": self.provenance.to_json(),
            "embedding": [float(value) for value in self.embedding],
            "range": {"speed_mps": list(self.speed_range_mps), "force_newtons": list(self.force_range_newtons)},
            **self.label_keys(),
            "seeds": [seed.to_json() for seed in self.seeds],
        }


def model_space(model: ModelFile) -> str:
    """Eight hex digits that identify the networks an embedding belongs to: the CRC-32 over each tier's name and the
    CRC-32 of its field graph, in the file's order."""
    text = "".join(
        f"{tier['name']}:{zlib.crc32(model.graphs[tier['field']]):08x};" for tier in model.header["tiers"]
    )
    return f"{zlib.crc32(text.encode('ascii')):08x}"


def encode_material(material: Material) -> str:
    """The file's text, in the form that was checked; ValueError if a number is not finite."""
    text = json.dumps(material.to_json(), ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    parse_material(text, material.name)
    return text


def write_material(path: Path, material: Material) -> None:
    """Write the file atomically. A full disk leaves the old file unchanged; InputError names the cause."""
    write_whole(path, encode_material(material).encode("utf-8"))


def read_material(path: Path, space: str | None = None) -> Material:
    """Read a material file; InputError names the file, the key and the expected value. space: the space of the model
    that will render the material, compared if given."""
    try:
        size = path.stat().st_size
        if size > MAXIMUM_BYTES:
            raise InputError(f"{path}: is {size} bytes long; a material file has at most {MAXIMUM_BYTES}")
        text = path.read_text(encoding="utf-8")
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror})") from error
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: is not UTF-8 text; expected a material file") from error
    material = parse_material(text, str(path))
    if space is not None and material.space != space:
        raise InputError(
            f"{path}: 'space' is {material.space}, the model's is {space}: it was learnt for another model; "
            "add the material to this model from its recording again"
        )
    return material


def parse_material(text: str, where: str) -> Material:
    """Parse the text of a material file; `where` begins every message."""
    if len(text.encode("utf-8")) > MAXIMUM_BYTES:
        raise InputError(f"{where}: is longer than {MAXIMUM_BYTES} bytes; a material file has at most that many")
    try:
        document = json.loads(text, parse_constant=lambda word: float("nan"))
    except (json.JSONDecodeError, RecursionError) as error:
        raise InputError(f"{where}: is not JSON ({error}); expected a material file") from error
    root = Checked(where, document)
    if not isinstance(document, dict) or document.get("format") != FORMAT:
        raise root.failure("format", f'"{FORMAT}"', "this is not a material file")
    version = root.integer("version")
    if version != VERSION:
        raise root.failure("version", str(VERSION), f"this reader does not know version {version}; update HaptoFlow")
    space = root.text("space")
    if len(space) != 8 or any(letter not in "0123456789abcdef" for letter in space):
        raise root.failure("space", "eight lower-case hexadecimal digits")
    if not root.text("name").strip():
        raise root.failure("name", "a name that is not empty")
    exponents = root.table("level_exponents")
    wavelength = root.number("wavelength_metres", 1e-6, 1.0, optional=True)
    if root.boolean("periodic") != (wavelength is not None):
        raise root.failure("periodic", "true exactly where 'wavelength_metres' is a number")
    seeds = root.rows("seeds", 0, MAXIMUM_SEEDS)
    provenance = root.table("provenance", optional=True)
    limits = root.table("range")
    return Material(
        space=space,
        name=root.text("name"),
        embedding=np.array(root.numbers("embedding", EMBEDDING_SIZE, EMBEDDING_SIZE), dtype=np.float32),
        speed_range_mps=_pair(limits.rising("speed_mps", 2, 2, 0.0, 100.0, may_repeat=True)),
        force_range_newtons=_pair(limits.rising("force_newtons", 2, 2, 0.0, 1000.0, may_repeat=True)),
        category=root.text("category", ""),
        description=root.text("description", ""),
        provenance=MaterialProvenance() if provenance is None else _provenance(provenance),
        speed_exponent=exponents.number("speed", -10.0, 10.0),
        force_exponent=exponents.number("force", -10.0, 10.0),
        frequency_exponent=root.number("frequency_exponent", -4.0, 4.0),
        wavelength_metres=wavelength,
        stiffness_newtons_per_metre=root.number("stiffness_newtons_per_metre", 1e-3, 1e6),
        friction_coefficient=root.number("friction_coefficient", 0.0, 10.0),
        impact=_impact(root.table("impact", optional=True)),
        level=_level(root.table("level", optional=True)),
        tone=_tone(root.table("tone", optional=True)),
        level_offset_db=root.number("level_offset_db", -LEVEL_OFFSET_LIMIT_DB, LEVEL_OFFSET_LIMIT_DB, default=0.0),
        seeds=tuple(_seed(seed) for seed in seeds),
    )


def _pair(values: list[float]) -> tuple[float, float]:
    return values[0], values[1]


def _provenance(table: Checked) -> MaterialProvenance:
    return MaterialProvenance(
        statement=table.text("statement", ""),
        recordings=table.text("recordings", ""),
        licence=table.text("licence", UNKNOWN_LICENCE),
        seconds=table.number("seconds", 0.0, 1e9, default=0.0),
        created=table.text("created", ""),
    )


def _impact(table: Checked | None) -> dict[str, Any] | None:
    if table is None:
        return None
    modes = [
        {
            "frequency_hz": mode.number("frequency_hz", 1.0, 1000.0),
            "decay_per_second": mode.number("decay_per_second", 10.0, 10000.0),
            "gain_per_second": mode.number("gain_per_second", 0.0, 10000.0),
        }
        for mode in table.rows("modes", 1, 2)
    ]
    return {"modes": modes, "restitution": table.number("restitution", 0.0, 0.9)}


def _level(table: Checked | None) -> LevelTable | None:
    if table is None:
        return None
    speeds = table.rising("speeds_mps", 1, MAXIMUM_LEVEL_SPEEDS, 0.0, 100.0)
    return LevelTable(
        tuple(speeds),
        tuple(table.numbers("log_levels", len(speeds), len(speeds), -30.0, 10.0)),
        table.number("force_newtons", *FORCE_RANGE_NEWTONS),
        table.number("force_exponent", -FORCE_EXPONENT_LIMIT, FORCE_EXPONENT_LIMIT),
    )


def _tone(table: Checked | None) -> ToneTable | None:
    if table is None:
        return None
    speeds = table.rising("speeds_mps", 1, MAXIMUM_TONE_SPEEDS, 1e-6, 100.0)
    frequencies = table.rising("frequencies_hz", 2, MAXIMUM_TONE_FREQUENCIES, *TONE_FREQUENCY_RANGE_HZ)
    gains = table.number_rows("gains_db", len(speeds), len(frequencies), -TONE_LIMIT_DB, TONE_LIMIT_DB)
    return ToneTable(tuple(speeds), tuple(frequencies), tuple(tuple(row) for row in gains))


def _seed(table: Checked) -> MaterialSeed:
    samples = np.array(table.numbers("samples", SEED_SAMPLES, SEED_SAMPLES), dtype=np.float32)
    rms = float(np.sqrt(np.square(samples, dtype=np.float64).mean()))
    if abs(rms - 1.0) > _SEED_RMS_TOLERANCE:
        raise table.failure("samples", f"an RMS of 1, not {rms:.3g}", "divide the samples by their RMS")
    phase = table.numbers("rib_phase", 2, 2, 0.0, 1.0) if "rib_phase" in table else None
    return MaterialSeed(
        velocity_mps=_pair(table.numbers("velocity_mps", 2, 2, -100.0, 100.0)),
        force_newtons=table.number("force_newtons", 0.0, 1000.0),
        samples=samples,
        rib_phase=None if phase is None else _pair(phase),
    )
