"""The materials of `configs/materials.toml`: published targets, and the physics calibrated to them."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any

from haptoflow_training.errors import InputError
from haptoflow_training.whole_file import read_toml

DEFAULT_MATERIALS_PATH = Path(__file__).resolve().parents[3] / "configs" / "materials.toml"

# Models and engine know so many families of ribs.
MAXIMUM_RULINGS = 2


@dataclass(frozen=True)
class Targets:
    """RMS = k (v / 100 mm/s)^p (F / 1 N)^q in m/s^2, 20-500 Hz; slope 60-450 Hz; spectra at 100 mm/s, 1 N."""

    k: float
    p: float
    q: float
    centroid_hz: float
    slope_db_per_octave: float


@dataclass(frozen=True)
class Calibrated:
    """Values found by `report-recorder --calibrate`.

    height_micrometres: RMS height of the octave at 1 mm wavelength, a gain on everything. height_exponent: a of the
    height spectrum's k^-a; the level grows about as v^((a - 1) / 2). force_exponent: the level grows as F^this.
    contact_resonance_hz: of the tip on its contact spring at 1 N. absorption_db_per_octave: spectral tilt of tool and
    grip.
    """

    height_micrometres: float
    height_exponent: float
    force_exponent: float
    contact_resonance_hz: float
    absorption_db_per_octave: float


@dataclass(frozen=True)
class Ruling:
    """A family of parallel ribs or threads whose profile repeats every `wavelength_mm` across them.

    relative_height: RMS height of the fundamental over the random octave at the same wavelength. jitter: RMS
    displacement of the ribs in wavelengths (0 for machined, 0.1 or more for hand-woven).
    """

    direction_degrees: float
    wavelength_mm: float
    relative_height: float
    jitter: float = 0.0


@dataclass(frozen=True)
class Material:
    """One label's surface, contact and friction; `configs/materials.toml` explains each value."""

    label: str
    texture_id: int
    category: str
    friction: float
    stiffness_newtons_per_metre: float
    targets: Targets
    calibrated: Calibrated
    surface_seed: int
    anisotropy: float = 1.0
    grain_degrees: float = 0.0
    nap: float = 0.0
    tip_patch_mm: float = 0.05
    contact_damping: float = 0.5
    tangential_share: float = 0.7
    tool_modes: tuple[tuple[float, float, float], ...] = ()
    rulings: tuple[Ruling, ...] = ()
    impact_strength: float = 0.0
    impact_spacing_mm: float = 1.0
    impact_density: float = 0.0
    impact_upward_share: float = 0.85
    stick_slip_strength: float = 0.0
    stick_slip_length_mm: float = 0.6
    stick_slip_critical_mmps: float = 150.0
    specimen_spread_db: float = 1.5
    specimen_tilt_db_per_octave: float = 0.4
    place_spread_db: float = 0.7

    @property
    def dominant_ruling(self) -> Ruling | None:
        """The highest family of ribs, whose wavelength is the label's; None for a random surface."""
        return max(self.rulings, key=lambda ruling: ruling.relative_height, default=None)

    @property
    def wave_vectors_per_mm(self) -> tuple[tuple[float, float], ...]:
        """(x, y) of each family of ribs, in cycles per millimetre."""
        angles = [math.radians(ruling.direction_degrees) for ruling in self.rulings]
        return tuple(
            (math.cos(angle) / ruling.wavelength_mm, math.sin(angle) / ruling.wavelength_mm)
            for angle, ruling in zip(angles, self.rulings, strict=True)
        )

    @property
    def without_spread(self) -> Material:
        """The label's typical statistics on every specimen and at every place, as the targets state them."""
        return replace(self, specimen_spread_db=0.0, specimen_tilt_db_per_octave=0.0, place_spread_db=0.0)

    def with_calibrated(self, **values: float) -> Material:
        return replace(self, calibrated=replace(self.calibrated, **values))


def load_materials(path: Path | str | None = None) -> tuple[Material, ...]:
    """All materials in the order of their texture ids. InputError names the file, the key and the remedy."""
    source = DEFAULT_MATERIALS_PATH if path is None else Path(path)
    document = read_toml(source, "a materials.toml")
    entries = document.get("material")
    if not isinstance(entries, list) or not entries:
        raise InputError(f"{source}: no [[material]] entries; expected one for each label")
    materials = tuple(_material(source, index, entry) for index, entry in enumerate(entries))
    labels = [material.label for material in materials]
    for label in labels:
        if labels.count(label) > 1:
            raise InputError(f"{source}: label '{label}' occurs twice; give each material a label of its own")
    return materials


