"""The phases of the surface's waves along a rendered path, as the engine adds them up.

Ribs advance with the way along their wave vectors. Threads wander from that, and stick-slip has no place at all: both
follow a smooth random field over the surface with the label's own statistics.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.models.label_embedding import WAVE_NUMBERS, WAVE_VECTORS
from haptoflow_training.recordings.synthetic.features import LIGHTEST_SLIP_NEWTONS, SLIP_FORCE_EXPONENT
from haptoflow_training.waveform import SAMPLE_RATE_HZ

if TYPE_CHECKING:
    from haptoflow_training.export.label_info import LabelInfo

_Doubles = NDArray[np.float64]
_FAMILIES = WAVE_VECTORS + 1
_SLIP = WAVE_VECTORS
# A field is a sum of plane waves, whose wavelengths lie within half an octave of the field's.
_WAVES, _OCTAVES = 12, 0.5


@dataclass(frozen=True)
class SurfaceStatistics:
    """By label. slips_per_mm [L]: at 1 N, 0 for none. wander [L, 3]: of both rib families in turns, and of the logarithm
    of the stick-slip's rate; wavelengths_mm [L, 3]: of the fields that they follow."""

    slips_per_mm: _Doubles
    wander: _Doubles
    wavelengths_mm: _Doubles

    @classmethod
    def of_labels(cls, labels: Sequence[LabelInfo]) -> SurfaceStatistics:
        return cls.of_entries(
            [
                {"rib_wander": [asdict(ribs) for ribs in label.rib_wander]}
                | ({} if label.stick_slip is None else {"stick_slip": asdict(label.stick_slip)})
                for label in labels
            ]
        )

    @classmethod
    def of_entries(cls, labels: Sequence[Mapping[str, Any]]) -> SurfaceStatistics:
        """Of the labels of a model file's header (model-format.md)."""
        count = len(labels)
        slips, wander, wavelengths = np.zeros(count), np.zeros((count, _FAMILIES)), np.ones((count, _FAMILIES))
        for row, label in enumerate(labels):
            for family, ribs in enumerate(label.get("rib_wander", ())):
                wander[row, family], wavelengths[row, family] = ribs["turns"], 1e3 * ribs["wavelength_metres"]
            if slip := label.get("stick_slip"):
                slips[row] = 1e-3 / slip["length_metres"]
                wander[row, _SLIP], wavelengths[row, _SLIP] = slip["wander"], 1e3 * slip["wander_metres"]
        return cls(slips, wander, wavelengths)


def phases_of(turns: _Doubles, rates_hz: _Doubles) -> NDArray[np.float32]:
    """Turns and rates [n, 3] as phases [n, 6]."""
    # Rounding could lift a phase just below one turn to 1.
    wrapped = np.mod(np.mod(turns, 1.0).astype(np.float32), np.float32(1.0))
    return np.concatenate([wrapped, rates_hz.astype(np.float32)], axis=1)


class PhaseTrack:
    """Phases [rows, 6] (models/surface_waves.py) along one path a row. Deterministic by its seed."""

    def __init__(self, statistics: SurfaceStatistics, rows: int, seed: int) -> None:
        self._statistics = statistics
        generator = np.random.default_rng([seed, 30])
        shape = rows, _FAMILIES, _WAVES
        angle = generator.uniform(0.0, 2.0 * math.pi, shape)
        stretch = 2.0 ** generator.uniform(-_OCTAVES, _OCTAVES, shape)
        # Cycles in one wavelength of the field, along both axes.
        self._directions = np.stack([np.cos(angle), np.sin(angle)], axis=-1) / stretch[..., None]
        self._offsets = generator.uniform(0.0, 1.0, shape)
        self._place_mm, self._turns = np.zeros((rows, 2)), np.zeros((rows, _FAMILIES))
        self._rates = np.zeros((rows, _FAMILIES))

    def advance(self, motion: NDArray[np.float32], samples: int) -> None:
        """Moves on by so many samples, at the rates of the newest `at`."""
        seconds = samples / SAMPLE_RATE_HZ
        self._place_mm += 1000.0 * seconds * motion[:, :2]
        self._turns = np.mod(self._turns + self._rates * seconds, 1.0)

    def at(
        self, embeddings: NDArray[np.float32], labels: NDArray[np.int64], motion: NDArray[np.float32]
    ) -> NDArray[np.float32]:
        """The phases here under embeddings [rows, 64] of these label indices [rows] and motion [rows, 3]."""
        statistics = self._statistics
        vectors = embeddings[:, -WAVE_NUMBERS:].astype(np.float64).reshape(-1, WAVE_VECTORS, 2)
        velocity_mmps = 1000.0 * motion[:, :2].astype(np.float64)
        field, along = self._field(statistics.wavelengths_mm[labels], velocity_mmps)
        wander = statistics.wander[labels]
        speed = np.hypot(*velocity_mmps.T)
        press = np.maximum(motion[:, 2].astype(np.float64), LIGHTEST_SLIP_NEWTONS) ** SLIP_FORCE_EXPONENT
        slip_rate = speed * statistics.slips_per_mm[labels] / press * np.exp(-wander[:, _SLIP] * field[:, _SLIP])
        self._rates = np.column_stack([np.einsum("rkc,rc->rk", vectors, velocity_mmps), slip_rate])
        turns, rates = self._turns.copy(), self._rates.copy()
        turns[:, :_SLIP] += (wander * field)[:, :_SLIP]
        rates[:, :_SLIP] += (wander * along)[:, :_SLIP]
        return phases_of(turns, rates)

    def _field(self, wavelengths_mm: _Doubles, velocity_mmps: _Doubles) -> tuple[_Doubles, _Doubles]:
        """The smooth fields of RMS 1, [rows, 3], and their change per second along the path."""
        cycles = self._directions / wavelengths_mm[:, :, None, None]
        angle = 2.0 * math.pi * (np.einsum("rfmc,rc->rfm", cycles, self._place_mm) + self._offsets)
        rate = 2.0 * math.pi * np.einsum("rfmc,rc->rfm", cycles, velocity_mmps)
        size = math.sqrt(2.0 / _WAVES)
        return size * np.cos(angle).sum(axis=2), -size * (rate * np.sin(angle)).sum(axis=2)
