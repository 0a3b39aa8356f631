"""The store of prepared recordings: `store.json` beside four raw little-endian arrays, opened without copying.

`waveform.f32` [total] holds m/s^2 divided by `peak_mps2`; `motion.f32` [total, 3] holds vx, vy in m/s and
force in N; `position.f32` [total, 2] holds the place on the surface in mm; `wander.f32` [total, 3] holds by how many
turns ribs lie ahead of evenly spaced ones, and the phase of stick and slip in turns, 0 to below 1 (zero where unknown).
`store.json` is written last: a folder without it is unfinished.
"""

from __future__ import annotations

import dataclasses
import json
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.errors import InputError
from haptoflow_training.preprocessing.settings import SETTINGS
from haptoflow_training.preprocessing.split import Split
from haptoflow_training.recordings.recording import Protocol

STORE_VERSION = 3
STORE_FILE = "store.json"
WAVEFORM_FILE = "waveform.f32"
MOTION_FILE = "motion.f32"
POSITION_FILE = "position.f32"
WANDER_FILE = "wander.f32"
ARRAY_FILES = (WAVEFORM_FILE, MOTION_FILE, POSITION_FILE, WANDER_FILE)
STORED_FLOAT = np.dtype("<f4")


@dataclass(frozen=True)
class StoredRecording:
    """The place of one recording in the arrays: [start, start + length), including the silence added at its ends.
    specimen: the piece of the material that was recorded; None if unknown."""

    name: str
    label: str
    label_index: int
    texture_id: int
    protocol: Protocol
    direction_degrees: int | None
    speed_mmps: int
    force_millinewtons: int
    repeat: int
    split: Split
    start: int
    length: int
    padding_before: int
    padding_after: int
    peak_mps2: float
    specimen: int | None

    @property
    def samples(self) -> slice:
        return slice(self.start, self.start + self.length)

    @property
    def recorded_samples(self) -> slice:
        """The samples without the silence that preparation added before and after."""
        return slice(self.start + self.padding_before, self.start + self.length - self.padding_after)


@dataclass(frozen=True)
class SkippedRecording:
    """A recording that could not be prepared, with the reason. label: empty in stores of older versions."""

    name: str
    reason: str
    label: str = ""

    def __str__(self) -> str:
        return f"{self.name}: {self.reason}"


@dataclass(frozen=True)
class SegmentStore:
    """waveform: [total] float32, unit scale (not clipped: a fifth of the recordings peaks above 1). motion: [total,
    3] float32: vx, vy in m/s, force in N. position_mm: [total, 2] float32: the place on the surface. wander_turns:
    [total, 3] float32: as of Wander (recording.py), the last column modulo 1. All are read-only memory maps, which
    processes can share. ribs_followed: the wander is that of the vibration's fundamental (found_wave_vectors.py), which the filter
    of a surface delays, instead of the surface's own. notes: what the reader of the recordings ignored or corrected, one
    sentence each."""

    path: Path
    waveform: NDArray[np.float32]
    motion: NDArray[np.float32]
    position_mm: NDArray[np.float32]
    wander_turns: NDArray[np.float32]
    labels: list[str]
    recordings: list[StoredRecording]
    skipped: list[SkippedRecording]
    peak_mps2: float
    sample_rate_hz: int
    seed: int
    provenance: dict[str, Any]
    ribs_followed: bool = False
    notes: list[str] = field(default_factory=list)

    def split(self, name: Split) -> list[StoredRecording]:
        return [recording for recording in self.recordings if recording.split == name]

    @classmethod
    def open(cls, path: Path | str) -> SegmentStore:
        """Open a store. InputError names file and remedy if it is missing, unfinished, damaged or of a newer
        version."""
        root = Path(path)
        header = _read_header(root)
        try:
            recordings = [StoredRecording(**entry) for entry in header["recordings"]]
            skipped = [SkippedRecording(**entry) for entry in header["skipped"]]
            total = sum(recording.length for recording in recordings)
            return cls(
                path=root,
                waveform=_map(root / WAVEFORM_FILE, (total,)),
                motion=_map(root / MOTION_FILE, (total, 3)),
                position_mm=_map(root / POSITION_FILE, (total, 2)),
                wander_turns=_map(root / WANDER_FILE, (total, 3)),
                labels=list(header["labels"]),
                recordings=recordings,
                skipped=skipped,
                peak_mps2=float(header["normalisation"]["peak_mps2"]),
                sample_rate_hz=int(header["sample_rate_hz"]),
                seed=int(header["seed"]),
                provenance=header["provenance"],
                notes=list(header.get("notes", ())),
            )
        except (KeyError, TypeError, ValueError) as error:
            raise InputError(f"{root / STORE_FILE}: damaged ({error}); run prepare again") from error


