"""Material files (`NAME.haptomaterial`): one material beside an unchanged model file.

JSON of at most 1 MiB; Documentation~/own-materials.md, "The material file", is the specification. A material is a label
with its embedding, so it is valid only for models with the same embedding space.
"""

from __future__ import annotations

import ctypes
import json
import zlib
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.errors import InputError
from haptoflow_training.export.material_sound import LevelTable, ToneTable
from haptoflow_training.export.model_file import ModelFile
from haptoflow_training.native_library import NativeError, native_library
from haptoflow_training.whole_file import write_whole

FORMAT, VERSION = "haptoflow-material", 1
SUFFIX = ".haptomaterial"
SEED_SAMPLES = 400
UNKNOWN_LICENCE = "unknown"


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
    seeds: tuple[MaterialSeed, ...] = ()

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
    _check(text, material.name)
    return text


def write_material(path: Path, material: Material) -> None:
    """Write the file atomically. A full disk leaves the old file unchanged; InputError names the cause."""
    write_whole(path, encode_material(material).encode("utf-8"))


def read_material(path: Path, space: str | None = None) -> Material:
    """Read a material file; InputError names the file, the key and the expected value. space: the space of the model
    that will render the material, compared if given."""
    try:
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


def _check(text: str, where: str) -> None:
    """InputError with the native library's sentence if it would refuse the text: it is the one reader of material
    files. `where` begins the message."""
    content, handle = text.encode("utf-8"), ctypes.c_void_p()
    library = native_library()
    try:
        library.call("haptoflow_material_read", content, ctypes.c_uint64(len(content)), ctypes.byref(handle))
    except NativeError as error:
        raise InputError(f"{where}: {error}") from error
    library.call("haptoflow_material_close", ctypes.byref(handle))


def parse_material(text: str, where: str) -> Material:
    """The material in the text of a material file; `where` begins every message."""
    _check(text, where)
    document = json.loads(text)
    exponents, level, tone = document["level_exponents"], document.get("level"), document.get("tone")
    return Material(
        space=document["space"],
        name=document["name"],
        embedding=np.array(document["embedding"], dtype=np.float32),
        speed_range_mps=tuple(document["range"]["speed_mps"]),
        force_range_newtons=tuple(document["range"]["force_newtons"]),
        category=document.get("category", ""),
        description=document.get("description", ""),
        provenance=MaterialProvenance(**_known(MaterialProvenance, document.get("provenance") or {})),
        speed_exponent=exponents["speed"],
        force_exponent=exponents["force"],
        frequency_exponent=document["frequency_exponent"],
        wavelength_metres=document.get("wavelength_metres"),
        stiffness_newtons_per_metre=document["stiffness_newtons_per_metre"],
        friction_coefficient=document["friction_coefficient"],
        impact=document.get("impact"),
        level=None if level is None else LevelTable(**_known(LevelTable, level)),
        tone=None if tone is None else ToneTable(**_known(ToneTable, tone)),
        level_offset_db=document.get("level_offset_db", 0.0),
        seeds=tuple(_seed(seed) for seed in document["seeds"]),
    )


def _known(kind: type, table: dict[str, Any]) -> dict[str, Any]:
    """The entries of a table that are fields of `kind`; lists as tuples."""
    return {field.name: _frozen(table[field.name]) for field in fields(kind) if field.name in table}


def _frozen(value: Any) -> Any:
    return tuple(_frozen(entry) for entry in value) if isinstance(value, list) else value


def _seed(table: dict[str, Any]) -> MaterialSeed:
    values = _known(MaterialSeed, table)
    return MaterialSeed(**{**values, "samples": np.array(values["samples"], dtype=np.float32)})
