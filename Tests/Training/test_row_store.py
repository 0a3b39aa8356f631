"""Measured rows as files: read as written, and used only if nothing they depend on has changed."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from haptoflow_paper.rows.row_plan import PlannedRow
from haptoflow_paper.rows.row_store import read_row, stored_row, write_row
from haptoflow_paper.rows.workplace import Workplace

_ORIGIN = {"configuration_crc32": "1", "graphs_crc32": "2", "recordings_crc32": "3", "reduced": False}
_CONDITION: dict[str, Any] = {
    "label": "glass", "kind": "constant", "speed_mps": 0.03, "force_newtons": 1.35, "direction_degrees": 225.0,
    "crossing_degrees": 0.0, "seed": 9001, "level_error_db": -0.123456, "gfc_recording": 0.98764, "lsd_db": 1.0,
    "told_apart_percent": 55.0, "recorded_kurtosis": 3.2, "rmse": 1.4,
}  # fmt: skip
_RESULT = {
    "made_from": _ORIGIN, "name": "row", "seed": 1, "discrimination": 0.5,
    "conditions": [_CONDITION, {**_CONDITION, "speed_mps": 1.5}],
}  # fmt: skip
_ROW = PlannedRow("row", "ours", model="model")


@pytest.fixture
def place(tmp_path: Path) -> Workplace:
    place = Workplace(tmp_path, tmp_path / "rows.toml", tmp_path / "work", tmp_path / "store", tmp_path / "results")
    write_row(place.row_file(_ROW, 1), _RESULT)
    return place


def test_a_stored_row_has_four_digits_and_a_line_for_each_recording(place: Workplace) -> None:
    kept = {**_CONDITION, "level_error_db": -0.1235, "gfc_recording": 0.9876}
    read = read_row(place.row_file(_ROW, 1))
    assert read == {**_RESULT, "conditions": [kept, {**kept, "speed_mps": 1.5}]}
    lines = place.row_file(_ROW, 1).read_text(encoding="utf-8").splitlines()
    assert sum("glass" in line for line in lines) == 2


def test_a_row_without_recordings_is_read_as_it_was_written(tmp_path: Path) -> None:
    timed = {"made_from": _ORIGIN, "name": "size", "seed": 1, "discrimination": None}
    write_row(tmp_path / "size.json", timed)
    assert read_row(tmp_path / "size.json") == {**timed, "conditions": []}


def test_a_stored_row_is_used_if_it_was_measured_from_the_same(place: Workplace) -> None:
    assert stored_row(place, _ROW, 1, _ORIGIN) is not None
    assert stored_row(place, _ROW, 2, _ORIGIN) is None


def test_a_missing_model_is_no_reason_to_measure_again(place: Workplace) -> None:
    assert stored_row(place, _ROW, 1, {**_ORIGIN, "graphs_crc32": None}) is not None


@pytest.mark.parametrize("key", list(_ORIGIN))
def test_a_row_is_measured_again_when_what_it_was_measured_from_has_changed(place: Workplace, key: str) -> None:
    assert stored_row(place, _ROW, 1, {**_ORIGIN, key: "other"}) is None
