"""Simulated studies for tests, and functions that damage their files."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from haptoflow_training.studies.simulation import RatingModel, simulate_latency, simulate_similarity

SMALL = RatingModel(materials=("jute", "wood"), methods=("ours", "other", "third"))


def latency_study(folder: Path, participants: int = 3, seed: int = 1) -> Path:
    simulate_latency(folder, participants, seed)
    return folder


def similarity_study(folder: Path, participants: int = 3, seed: int = 1, model: RatingModel = SMALL) -> Path:
    simulate_similarity(folder, participants, seed, model)
    return folder


def log_of(folder: Path, participant: int, study: str = "latency") -> Path:
    (path,) = folder.glob(f"{study}-P{participant:02d}-*.csv")
    return path


def change_lines(path: Path, change: Callable[[list[str]], list[str]]) -> None:
    """The file's lines without line breaks, the header first."""
    lines = path.read_text(encoding="utf-8").split("\n")[:-1]
    path.write_text("\n".join(change(lines)) + "\n", encoding="utf-8")


def change_field(path: Path, row: int, column: str, value: str) -> None:
    """row: as in a spreadsheet."""

    def changed(lines: list[str]) -> list[str]:
        place = lines[0].split(",").index(column)
        fields = lines[row - 1].split(",")
        fields[place] = value
        return [*lines[: row - 1], ",".join(fields), *lines[row:]]

    change_lines(path, changed)


def change_sidecar(log: Path, change: Callable[[dict[str, Any]], Mapping[str, Any] | None]) -> None:
    path = log.with_suffix(".json")
    document = json.loads(path.read_text(encoding="utf-8"))
    path.write_text(json.dumps(change(document) or document), encoding="utf-8")
