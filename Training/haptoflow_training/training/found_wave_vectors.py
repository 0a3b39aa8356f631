"""Estimates wave vectors from the training recordings, for labels whose labels file does not state them."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Collection
from functools import lru_cache
from pathlib import Path

from haptoflow_training.export.label_info import LabelInfo
from haptoflow_training.preprocessing.store import STORE_FILE, SegmentStore
from haptoflow_training.preprocessing.wave_vectors import WaveVector, estimate_wave_vectors
from haptoflow_training.recordings.material_recording import MaterialRecording


def with_found_wave_vectors(
    store: SegmentStore, infos: list[LabelInfo], asked: Collection[str]
) -> tuple[list[LabelInfo], tuple[str, ...]]:
    """The labels, those in `asked` with estimated wave vectors; and the names of those for which ribs were found. A
    label's wavelength is that of its clearest ribs."""
    changed = (store.path / STORE_FILE).stat().st_mtime_ns
    completed: list[LabelInfo] = []
    found: list[str] = []
    for row, info in enumerate(infos):
        vectors = _of_label(store.path, changed, row) if info.name in asked else ()
        if vectors:
            found.append(info.name)
            wavelength = 1e-3 / math.hypot(*vectors[0])
            info = dataclasses.replace(info, wave_vectors_per_mm=vectors, wavelength_metres=wavelength)
        completed.append(info)
    return completed, tuple(found)


@lru_cache(maxsize=256)
def _of_label(path: Path, changed: int, row: int) -> tuple[WaveVector, ...]:
    """The wave vectors of one label of the store that was written at `changed`."""
    return estimate_wave_vectors(stored_recordings(SegmentStore.open(path), row))


def stored_recordings(store: SegmentStore, row: int) -> list[MaterialRecording]:
    """The training recordings of one label, without the silence added by preparation."""
    own = [one for one in store.recordings if one.label_index == row and one.split == "train"]
    return [
        MaterialRecording(
            one.name,
            one.label,
            store.waveform[one.recorded_samples] * store.peak_mps2,
            store.motion[one.recorded_samples, :2],
            store.motion[one.recorded_samples, 2],
            "",
            "",
        )
        for one in own
    ]
