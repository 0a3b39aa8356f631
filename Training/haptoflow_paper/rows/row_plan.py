"""The plan of the evaluation: one TOML file names the rows, their models and how those are trained."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

from haptoflow_paper.rows.reference_set import CODEC_ROW, REFERENCE_ROWS
from haptoflow_training.errors import InputError
from haptoflow_training.whole_file import read_toml

AS_PUBLISHED, GIVEN_THE_SAME, OURS, ABLATION, REFERENCE = (
    "as-published", "given-the-same", "ours", "ablation", "reference",
)  # fmt: skip
BLOCKS = (OURS, AS_PUBLISHED, GIVEN_THE_SAME, ABLATION, REFERENCE)
_ROWS_WITHOUT_MODEL = (*REFERENCE_ROWS, CODEC_ROW)
RIVAL_BLOCKS = (AS_PUBLISHED, GIVEN_THE_SAME)
DEFAULT_AGAINST = "standard"


@dataclass(frozen=True)
class PlannedRow:
    """One row of the plan.

    block: `ours`, `as-published` (a rival in its published form), `given-the-same` (a rival with our inputs and
    budget), `ablation` or `reference`.
    rival: the rival's name; rows of one network at several numbers of steps are one rival and have the same name
    (default: the row's own).
    family: the colour group of the chart.
    against: the row that this one is judged against, which was trained for the same time.
    model: a .haptoflow file, relative to the repository's root, or the name of a training in the plan's folder (its
    TOML file without the ending); empty for a reference row.
    seeds: of the training; those after the first are measured on every fourth recording, to estimate the spread between
    trainings.
    seeds_model: the training of the further seeds, if `model` is a file.
    quick: measured by --quick too.
    extended: the long measurements too (ten minutes of drift, speeds by update rates, level across speed).
    every_fourth: measured on every fourth recording, as further seeds are, and judged against such a row.
    time_only: random weights of the real size; no accuracy is measured.
    """

    name: str
    block: str
    rival: str = ""
    family: str = ""
    model: str = ""
    tier: str = ""
    solver: str = "tier"
    steps: int = 0
    evaluations: int = 0
    seeds: tuple[int, ...] = (1,)
    seeds_model: str = ""
    against: str = DEFAULT_AGAINST
    quick: bool = False
    extended: bool = False
    every_fourth: bool = False
    time_only: bool = False

    @property
    def is_reference(self) -> bool:
        return self.name in _ROWS_WITHOUT_MODEL

    @property
    def rival_name(self) -> str:
        return self.rival or self.name

    def model_of(self, seed: int) -> str:
        """The file or the training with which a seed of the row is measured."""
        return self.seeds_model if self.seeds_model and seed != self.seeds[0] else self.model


def load_plan(path: Path) -> list[PlannedRow]:
    """The rows of a plan; InputError names file, row and key."""
    table = read_toml(path, "a plan")
    known = {field.name for field in fields(PlannedRow)}
    rows: list[PlannedRow] = []
    for number, entry in enumerate(table.get("row", [])):
        where = f"{path}: row {entry.get('name', number + 1)!r}"
        for key in entry:
            if key not in known:
                raise InputError(f"{where}: unknown key '{key}', expected {', '.join(sorted(known))}")
        rows.append(_row(entry, where))
    names = [row.name for row in rows]
    for name in names:
        if names.count(name) > 1:
            raise InputError(f"{path}: row '{name}' stands there twice")
    if not rows:
        raise InputError(f"{path}: no [[row]] in it")
    for row in rows:
        _check_against(row, rows, f"{path}: row '{row.name}'")
    return rows


def _check_against(row: PlannedRow, rows: Sequence[PlannedRow], where: str) -> None:
    reference = next((other for other in rows if other.name == row.against), None)
    if reference is None:
        if row.against != DEFAULT_AGAINST:
            raise InputError(f"{where}: key 'against' names no row of the plan: '{row.against}'")
        return
    is_judged = row.block in (*RIVAL_BLOCKS, ABLATION) and not row.time_only
    if is_judged and row.every_fourth != reference.every_fourth:
        # The classifier depends on the number of recordings it is fitted to, so such rows would differ for that reason
        # alone.
        raise InputError(
            f"{where}: key 'against' names '{row.against}', which is measured on other recordings; "
            "give both every_fourth or neither"
        )


def _row(entry: dict[str, Any], where: str) -> PlannedRow:
    for key in ("name", "block"):
        if not isinstance(entry.get(key), str):
            raise InputError(f"{where}: key '{key}' is missing, expected text")
    row = PlannedRow(**{**entry, "seeds": tuple(entry.get("seeds", (1,)))})
    if row.block not in BLOCKS:
        raise InputError(f"{where}: key 'block' is '{row.block}', expected one of {', '.join(BLOCKS)}")
    if row.is_reference != (row.block == REFERENCE):
        raise InputError(f"{where}: only {', '.join(_ROWS_WITHOUT_MODEL)} are of the block '{REFERENCE}', and always")
    if not row.is_reference and not row.model:
        raise InputError(f"{where}: key 'model' is missing; only {', '.join(_ROWS_WITHOUT_MODEL)} have none")
    if not row.seeds:
        raise InputError(f"{where}: key 'seeds' is empty, expected a number at least")
    return row
