"""Prepares a store from recordings: each worker holds one recording in memory; the store appears complete or not at
all."""

from __future__ import annotations

import dataclasses
import multiprocessing
import os
import shutil
import signal
import threading
from collections import deque
from collections.abc import Collection, Iterable, Iterator
from concurrent.futures import Future, ProcessPoolExecutor
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import Any, BinaryIO, Protocol

import numpy as np
from numpy.typing import NDArray
from tqdm import tqdm

from haptoflow_training.errors import InputError
from haptoflow_training.preprocessing import store as store_module
from haptoflow_training.preprocessing.pipeline import (
    PaddedRecording, PreparedRecording, pad_recording, preprocess_parts
)
from haptoflow_training.preprocessing.split import SPLITS, Split, labels_without_a_split, split_of, time_parts
from haptoflow_training.preprocessing.store import SegmentStore, SkippedRecording, StoredRecording
from haptoflow_training.recordings.recording import Recording, RecordingIdentity
from haptoflow_training.stopping import deferred, end_if_stopped

_PEAK_PERCENTILE = 80.0
_RESCALE_SAMPLES = 1 << 20


class LoadableRecording(Protocol):
    """A recording that is still on disk; it is loaded by a worker, so that reading is parallel too."""

    @property
    def identity(self) -> RecordingIdentity: ...

    @property
    def label(self) -> str: ...

    def load(self) -> Recording: ...


@dataclass(frozen=True)
class _Prepared:
    identity: RecordingIdentity
    label: str
    padded: PaddedRecording | None
    problem: str | None
    peak_mps2: float = 0.0
    # The index of a stretch between gaps, or of a part of a recording that is cut by time, with its split.
    part: int = 0
    split: Split | None = None
    piece: int = 0
    specimen: int | None = None
    # Of the reader of the whole recording.
    notes: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        name = self.identity.name if self.part == 0 else f"{self.identity.name} part {self.part + 1}"
        return name if self.split is None else f"{name} {self.split} {self.piece + 1}"


def prepare_store(
    recordings: Iterable[Recording | LoadableRecording],
    labels: list[str],
    out: Path,
    seed: int = 0,
    *,
    provenance: dict[str, Any] | None = None,
    workers: int = 1,
    is_cut: bool = False,
) -> SegmentStore:
    """Prepare every recording, in order, into the folder `out`; an older store there is replaced at the end.

    is_cut: recordings of labels with too few for every split are cut by time into training, validation and test
    (split.py), also if there are too few because others could not be prepared; one that is too short for that stays
    whole, in the split of its name. Without it, recordings are split by their names alone.

    A recording that cannot be prepared is skipped and listed in the store; one with gaps becomes one for each stretch
    between them. InputError: none was usable, a name occurred twice, a label is not in `labels`, or the disk is full;
    `out` is then unchanged. The result is the same for any number of `workers`. Two programs must not prepare one
    folder at a time: see store.py.
    """
    out = Path(out).absolute()
    cut_labels: list[str] = []
    if is_cut:
        recordings = list(recordings)
        cut_labels = labels_without_a_split((item.label, split_of(item.identity, seed)) for item in recordings)
    while True:
        store = _prepared_store(recordings, labels, out, seed, provenance or {}, workers, cut_labels)
        lacking = labels_without_a_split((one.label, one.split) for one in store.recordings) if is_cut else []
        further = [label for label in lacking if label not in cut_labels]
        if not further:
            return store
        cut_labels += further


