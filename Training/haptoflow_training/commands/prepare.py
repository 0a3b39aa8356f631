"""`haptoflow-training prepare`: turn recordings into a memory-mapped store of 2 kHz training arrays."""

from __future__ import annotations

import argparse
import time
from collections.abc import Collection
from pathlib import Path

from haptoflow_training.errors import InputError
from haptoflow_training.preprocessing.preparation import prepare_store
from haptoflow_training.preprocessing.split import SPLITS
from haptoflow_training.preprocessing.store import SegmentStore, store_lock
from haptoflow_training.recordings.dataset import Dataset
from haptoflow_training.recordings.labels import LabelMap, load_labels
from haptoflow_training.recordings.open_recordings import open_with_labels

_DESCRIPTION = """\
Turn recordings into what training reads: one axis of vibration (DFT321) at 2 kHz with the velocity and force
of every sample, split 70:10:20 by recording (by time where a label has too few), silence put at some ends. The
store is a folder of three files;
it appears when it is complete, and an older one at the same place is replaced only then.

Broken recordings are skipped and listed. Without --labels, the Cluster Haptic Texture Dataset (known by its
texture_list.xlsx or provenance.json) takes the labels of configs/labels-cluster.toml; all others take their textures'
names."""

_EXAMPLES = """\
examples:
  haptoflow-training prepare --recordings cluster-haptic-texture --out store
  haptoflow-training prepare --recordings machine hand --out store --seed 7 --workers 2"""


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.description = _DESCRIPTION
    parser.epilog = _EXAMPLES
    add = parser.add_argument
    add("--recordings", metavar="DIR", type=Path, nargs="+", required=True, help="folders, or files")
    add("--labels", metavar="FILE", type=Path, help="TOML file: labels and their textures")
    add("--out", metavar="STORE", type=Path, required=True, help="folder of the store")
    add("--seed", metavar="N", type=int, default=0, help="draws the split and the silence (default 0)")
    add("--workers", metavar="N", type=int, default=1, help="processes; the result is the same (default 1)")


def run(options: argparse.Namespace) -> int:
    datasets = [open_with_labels(folder, options.labels) for folder in options.recordings]
    entries = [entry for dataset in datasets for entry in dataset]
    if not entries:
        first = next((f"; the first problem: {problem}" for dataset in datasets for problem in dataset.problems), "")
        raise InputError(f"{', '.join(map(str, options.recordings))}: no recording with a label{first}")
    for line in (line for dataset in datasets for line in dataset.said):
        print(line)
    begun = time.perf_counter()
    with store_lock(options.out):
        store = prepare_store(
            entries,
            _labels(datasets, options.labels),
            options.out,
            options.seed,
            provenance={"recordings": [dataset.provenance for dataset in datasets]},
            workers=options.workers,
            # Synthetic recordings are split by their names alone.
            is_cut=not all(dataset.synthetic for dataset in datasets),
        )
    _report(store, time.perf_counter() - begun, [note for dataset in datasets for note in dataset.notes])
    return 0


def _labels(datasets: list[Dataset], labels_path: Path | None) -> list[str]:
    """The labels in the order of the labels file; labels without a recording get no index."""
    present = list(dict.fromkeys(label for dataset in datasets for label in dataset.labels))
    if labels_path is None and not all(dataset.published for dataset in datasets):
        return present
    order: LabelMap = load_labels(labels_path)
    return [name for name in order.names if name in present]


def _report(store: SegmentStore, elapsed_seconds: float, said: Collection[str]) -> None:
    seconds = len(store.waveform) / store.sample_rate_hz
    shares = ", ".join(f"{name} {len(store.split(name))}" for name in SPLITS)
    print(
        f"{store.path}: {len(store.recordings)} recordings ({shares}), {seconds / 60:.1f} minutes, "
        f"{len(store.labels)} labels, 1.0 = {store.peak_mps2:.2f} m/s^2; "
        f"{seconds / max(elapsed_seconds, 1e-9):.0f} x real time"
    )
    for skipped in store.skipped:
        print(f"skipped: {skipped}")
    for note in store.notes:
        if note not in said:
            print(note)