def write_header(
    root: Path,
    *,
    labels: list[str],
    recordings: list[StoredRecording],
    skipped: list[SkippedRecording],
    notes: list[str],
    peak_mps2: float,
    seed: int,
    provenance: dict[str, Any],
) -> None:
    """Write the header, which marks the store in `root` as complete."""
    header = {
        "version": STORE_VERSION,
        "sample_rate_hz": SETTINGS.sample_rate_hz,
        "normalisation": {"unit": "m/s^2", "peak_mps2": peak_mps2},
        "labels": labels,
        "seed": seed,
        "settings": dataclasses.asdict(SETTINGS),
        "provenance": provenance,
        "notes": notes,
        "skipped": [dataclasses.asdict(entry) for entry in skipped],
        "recordings": [dataclasses.asdict(recording) for recording in recordings],
    }
    (root / STORE_FILE).write_text(json.dumps(header, indent=1) + "\n", encoding="utf-8")


def _read_header(root: Path) -> dict[str, Any]:
    header_path = root / STORE_FILE
    if not header_path.is_file():
        if any((root / name).exists() for name in ARRAY_FILES):
            raise InputError(f"{root}: an unfinished store ({STORE_FILE} is missing); run prepare again")
        raise InputError(f"{root}: not a store; expected a folder with {STORE_FILE}, made by prepare")
    try:
        header = json.loads(header_path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, json.JSONDecodeError) as error:
        raise InputError(f"{header_path}: not readable as JSON ({error}); run prepare again") from error
    version = header.get("version") if isinstance(header, dict) else None
    if version != STORE_VERSION:
        raise InputError(
            f"{header_path}: store version {version}, expected {STORE_VERSION}; run prepare again"
        )
    return header


def _map(path: Path, shape: tuple[int, ...]) -> NDArray[np.float32]:
    expected = int(np.prod(shape)) * STORED_FLOAT.itemsize
    found = path.stat().st_size if path.is_file() else -1
    if found != expected:
        what = "missing" if found < 0 else f"{found} bytes long"
        raise InputError(f"{path}: {what}, expected {expected} bytes; run prepare again")
    return np.memmap(path, dtype=STORED_FLOAT, mode="r", shape=shape)


try:
    import fcntl
except ImportError:  # Windows: two programs must not prepare one store at a time.
    fcntl = None  # type: ignore[assignment]


@contextmanager
def store_lock(out: Path) -> Iterator[None]:
    """Hold the lock file beside the store `out`; waits, and says so, while another program holds it.

    The lock ends with the program that holds it, however that ends; worker processes do not inherit it. It must not
    be taken twice by one program.
    """
    if fcntl is None:
        yield
        return
    path = Path(out).absolute()
    path = path.with_name(path.name + ".lock")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        descriptor = _locked(path)
    except OSError as error:
        raise InputError(f"{path}: cannot be written ({error.strerror}); choose another folder") from error
    try:
        yield
    finally:
        # Removed while it is locked: whoever waits for it notices, and makes a new one.
        path.unlink(missing_ok=True)
        os.close(descriptor)


def _locked(path: Path) -> int:
    while True:
        descriptor = os.open(path, os.O_RDWR | os.O_CREAT, 0o666)
        try:
            _lock(descriptor, path)
            if path.exists() and os.path.samestat(os.fstat(descriptor), path.stat()):
                return descriptor
        except BaseException:
            os.close(descriptor)
            raise
        os.close(descriptor)


def _lock(descriptor: int, path: Path) -> None:
    try:
        fcntl.lockf(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        print(f"waiting: another program prepares {path.with_suffix('')}", file=sys.stderr)
        fcntl.lockf(descriptor, fcntl.LOCK_EX)
    except PermissionError:
        # Some systems report a held lock so.
        fcntl.lockf(descriptor, fcntl.LOCK_EX)
