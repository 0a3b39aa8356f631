"""Recordings in the form that fits one material: 2 kHz, one axis, the motion of every sample."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.errors import InputError
from haptoflow_training.preprocessing.pipeline import preprocess_parts
from haptoflow_training.recordings.open_recordings import RecordingFile, open_recordings


@dataclass(frozen=True)
class MaterialRecording:
    """One stretch without gaps, filtered and trimmed as for training.

    name: of the file, with its part if gaps divide it. label: empty if not stated. vibration_mps2: [n] at 2 kHz, m/s^2.
    velocity_mps: [n, 2]. force_newtons: [n]. licence, source: `unknown` if not stated.
    """

    name: str
    label: str
    vibration_mps2: NDArray[np.float32]
    velocity_mps: NDArray[np.float32]
    force_newtons: NDArray[np.float32]
    licence: str
    source: str

    @property
    def seconds(self) -> float:
        return len(self.vibration_mps2) / 2000.0


def material_files(paths: Sequence[Path | str], tell: Callable[[str], None]) -> list[RecordingFile]:
    """Every recording in files and folders (own files, or the published data set's layout), described and not yet read.

    tell: called with a line for each recording of a folder that cannot be used. InputError, naming file, column or key,
    what was found and what is expected, if a file that was named itself cannot be used, or if nothing can.
    """
    files: list[RecordingFile] = []
    for path in paths:
        dataset = open_recordings(path)
        found = (*dataset.recordings, *dataset.unlabelled)
        for problem in dataset.problems:
            if not found:
                raise InputError(str(problem))
            tell(f"skipped: {problem}")
        files += found
    if not files:
        raise InputError(f"{', '.join(map(str, paths))}: no recording; expected .csv, .parquet or .wav files")
    return files


def read_material_recordings(files: Sequence[RecordingFile], tell: Callable[[str], None]) -> list[MaterialRecording]:
    """The samples of recordings, prepared as for training. tell: called with a line for each one that cannot be used,
    and with what the reader ignored or corrected. InputError if none can be used."""
    recordings: list[MaterialRecording] = []
    for entry in files:
        try:
            read = entry.load()
            parts = preprocess_parts(read)
        except InputError as error:
            if len(files) == 1:
                raise
            tell(f"skipped: {error}")
            continue
        for note in read.notes:
            tell(note)
        for number, part in enumerate(parts):
            name = entry.identity.name if number == 0 else f"{entry.identity.name} part {number + 1}"
            recordings.append(
                MaterialRecording(
                    name, entry.label, part.waveform_mps2, part.motion[:, :2].copy(), part.motion[:, 2].copy(),
                    entry.licence, entry.source,
                )  # fmt: skip
            )
    if not recordings:
        raise InputError("no recording could be used")
    return recordings