def _prepared_store(
    recordings: Iterable[Recording | LoadableRecording],
    labels: list[str],
    out: Path,
    seed: int,
    provenance: dict[str, Any],
    workers: int,
    cut_labels: Collection[str],
) -> SegmentStore:
    if out.exists() and not _is_store_or_empty(out):
        raise InputError(f"{out}: holds files that are not a store; choose another folder for --out")
    unfinished = out.with_name(out.name + ".unfinished")
    try:
        shutil.rmtree(unfinished, ignore_errors=True)
        unfinished.mkdir(parents=True)
        prepared = _prepare_each(recordings, labels, seed, workers, cut_labels)
        with deferred():
            bar = tqdm(prepared, unit=" recordings", desc="prepare")
            stored, skipped, notes = _append_all(bar, labels, unfinished, seed)
        peak_mps2 = _peak(stored, skipped)
        _rescale(unfinished / store_module.WAVEFORM_FILE, peak_mps2)
        store_module.write_header(
            unfinished,
            labels=labels,
            recordings=stored,
            skipped=skipped,
            notes=notes,
            peak_mps2=peak_mps2,
            seed=seed,
            provenance=provenance,
        )
        end_if_stopped()
        _replace(unfinished, out)
    except OSError as error:
        raise InputError(
            f"{error.filename or out}: {error.strerror or error}; "
            "make room or choose another folder for --out (nothing was replaced)"
        ) from error
    finally:
        shutil.rmtree(unfinished, ignore_errors=True)
    return SegmentStore.open(out)


def _prepare_each(
    recordings: Iterable[Recording | LoadableRecording],
    labels: list[str],
    seed: int,
    workers: int,
    cut_labels: Collection[str],
) -> Iterator[list[_Prepared]]:
    checked = _checked(recordings, labels)
    if workers <= 1:
        yield from (_prepare_one(item, seed, item.label in cut_labels) for item in checked)
        return
    pending: deque[Future[list[_Prepared]]] = deque()
    with ProcessPoolExecutor(workers, initializer=_join_parent) as pool:
        try:
            for item in checked:
                pending.append(pool.submit(_prepare_one, item, seed, item.label in cut_labels))
                if len(pending) > 2 * workers:
                    yield pending.popleft().result()
            while pending:
                yield pending.popleft().result()
        finally:
            pool.shutdown(wait=True, cancel_futures=True)


