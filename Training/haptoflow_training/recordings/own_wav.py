"""Reads an own WAV file: acceleration of one or three axes, scaled by its sidecar."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np

from haptoflow_training.recordings.cluster_dataset_files import DatasetFileError
from haptoflow_training.recordings.own_sidecar import MAXIMUM_RATE_HZ, MINIMUM_RATE_HZ, Sidecar
from haptoflow_training.recordings.own_table import Series

_EXPECTED = "a WAV file of 1 or 3 channels, PCM or float"
# The value that represents +1 in each sample type; 24-bit samples are read into the upper bits of 32.
_FULL_SCALE = {"uint8": 2.0**7, "int16": 2.0**15, "int32": 2.0**31, "int64": 2.0**63}


def read_own_wav(path: Path, sidecar: Sidecar) -> Series:
    """Acceleration in m/s^2; DatasetFileError names file or key, what was found and what is expected."""
    from scipy.io import wavfile

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", wavfile.WavFileWarning)
            rate_hz, samples = wavfile.read(path)
    except (OSError, ValueError, EOFError) as error:
        raise DatasetFileError(path, f"not read as WAV ({error})", _EXPECTED) from error
    if not MINIMUM_RATE_HZ <= rate_hz <= MAXIMUM_RATE_HZ:
        raise DatasetFileError(path, f"{rate_hz} samples a second", "1000 to 192000")
    values = samples.reshape(len(samples), -1)
    if values.shape[1] not in (1, 3):
        raise DatasetFileError(path, f"{values.shape[1]} channels", "1 or 3: one axis, or X, Y and Z")
    if len(values) < 4:
        raise DatasetFileError(path, f"{len(values)} samples", "4 at least")
    if sidecar.full_scale_mps2 is None:
        expected = "\"full_scale_mps2\": the acceleration in m/s^2 that +-1 stands for"
        raise DatasetFileError(sidecar.path, f"no key 'full_scale_mps2' for {path.name}", expected)
    numbers = values.astype(np.float64)
    if samples.dtype.name == "uint8":
        numbers -= _FULL_SCALE["uint8"]
    numbers *= sidecar.full_scale_mps2 / _FULL_SCALE.get(samples.dtype.name, 1.0)
    if not np.isfinite(numbers).all():
        raise DatasetFileError(path, "samples that are not finite", "numbers only")
    channels = ("channel 1",) if values.shape[1] == 1 else ("channel 1", "channel 2", "channel 3")
    return Series(np.arange(len(numbers)) / float(rate_hz), numbers, channels)
