"""Where ribs lie in recordings whose places begin anywhere: the phase of each family of ribs, followed along the stroke.

A recording of one's own knows how its tip moved, not from which rib it started, and a tracker's drift moves it by a rib
within seconds. Over many recordings the ribs would cancel, and a network would learn none. The phase is that of the
vibration's fundamental relative to k . x, averaged over a quarter of a second either way.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from haptoflow_training.preprocessing.store import SegmentStore
from haptoflow_training.waveform import SAMPLE_RATE_HZ

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