def select_materials(materials: Sequence[Material], labels: Sequence[str] | None) -> tuple[Material, ...]:
    """The materials of these labels, in the file's order; None selects all. InputError names an unknown label."""
    if labels is None:
        return tuple(materials)
    known = {material.label for material in materials}
    for label in labels:
        if label not in known:
            raise InputError(f"no material is labelled '{label}'; known labels: {', '.join(sorted(known))}")
    return tuple(material for material in materials if material.label in set(labels))


def _material(source: Path, index: int, entry: dict[str, Any]) -> Material:
    where = f"{source}: [[material]] {entry.get('label', f'number {index + 1}')}"
    values = dict(entry)
    values["targets"] = _table(where, Targets, values.get("targets"), "targets")
    values["calibrated"] = _table(where, Calibrated, values.get("calibrated"), "calibrated")
    values["rulings"] = tuple(_table(where, Ruling, each, "rulings") for each in values.get("rulings", []))
    values["tool_modes"] = tuple(_tool_mode(where, mode) for mode in values.get("tool_modes", []))
    values.setdefault("surface_seed", 1000 + index)
    values["texture_id"] = index
    material = _table(where, Material, values, "material")
    for name, lowest, highest in (
        ("friction", 0.0, 3.0),
        ("stiffness_newtons_per_metre", 10.0, 100_000.0),
        ("anisotropy", 1.0, 4.0),
        ("contact_damping", 0.1, 2.0),
        ("impact_spacing_mm", 0.05, 20.0),
        ("impact_density", 0.0, 1.0),
        ("impact_upward_share", 0.0, 1.0),
        ("stick_slip_length_mm", 0.05, 20.0),
        ("specimen_spread_db", 0.0, 6.0),
        ("specimen_tilt_db_per_octave", 0.0, 2.0),
        ("place_spread_db", 0.0, 3.0),
    ):
        value = getattr(material, name)
        if not lowest <= value <= highest:
            raise InputError(f"{where}: {name} = {value}; expected a number between {lowest} and {highest}")
    if len(material.rulings) > MAXIMUM_RULINGS:
        raise InputError(f"{where}: {len(material.rulings)} rulings; expected {MAXIMUM_RULINGS} at most")
    return material


def _tool_mode(where: str, mode: Any) -> tuple[float, float, float]:
    if not isinstance(mode, list) or len(mode) != 3 or not 20.0 <= mode[0] <= 2000.0:
        raise InputError(f"{where}: tool_modes {mode}; expected [frequency_hz 20-2000, gain_db, q]")
    return float(mode[0]), float(mode[1]), float(mode[2])


def _table(where: str, kind: type, values: Any, name: str) -> Any:
    if not isinstance(values, dict):
        raise InputError(f"{where}: '{name}' is missing; expected a table")
    known = {each.name for each in fields(kind)}
    for key in values:
        if key not in known:
            expected = ", ".join(sorted(known))
            raise InputError(f"{where}: unknown key '{key}' in {name}; expected one of {expected}")
    try:
        return kind(**values)
    except TypeError as error:
        raise InputError(f"{where}: {name}: {error}") from error


def write_calibrated(path: Path | str, calibrated: Mapping[str, Calibrated]) -> None:
    """Rewrite the `calibrated = {...}` line of each given label; the rest of the file stays unchanged."""
    target = Path(path)
    label, lines = "", []
    for line in target.read_text(encoding="utf-8").splitlines(keepends=True):
        named = re.match(r'label\s*=\s*"([^"]*)"', line)
        label = named.group(1) if named else label
        if re.match(r"calibrated\s*=", line) and label in calibrated:
            values = ", ".join(
                f"{each.name} = {getattr(calibrated[label], each.name):.5g}" for each in fields(Calibrated)
            )
            line = f"calibrated = {{ {values} }}\n"
        lines.append(line)
    target.write_text("".join(lines), encoding="utf-8")
