"""Recordings in the form that fits one material: 2 kHz, one axis, the motion of every sample."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from haptoflow_training.errors import InputError
from haptoflow_training.preprocessing.pipeline import preprocess_parts
from haptoflow_training.recordings.native_recording import MaterialRecording
from haptoflow_training.recordings.open_recordings import RecordingFile, open_recordings


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
        recordings += [MaterialRecording(part.waveform_mps2, part.motion) for part in parts]
    if not recordings:
        raise InputError("no recording could be used")
    return recordings
