"""Ribs of recordings whose labels file does not state them: their wave vectors, and where they lie.

A recording of one's own knows how its tip moved, not from which rib it started, and a tracker's drift moves it by a rib
within seconds. Over many recordings the ribs would cancel, and a network would learn none. The phase of each family is
that of the vibration's fundamental relative to k . x, averaged over a quarter of a second either way.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Collection, Mapping, Sequence
from functools import lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from haptoflow_training.preprocessing.store import STORE_FILE, SegmentStore
from haptoflow_training.recordings.native_recording import MaterialRecording, WaveVector, estimate_wave_vectors
from haptoflow_training.recordings.landing import LabelInfo
from haptoflow_training.waveform import SAMPLE_RATE_HZ

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
        MaterialRecording(store.waveform[one.recorded_samples] * store.peak_mps2, store.motion[one.recorded_samples])
        for one in own
    ]


_AVERAGE_SECONDS = 0.25
# The fundamental's share of the amplitude that chance does not reach: three times that of white noise.
_CHANCE_FACTOR = 3.0
# Slower ribs are below what a recording holds, faster ones above.
_LOWEST_HZ, _HIGHEST_HZ = 12.0, 900.0


def rib_phase_turns(
    waveform: NDArray[np.floating], motion: NDArray[np.floating], position_mm: NDArray[np.floating],
    wave_vector_per_mm: tuple[float, float],
) -> NDArray[np.float64]:  # fmt: skip
    """[n]: by how many turns the ribs are displaced from k . x, such that the vibration's fundamental is cos(2 pi (k . x +
    turns)). waveform [n]; motion [n, 3]: vx, vy in m/s and force; position_mm [n, 2]. Where the ribs cannot be made out,
    the phase runs on between the nearest places where they can; all zero if there are none."""
    vector = np.asarray(wave_vector_per_mm, dtype=np.float64)
    wave = waveform.astype(np.float64)
    width = _AVERAGE_SECONDS * SAMPLE_RATE_HZ
    even = wave / np.sqrt(_averaged(wave * wave, width) + 1e-12)
    line = even * np.exp(-2j * np.pi * (position_mm.astype(np.float64) @ vector))
    found = _averaged(line.real, width) + 1j * _averaged(line.imag, width)
    rate_hz = 1000.0 * np.abs(motion[:, :2].astype(np.float64) @ vector)
    # White noise averaged with a Gaussian of this width, in each of two quadratures.
    chance = 1.0 / np.sqrt(2.0 * np.sqrt(np.pi) * width)
    clear = np.flatnonzero(
        (np.abs(found) > _CHANCE_FACTOR * chance) & (rate_hz > _LOWEST_HZ) & (rate_hz < _HIGHEST_HZ)
    )
    if not len(clear):
        return np.zeros(len(wave))
    turns = np.unwrap(np.angle(found[clear])) / (2.0 * np.pi)
    return np.interp(np.arange(len(wave)), clear, turns)


def _averaged(values: NDArray[np.float64], width: float) -> NDArray[np.float64]:
    averaged: NDArray[np.float64] = gaussian_filter1d(values, width, mode="constant")
    return averaged


def with_rib_phases(store: SegmentStore, wave_vectors: Sequence[Sequence[tuple[float, float]]]) -> SegmentStore:
    """The store with the phase of the ribs of each label, by index, in each recording."""
    ruled = [one for one in store.recordings if wave_vectors[one.label_index]]
    if not ruled:
        return store
    turns = np.array(store.wander_turns)
    for one in ruled:
        own = slice(one.start, one.start + one.length)
        for family, vector in enumerate(wave_vectors[one.label_index]):
            turns[own, family] = rib_phase_turns(store.waveform[own], store.motion[own], store.position_mm[own], vector)
    return dataclasses.replace(store, wander_turns=turns, ribs_followed=True)