def _join_parent() -> None:
    """A worker leaves signals to its parent, and ends with it: even if the parent is killed, which closes no queue."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    parent = multiprocessing.parent_process()

    def end_with_parent() -> None:
        if parent is not None:
            parent.join()
        os._exit(1)

    threading.Thread(target=end_with_parent, daemon=True).start()


def _checked(
    recordings: Iterable[Recording | LoadableRecording], labels: list[str]
) -> Iterator[Recording | LoadableRecording]:
    names: set[str] = set()
    for item in recordings:
        name = item.identity.name
        if name in names:
            raise InputError(
                f"recording {name} came twice; prepare folders with the same names into separate stores"
            )
        if item.label not in labels:
            raise InputError(
                f"recording {name} has label '{item.label}'; expected one of {', '.join(labels)}"
            )
        names.add(name)
        yield item


def _prepare_one(item: Recording | LoadableRecording, seed: int, is_cut: bool) -> list[_Prepared]:
    """One prepared recording for each stretch between gaps, or for each of its parts, or the reason why there is
    none."""
    try:
        recording = item if isinstance(item, Recording) else item.load()
        parts = preprocess_parts(recording)
    except InputError as error:
        return [_Prepared(item.identity, item.label, None, str(error))]
    prepared: list[_Prepared] = []
    pieces = dict.fromkeys(SPLITS, 0)
    for number, part in enumerate(parts):
        times = time_parts(len(part.waveform_mps2)) if is_cut else []
        if not times:
            prepared.append(_prepare_part(item, number, part, seed))
        for split, samples in times:
            prepared.append(_prepare_part(item, number, part.part(samples), seed, split, pieces[split]))
            pieces[split] += 1
    return [dataclasses.replace(one, specimen=recording.specimen, notes=recording.notes) for one in prepared]


def _prepare_part(
    item: Recording | LoadableRecording,
    number: int,
    part: PreparedRecording,
    seed: int,
    split: Split | None = None,
    piece: int = 0,
) -> _Prepared:
    peak_mps2 = float(np.abs(part.waveform_mps2).max())
    if peak_mps2 == 0.0:
        problem = "acceleration never changes; expected a vibration"
        return _Prepared(item.identity, item.label, None, problem, part=number, split=split, piece=piece)
    prepared = _Prepared(item.identity, item.label, None, None, peak_mps2, number, split, piece)
    return dataclasses.replace(prepared, padded=pad_recording(part, prepared.name, seed))


def _append_all(
    prepared: Iterable[list[_Prepared]], labels: list[str], folder: Path, seed: int
) -> tuple[list[StoredRecording], list[SkippedRecording], list[str]]:
    stored: list[StoredRecording] = []
    skipped: list[SkippedRecording] = []
    notes: dict[str, None] = {}
    start = 0
    with ExitStack() as opened:
        files = [opened.enter_context((folder / name).open("wb")) for name in store_module.ARRAY_FILES]
        for item in (part for parts in prepared for part in parts):
            end_if_stopped()
            notes.update(dict.fromkeys(item.notes))
            if item.padded is None:
                skipped.append(SkippedRecording(item.name, item.problem or "", item.label))
                continue
            whole = item.padded.prepared
            length = len(whole.waveform_mps2)
            arrays = (whole.waveform_mps2, whole.motion, whole.position_mm, _stored_wander(whole.wander_turns))
            for file, values in zip(files, arrays, strict=True):
                _append(file, values)
            identity = item.identity
            conditions = dataclasses.asdict(identity)
            del conditions["file_name"]
            stored.append(
                StoredRecording(
                    name=item.name,
                    label=item.label,
                    label_index=labels.index(item.label),
                    protocol=identity.protocol,
                    **conditions,
                    split=item.split or split_of(identity, seed),
                    start=start,
                    length=length,
                    padding_before=item.padded.padding_before,
                    padding_after=item.padded.padding_after,
                    peak_mps2=item.peak_mps2,
                    specimen=item.specimen,
                )
            )
            start += length
    return stored, skipped, list(notes)


def _stored_wander(turns: NDArray[np.float64]) -> NDArray[np.float32]:
    """The phase of stick and slip grows without bound, and float32 would lose its fraction: it is stored modulo 1."""
    stored = turns.astype(store_module.STORED_FLOAT)
    stored[:, -1] = np.mod(turns[:, -1], 1.0)
    stored[stored[:, -1] >= 1.0, -1] = 0.0
    return stored


def _append(file: BinaryIO, values: np.ndarray) -> None:
    file.write(np.ascontiguousarray(values, dtype=store_module.STORED_FLOAT).tobytes())


def _peak(stored: list[StoredRecording], skipped: list[SkippedRecording]) -> float:
    """The 80th percentile of the training recordings' peaks; test recordings do not influence the scale."""
    if not stored:
        first = f"; the first problem: {skipped[0].name}: {skipped[0].reason}" if skipped else ""
        raise InputError(f"no recording could be prepared ({len(skipped)} were skipped{first})")
    training = [recording.peak_mps2 for recording in stored if recording.split == "train"]
    return float(np.percentile(training or [recording.peak_mps2 for recording in stored], _PEAK_PERCENTILE))


def _rescale(path: Path, peak_mps2: float) -> None:
    waveform = np.memmap(path, dtype=store_module.STORED_FLOAT, mode="r+")
    for start in range(0, len(waveform), _RESCALE_SAMPLES):
        waveform[start : start + _RESCALE_SAMPLES] /= np.float32(peak_mps2)
    waveform.flush()


def _is_store_or_empty(out: Path) -> bool:
    ours = {store_module.STORE_FILE, *store_module.ARRAY_FILES}
    return out.is_dir() and {entry.name for entry in out.iterdir()} <= ours


def _replace(finished: Path, out: Path) -> None:
    previous = out.with_name(out.name + ".previous")
    if out.exists():
        shutil.rmtree(previous, ignore_errors=True)
        os.replace(out, previous)
    try:
        os.replace(finished, out)
    except OSError:
        if previous.exists():
            os.replace(previous, out)
        raise
    shutil.rmtree(previous, ignore_errors=True)
