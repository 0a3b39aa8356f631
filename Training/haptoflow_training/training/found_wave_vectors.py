"""Estimates wave vectors from the training recordings, for labels whose labels file does not state them."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Collection, Mapping
from functools import lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.export.label_info import LabelInfo
from haptoflow_training.preprocessing.store import STORE_FILE, SegmentStore
from haptoflow_training.preprocessing.wave_vectors import WaveVector, estimate_wave_vectors
from haptoflow_training.recordings.material_recording import MaterialRecording

# Smaller wave numbers are rounding errors.
_ROUNDING_PER_MM = 1e-9


def with_found_ribs(
    store: SegmentStore, infos: list[LabelInfo], asked: Collection[str]
) -> tuple[SegmentStore, list[LabelInfo], dict[str, float]]:
    """The labels, those in `asked` with estimated wave vectors; and for those with ribs the angle in degrees by which their
    recordings are turned in the store that is returned: the first axis lies across the clearest ribs, as in the labels
    that the networks know, and as `haptoflow learn` turns a material. A label's wavelength is that of its clearest
    ribs."""
    changed = (store.path / STORE_FILE).stat().st_mtime_ns
    completed: list[LabelInfo] = []
    turned: dict[str, float] = {}
    for row, info in enumerate(infos):
        vectors = _of_label(store.path, changed, row) if info.name in asked else ()
        if vectors:
            turned[info.name] = math.degrees(math.atan2(vectors[0][1], vectors[0][0]))
            across = tuple(_in_frame(vector, turned[info.name]) for vector in vectors)
            wavelength = 1e-3 / math.hypot(*vectors[0])
            info = dataclasses.replace(info, wave_vectors_per_mm=across, wavelength_metres=wavelength)
        completed.append(info)
    return turned_store(store, turned), completed, turned


def _in_frame(vector: WaveVector, degrees: float) -> WaveVector:
    x, y = turned_vectors(np.array([vector]), degrees)[0]
    # Ribs have no sign; the second family gets the sign that the labels use.
    sign = -1.0 if y < -_ROUNDING_PER_MM else 1.0
    return (sign * float(x), 0.0 if abs(y) < _ROUNDING_PER_MM else sign * float(y))


def turned_store(store: SegmentStore, degrees: Mapping[str, float]) -> SegmentStore:
    """The store with the recordings of these labels in a frame turned by so many degrees."""
    if not degrees:
        return store
    motion, position = np.array(store.motion), np.array(store.position_mm)
    for one in store.recordings:
        if (angle := degrees.get(store.labels[one.label_index])) is not None:
            own = slice(one.start, one.start + one.length)
            motion[own, :2] = turned_vectors(motion[own, :2], angle)
            position[own] = turned_vectors(position[own], angle)
    return dataclasses.replace(store, motion=motion, position_mm=position)


def turned_vectors(vectors: NDArray[np.floating], degrees: float) -> NDArray[np.float64]:
    """Vectors [n, 2] as seen in a frame that is turned by an angle."""
    cosine, sine = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    turned: NDArray[np.float64] = np.asarray(vectors, dtype=np.float64) @ np.array([[cosine, -sine], [sine, cosine]])
    return turned


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
