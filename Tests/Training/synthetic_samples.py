"""Whole protocols of the synthetic recorder."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from haptoflow_training.recordings.recording import Recording
from haptoflow_training.recordings.synthetic import (
    Material, hand_conditions, machine_conditions, record_hand_condition, record_machine_condition
)
from haptoflow_training.recordings.synthetic.materials import select_materials


def record_machine(
    materials: Sequence[Material], *, seed: int, labels: Sequence[str], **conditions: int | Sequence[int]
) -> Iterator[Recording]:
    """The machine recordings of these labels. conditions: as of machine_conditions."""
    for material in select_materials(materials, labels):
        for identity in machine_conditions(material, **conditions):  # type: ignore[arg-type]
            yield record_machine_condition(material, identity, seed=seed)


def record_hand(
    materials: Sequence[Material], *, seed: int, labels: Sequence[str], recordings_per_label: int, duration_seconds: float
) -> Iterator[Recording]:
    """The free hand strokes of these labels."""
    for material in select_materials(materials, labels):
        for identity in hand_conditions(material, seed=seed, recordings=recordings_per_label):
            yield record_hand_condition(material, identity, seed=seed, duration_seconds=duration_seconds)
