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
from pathlib import Path
from typing import Any, BinaryIO, Protocol

import numpy as np
from numpy.typing import NDArray
from tqdm import tqdm

from haptoflow_training.errors import InputError
from haptoflow_training.preprocessing import store as store_module
from haptoflow_training.preprocessing.pipeline import PreparedRecording, pad_recording, preprocess_parts
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


# A recording or a part of one, its place in the store not yet known, with its samples; or why there are none.
_Prepared = tuple[StoredRecording, PreparedRecording] | SkippedRecording
# The parts of one recording, and what its reader ignored or corrected.
_Parts = tuple[list[_Prepared], tuple[str, ...]]


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
            stored, skipped, notes = _append_all(bar, unfinished)
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
) -> Iterator[_Parts]:
    tasks = (
        (item, labels.index(item.label), seed, item.label in cut_labels) for item in _checked(recordings, labels)
    )
    if workers <= 1:
        yield from (_prepare_one(*task) for task in tasks)
        return
    pending: deque[Future[_Parts]] = deque()
    with ProcessPoolExecutor(workers, initializer=_join_parent) as pool:
        try:
            for task in tasks:
                pending.append(pool.submit(_prepare_one, *task))
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


def _prepare_one(item: Recording | LoadableRecording, label_index: int, seed: int, is_cut: bool) -> _Parts:
    """One prepared recording for each stretch between gaps, or for each of its parts, or the reason why there is
    none."""
    try:
        recording = item if isinstance(item, Recording) else item.load()
        stretches = preprocess_parts(recording)
    except InputError as error:
        return [SkippedRecording(item.identity.name, str(error), item.label)], ()
    parts: list[tuple[str, Split, PreparedRecording]] = []
    pieces = dict.fromkeys(SPLITS, 0)
    for number, stretch in enumerate(stretches):
        name = item.identity.name if number == 0 else f"{item.identity.name} part {number + 1}"
        times = time_parts(len(stretch.waveform_mps2)) if is_cut else []
        if not times:
            parts.append((name, split_of(item.identity, seed), stretch))
        for split, samples in times:
            pieces[split] += 1
            parts.append((f"{name} {split} {pieces[split]}", split, stretch.part(samples)))
    return [_prepare_part(recording, item, label_index, seed, *part) for part in parts], recording.notes


def _prepare_part(
    recording: Recording,
    item: Recording | LoadableRecording,
    label_index: int,
    seed: int,
    name: str,
    split: Split,
    part: PreparedRecording,
) -> _Prepared:
    peak_mps2 = float(np.abs(part.waveform_mps2).max())
    if peak_mps2 == 0.0:
        return SkippedRecording(name, "acceleration never changes; expected a vibration", item.label)
    padded, padding_before, padding_after = pad_recording(part, name, seed)
    conditions = dataclasses.asdict(item.identity)
    del conditions["file_name"]
    stored = StoredRecording(
        name=name,
        label=item.label,
        label_index=label_index,
        protocol=item.identity.protocol,
        **conditions,
        split=split,
        start=0,
        length=len(padded.waveform_mps2),
        padding_before=padding_before,
        padding_after=padding_after,
        peak_mps2=peak_mps2,
        specimen=recording.specimen,
    )
    return stored, padded


def _append_all(
    prepared: Iterable[_Parts], folder: Path
) -> tuple[list[StoredRecording], list[SkippedRecording], list[str]]:
    stored: list[StoredRecording] = []
    skipped: list[SkippedRecording] = []
    notes: dict[str, None] = {}
    start = 0
    with ExitStack() as opened:
        files = [opened.enter_context((folder / name).open("wb")) for name in store_module.ARRAY_FILES]
        for parts, said in prepared:
            notes.update(dict.fromkeys(said))
            for part in parts:
                end_if_stopped()
                if isinstance(part, SkippedRecording):
                    skipped.append(part)
                    continue
                entry, whole = part
                arrays = (whole.waveform_mps2, whole.motion, whole.position_mm, _stored_wander(whole.wander_turns))
                for file, values in zip(files, arrays, strict=True):
                    _append(file, values)
                stored.append(dataclasses.replace(entry, start=start))
                start += entry.length
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
