"""What reading and preparation lose of a mirror with faults: level, spectrum, force and speed beside the clean files."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from haptoflow_benchmark.metrics.waveform_metrics import (
    gfc_recording,
    level_error_db,
    log_spectral_distance_db,
)
from haptoflow_benchmark.mirror.faults import ALL_FAULTS, Fault, MachinePass
from haptoflow_training.preprocessing.pipeline import PreparedRecording
from haptoflow_training.recordings.recording import Recording

Preparation = Callable[[Recording], PreparedRecording]
_CLEAN: frozenset[Fault] = frozenset()


@dataclass(frozen=True)
class Loss:
    """One label's prepared passes with faults beside the same without. level_db: signed. lsd_db, gfc: of the spectra of all
    passes together. force, speed: the median ratio to the clean one, minus 1."""

    level_db: float
    lsd_db: float
    gfc: float
    force: float
    speed: float


def mirror_rows() -> dict[str, frozenset[Fault]]:
    """The faults of each row of the table: each alone, all but the apparatus, all."""
    rows = {fault.value: frozenset([fault]) for fault in Fault}
    return rows | {"all but the apparatus": ALL_FAULTS - {Fault.APPARATUS}, "all": ALL_FAULTS}


def losses_of(
    passes: Sequence[MachinePass], rows: dict[str, frozenset[Fault]], prepare: Preparation
) -> dict[str, Loss]:
    """The losses of one label, for each row of faults."""
    clean = [prepare(each.recorded(_CLEAN)) for each in passes]
    return {name: _loss(clean, [prepare(each.recorded(faults)) for each in passes]) for name, faults in rows.items()}


def _loss(clean: Sequence[PreparedRecording], faulty: Sequence[PreparedRecording]) -> Loss:
    common = [min(len(one.waveform_mps2), len(other.waveform_mps2)) for one, other in zip(clean, faulty, strict=True)]

    def together(prepared: Sequence[PreparedRecording]) -> NDArray[np.float64]:
        return np.concatenate(
            [each.waveform_mps2[:count].astype(np.float64) for each, count in zip(prepared, common, strict=True)]
        )

    def ratio(of: Callable[[PreparedRecording], NDArray[np.floating]]) -> float:
        return float(np.median([np.median(of(one)) / np.median(of(other)) for one, other in zip(faulty, clean, strict=True)]))

    made, true = together(faulty), together(clean)
    return Loss(
        level_error_db(made, true),
        log_spectral_distance_db(made, true),
        gfc_recording(made, true),
        ratio(lambda each: each.motion[:, 2]) - 1.0,
        ratio(lambda each: np.hypot(each.motion[:, 0], each.motion[:, 1])) - 1.0,
    )


def median_loss(losses: Collection[Loss]) -> Loss:
    """The median over labels, of sizes for the level."""
    values = np.array([[abs(each.level_db), each.lsd_db, each.gfc, each.force, each.speed] for each in losses])
    return Loss(*map(float, np.median(values, axis=0)))
