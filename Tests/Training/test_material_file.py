"""Material files: written files are read again, and invalid ones are refused with the key named."""

from __future__ import annotations

import copy
import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from haptoflow_training.errors import InputError
from haptoflow_training.export.material_file import (
    Material,
    encode_material,
    model_space,
    parse_material,
    read_material,
    write_material,
)
from haptoflow_training.export.material_sound import LevelTable, ToneTable, minimum_phase
from haptoflow_training.export.model_file import read_model_file

ROOT = Path(__file__).parents[2]
GOLDEN = ROOT / "Tests" / "Golden" / "material"
TINY = ROOT / "Tests" / "Golden" / "model" / "tiny.haptoflow"
DEFAULT = ROOT / "Packages" / "com.haptoflow.runtime" / "Runtime" / "Models" / "default.haptoflow"
INVALID = json.loads((GOLDEN / "invalid.json").read_text(encoding="utf-8"))
EXPECTED = json.loads((GOLDEN / "expected.json").read_text(encoding="utf-8"))


def golden(name: str) -> Material:
    return read_material(GOLDEN / f"{name}.haptomaterial")


def patched(document: Any, patch: list[dict[str, Any]]) -> Any:
    """The part of JSON Patch that the golden file uses."""
    changed = copy.deepcopy(document)
    for change in patch:
        *parents, last = [int(part) if part.isdigit() else part for part in change["path"][1:].split("/")]
        table = changed
        for part in parents:
            table = table[part]
        if change["op"] == "remove":
            del table[last]
        else:
            table[last] = change["value"]
    return changed


@pytest.mark.parametrize("name", sorted(EXPECTED["materials"]))
def test_a_golden_material_gives_the_golden_levels_and_kernels(name: str) -> None:
    material, expected = golden(name), EXPECTED["materials"][name]
    assert (material.name, material.space) == (expected["name"], expected["space"])
    assert (material.level is not None) == ("levels" in expected)
    assert (material.tone is not None) == ("kernels" in expected)
    for case in expected.get("levels", []):
        found = material.level.log_level(case["speed_mps"], case["force_newtons"], material.speed_exponent)
        found += material.level_offset_db * math.log(10.0) / 20.0
        assert found == pytest.approx(case["log_level"], abs=1e-9)
    for case in expected.get("kernels", []):
        assert material.tone.kernel(case["speed_mps"]) == pytest.approx(case["taps"], abs=1e-9)


@pytest.mark.parametrize("case", INVALID["cases"], ids=lambda case: case["name"])
def test_the_library_refuses_an_invalid_material_and_names_file_and_key(case: dict[str, Any]) -> None:
    document = json.loads((GOLDEN / INVALID["of"]).read_text(encoding="utf-8"))
    with pytest.raises(InputError) as refusal:
        parse_material(json.dumps(patched(document, case["patch"])), "somewhere.haptomaterial")
    assert str(refusal.value).startswith("somewhere.haptomaterial: ")
    assert case["key"].split(".")[-1] in str(refusal.value)


@pytest.mark.parametrize("text", ["", "[]", "{", "3", '{"format": "haptoflow-material"}', "[" * 100_000])
def test_text_that_is_not_a_material_file_is_refused(text: str) -> None:
    with pytest.raises(InputError, match="^x.haptomaterial: .*material"):
        parse_material(text, "x.haptomaterial")


def test_numbers_outside_json_are_refused() -> None:
    text = (GOLDEN / "ribbed.haptomaterial").read_text(encoding="utf-8")
    for word in ("NaN", "Infinity", "1e999", "1" + "0" * 400):
        with pytest.raises(InputError, match="^x: "):
            parse_material(text.replace('"friction_coefficient":0.55', f'"friction_coefficient":{word}'), "x")


def test_a_material_written_and_read_is_the_same_material(tmp_path: Path) -> None:
    material, path = golden("ribbed"), tmp_path / "folder" / "again.haptomaterial"
    write_material(path, material)
    again = read_material(path, space=material.space)
    assert encode_material(again) == encode_material(material)
    assert np.array_equal(again.embedding, material.embedding)
    assert again.seeds[1].rib_phase == material.seeds[1].rib_phase


def test_unknown_keys_are_ignored() -> None:
    document = json.loads((GOLDEN / "ribbed.haptomaterial").read_text(encoding="utf-8"))
    document["colour"] = {"red": 1}
    document["tone"]["later"] = [1]
    assert encode_material(parse_material(json.dumps(document), "x")) == encode_material(golden("ribbed"))


def test_a_material_of_another_space_is_refused_with_a_remedy() -> None:
    with pytest.raises(InputError, match="another model.*from its recording"):
        read_material(GOLDEN / "ribbed.haptomaterial", space="00000000")


def test_a_file_that_is_too_long_or_not_text_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "long.haptomaterial"
    path.write_text(" " * ((1 << 20) + 1), encoding="utf-8")
    with pytest.raises(InputError, match="1048576"):
        read_material(path)
    path.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InputError, match="UTF-8"):
        read_material(path)
    with pytest.raises(InputError, match="cannot be read"):
        read_material(tmp_path / "missing.haptomaterial")


def test_the_space_follows_the_networks_and_neither_labels_nor_embedding() -> None:
    model = read_model_file(TINY)
    assert model_space(model) == EXPECTED["spaces"]["tiny"]
    assert model_space(read_model_file(DEFAULT)) == EXPECTED["spaces"]["default"]
    model.header["labels"].pop()
    model.tensors["embedding"] = model.tensors["embedding"] * 2.0
    assert model_space(model) == EXPECTED["spaces"]["tiny"]
    name = model.header["tiers"][1]["field"]
    model.graphs[name] = model.graphs[name] + b"\0"
    assert model_space(model) != EXPECTED["spaces"]["tiny"]


def test_a_flat_tone_is_an_impulse() -> None:
    taps = minimum_phase(np.zeros(129))
    assert taps[0] == pytest.approx(1.0)
    assert np.abs(taps[1:]).max() < 1e-12


def test_a_kernel_has_the_gains_of_its_table() -> None:
    tone = golden("ribbed").tone
    for row, speed in enumerate(tone.speeds_mps):
        response = np.abs(np.fft.rfft(tone.kernel(speed), 2000))
        for gain, hertz in zip(tone.gains_db[row], tone.frequencies_hz, strict=True):
            assert 20.0 * math.log10(response[round(hertz)]) == pytest.approx(gain, abs=0.6)


def test_a_kernel_has_minimum_phase() -> None:
    energy = np.square(golden("ribbed").tone.kernel(0.3))
    assert energy[:16].sum() > 0.95 * energy.sum()


def test_a_level_table_is_continued_by_the_exponent_and_stays_finite_at_rest() -> None:
    table = LevelTable((0.02, 0.2), (0.0, 1.0), 1.0, 0.5)
    beyond = table.log_level(0.4, 1.0, 0.8) - table.log_level(0.2, 1.0, 0.8)
    assert beyond == pytest.approx(0.8 * math.log(0.4005 / 0.2005))
    assert math.isfinite(table.log_level(0.0, 0.0, 0.8))
    assert table.log_level(0.05, 4.0, 0.8) - table.log_level(0.05, 1.0, 0.8) == pytest.approx(0.5 * math.log(4.0))


def test_an_inconsistent_material_is_not_written(tmp_path: Path) -> None:
    loud = replace(golden("ribbed"), tone=ToneTable((0.1,), (20.0, 900.0), ((0.0, 45.0),)))
    with pytest.raises(InputError, match="tone"):
        write_material(tmp_path / "loud.haptomaterial", loud)
    assert not list(tmp_path.iterdir())
