"""Rows measured by several processes: the same figures as with one process, stored as they are finished."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from haptoflow_paper.reference.reference_conditions import Condition
from haptoflow_paper.reference.reference_set import ReferencePair
from haptoflow_paper.rows.accuracy import Yardstick, make_yardstick
from haptoflow_paper.rows.row_plan import PlannedRow
from haptoflow_paper.rows.row_runner import made_from, measure_rows
from haptoflow_paper.rows.row_store import stored_row
from haptoflow_paper.rows.workplace import Workplace
from haptoflow_training.errors import InputError

_ROWS = [PlannedRow(name, "reference") for name in ("silence", "white-noise", "mean-spectrum")]


def _pair(label: str, index: int, place: int) -> ReferencePair:
    generator = np.random.default_rng([index, place])
    motion = np.tile(np.float32([0.2, 0.0, 1.0]), (6000, 1))
    waves = [
        np.convolve(generator.standard_normal(6000 + index), np.ones(1 + index), "valid").astype(np.float32)
        for _ in range(2)
    ]
    return ReferencePair(Condition(label, index, "constant", 0.2, 1.0, 0.0, 3.0, place), *waves, motion)


@pytest.fixture(scope="module")
def yardstick() -> Yardstick:
    return make_yardstick([_pair(label, index, place) for index, label in enumerate("ab") for place in range(6)])


def _place(folder: Path) -> Workplace:
    return Workplace(folder, folder / "rows.toml", folder / "work", folder / "store", folder / "results")


def test_two_processes_give_the_same_figures_as_one_and_store_every_row(tmp_path: Path, yardstick: Yardstick) -> None:
    wanted = [(row, 1) for row in _ROWS]
    done: list[int] = []
    together = measure_rows(_place(tmp_path / "two"), yardstick, wanted, 2, done.append)
    assert together == measure_rows(_place(tmp_path / "one"), yardstick, wanted, 1)
    assert len(together["white-noise", 1]["conditions"]) == 12 and sum(done) == 3
    for row in _ROWS:
        place = _place(tmp_path / "two")
        assert stored_row(place, row, 1, made_from(place, yardstick, row, 1)) == together[row.name, 1]


def test_a_row_that_cannot_be_measured_is_reported_and_the_others_are_stored(
    tmp_path: Path, yardstick: Yardstick
) -> None:
    place = _place(tmp_path)
    (tmp_path / "broken.haptoflow").write_bytes(b"not a model")
    broken = PlannedRow("broken", "ours", model="broken.haptoflow")
    with pytest.raises(InputError, match="broken.haptoflow"):
        measure_rows(place, yardstick, [(broken, 1), (_ROWS[0], 1)], 2)
    assert stored_row(place, _ROWS[0], 1, made_from(place, yardstick, _ROWS[0], 1)) is not None
