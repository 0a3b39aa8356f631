"""Writes recordings that a model generated, in the form that haptoflow_training/recordings/generated_dataset.py reads."""

from __future__ import annotations

import json
import os
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.errors import InputError
from haptoflow_training.recordings.generated_dataset import GENERATED_FILE, GeneratedOrigin, origin_of
from haptoflow_training.recordings.recording import RecordingIdentity

_Floats = NDArray[np.float32]


def start_generated(root: Path, origin: GeneratedOrigin) -> None:
    """Create the folder, or go on with one of the same origin; InputError if it holds recordings of another."""
    document = {"source": origin.source, "licence": origin.licence, "labels": list(origin.labels)}
    if (root / GENERATED_FILE).is_file() and origin_of(root) != origin:
        raise InputError(f"{root}: holds recordings of another origin; remove the folder or choose another")
    root.mkdir(parents=True, exist_ok=True)
    (root / GENERATED_FILE).write_text(json.dumps(document, indent=2, ensure_ascii=False) + "\n", encoding="utf-8")


def generated_path(root: Path, identity: RecordingIdentity) -> Path:
    return root / f"{identity.name}.npz"


def write_generated(path: Path, waveform_mps2: _Floats, motion: _Floats) -> None:
    """Write waveform [n] and motion [n, 3] (vx, vy in m/s, force in N), both at 2 kHz; the file appears whole or not at
    all."""
    unfinished = path.with_name(f".{os.getpid()}.{path.name}")
    try:
        np.savez(unfinished, waveform_mps2=waveform_mps2.astype(np.float32), motion=motion.astype(np.float32))
        unfinished.replace(path)
    finally:
        unfinished.unlink(missing_ok=True)
