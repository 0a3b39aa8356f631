"""`haptoflow-benchmark evaluate`: compare a model with own recordings."""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tqdm import tqdm

from haptoflow_benchmark.own_accuracy import (
    HeldOutPart, LabelAccuracy, RenderedPart, label_accuracy, lines, render_learnt, render_parts, verdict,
    write_own_report
)
from haptoflow_training.errors import InputError
from haptoflow_training.export.model_file import read_model_file
from haptoflow_training.model_stamp import SHIPPED_MODEL, sha256_of
from haptoflow_training.preprocessing.preparation import prepare_store
from haptoflow_training.preprocessing.split import Split
from haptoflow_training.preprocessing.store import SegmentStore, StoredRecording
from haptoflow_training.recordings.dataset import Dataset
from haptoflow_training.recordings.open_recordings import RecordingFile, open_with_labels
from haptoflow_training.training.found_wave_vectors import turned_store

ROOT = Path(__file__).resolve().parents[3]
ENGINE = ROOT / "build" / "native" / "haptoflow"
_NOT_WORTH_USING = 3


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.description = (
        "Compares a model with recordings of your own: the held-out parts are rendered by the engine, and level, "
        "GFC and LSD of each label are printed; --out also writes them, with a picture."
    )
    parser.epilog = (
        "example:\n"
        "  haptoflow-benchmark evaluate --model own.haptoflow --recordings recordings --out out/own/accuracy\n"
        "The rows of the table of accuracy and time are measured by `haptoflow-paper evaluate`."
    )
    add_recording_options(parser)
    parser.add_argument(
        "--model", type=Path, default=ROOT / SHIPPED_MODEL, metavar="FILE",
        help="the model file (default: the shipped one)",
    )  # fmt: skip
    parser.add_argument(
        "--engine", type=Path, default=ENGINE, help="the built command line (default: build/native/haptoflow)"
    )
    parser.add_argument(
        "--beside-learn", action="store_true",
        help="also learn each label from the recordings that the model was trained on (about 7 s each), and say whether the "
        "model is worth using; the exit code is 3 if it is not",
    )  # fmt: skip
    parser.add_argument("--out", type=Path, help="for own-accuracy.json, .md and .png (default: printed only)")


def run(options: argparse.Namespace) -> int:
    """Print the table; with --out, write it with its figures and the picture into that folder."""
    model = options.model
    require_engine(options.engine)
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        parts = own_parts(options, model, folder)
        with tqdm(total=len(parts.held_out), unit="part", desc="render") as bar:
            rendered = render_parts(
                parts.held_out, engine=options.engine, model=model, folder=folder, advance=bar.update
            )
        by_label, found = _measured(rendered)
        print("\n".join(lines(found)))
        decided = _beside_learning(options, parts, found, folder) if options.beside_learn else None
    if options.out is not None:
        write_own_report(options.out, found, by_label, sha256_of(model))
        print(f"evaluate: {options.out / 'own-accuracy.json'}, .md and .png")
    if decided is not None:
        print(decided[0])
    return _NOT_WORTH_USING if decided is not None and decided[1] else 0


def _measured(rendered: list[RenderedPart]) -> tuple[dict[str, list[RenderedPart]], list[LabelAccuracy]]:
    by_label: dict[str, list[RenderedPart]] = {}
    for entry in rendered:
        by_label.setdefault(entry.part.label, []).append(entry)
    measured = {label: label_accuracy(label, entries) for label, entries in by_label.items()}
    for label in [label for label, one in measured.items() if one is None]:
        print(f"{label}: left out: no 0.2 s of its held-out parts in which the tip moves", file=sys.stderr)
    found = [one for one in measured.values() if one is not None]
    if not found:
        raise InputError("no held-out part is long enough: record 5 s of each label at least, with a tip that moves")
    return by_label, found


def _beside_learning(
    options: argparse.Namespace, parts: OwnParts, found: list[LabelAccuracy], folder: Path
) -> tuple[str, bool]:
    """As of `verdict`."""
    compared = {one.label for one in found}
    held_out = [part for part in parts.held_out if part.label in compared]
    with tqdm(total=len(compared), unit="label", desc="haptoflow learn") as bar:
        rendered = render_learnt(
            parts.seen, held_out, parts.turned_degrees,
            base=ROOT / SHIPPED_MODEL, engine=options.engine, folder=folder, advance=bar.update,
        )  # fmt: skip
    return verdict(found, _measured(rendered)[1])


@dataclass(frozen=True)
class OwnParts:
    """held_out: recordings outside the model's training. seen: recordings of its training, or possibly of it. Both are in
    the frame of the model's labels: turned_degrees, by label, from the recordings' own."""

    held_out: list[HeldOutPart]
    seen: list[HeldOutPart]
    turned_degrees: Mapping[str, float]


def add_recording_options(parser: argparse.ArgumentParser) -> None:
    """Add --recordings, --labels and --all, which mean the same in both commands."""
    parser.add_argument(
        "--recordings", type=Path, nargs="+", metavar="PATH",
        help="folders of recordings, or files, to compare a model with",
    )  # fmt: skip
    parser.add_argument(
        "--labels", type=Path, metavar="FILE", help="TOML file of labels and their textures, as for `train`"
    )
    parser.add_argument(
        "--all", action="store_true", dest="everything",
        help="compare with all recordings, because the model was not trained on them",
    )  # fmt: skip


def require_engine(engine: Path) -> None:
    """InputError if the command line is not built."""
    if not engine.is_file():
        raise InputError(f"{engine} does not exist: run `npm run build`, or name the command line with --engine")


def own_parts(options: argparse.Namespace, model: Path, folder: Path) -> OwnParts:
    """Prepare the recordings into `folder`; prints which are left out, and why. InputError if nothing can be
    compared."""
    if not options.recordings:
        raise InputError("--recordings is missing: name the folder of recordings to compare the model with")
    header = read_model_file(model).header
    known = [label["name"] for label in header["labels"]]
    datasets = [open_with_labels(path, options.labels) for path in options.recordings]
    entries = [entry for dataset in datasets for entry in dataset if entry.label in known]
    _say_what_is_left_out(datasets, known, model)
    if not entries:
        found = dict.fromkeys(entry.label for dataset in datasets for entry in (*dataset, *dataset.unlabelled))
        raise InputError(
            f"{', '.join(map(str, options.recordings))}: no recording of a label of {model.name}; found "
            f"{', '.join(label or 'files without a label' for label in found) or 'nothing'}, expected "
            f"{', '.join(known)} (--labels FILE maps textures to labels)"
        )
    turned_degrees = header.get("provenance", {}).get("turned_degrees", {})
    store = turned_store(_prepared(entries, known, header, folder / "store", options.everything), turned_degrees)
    for skipped in store.skipped:
        print(f"skipped: {skipped}", file=sys.stderr)
    if options.everything:
        return OwnParts(_parts(store, None), [], turned_degrees)
    held_out = _parts(store, "test")
    if not held_out:
        raise InputError(
            f"{', '.join(map(str, options.recordings))}: nothing is held out of these recordings: they are too short to "
            "be split by time; record 5 s at least, or compare with all of them (--all) if the model was not "
            "trained on them"
        )
    return OwnParts(held_out, [*_parts(store, "train"), *_parts(store, "validation")], turned_degrees)


def _say_what_is_left_out(datasets: list[Dataset], known: list[str], model: Path) -> None:
    for dataset in datasets:
        lines = [f"skipped: {problem}" for problem in dataset.problems]
        lines += [dataset.left_out] if dataset.left_out else []
        foreign = dict.fromkeys(entry.label for entry in dataset if entry.label not in known)
        lines += [f"{dataset.root}: left out: {model.name} has no label {', '.join(foreign)}"] if foreign else []
        for line in lines:
            print(line, file=sys.stderr)


def _prepared(
    entries: list[RecordingFile], known: list[str], header: dict[str, Any], out: Path, everything: bool
) -> SegmentStore:
    """The recordings, split as for the model's training."""
    found = {entry.label for entry in entries}
    labels = [name for name in known if name in found]
    data = header.get("provenance", {}).get("configuration", {}).get("data", {})
    seed = int(data.get("recordings_seed", 1))
    return prepare_store(entries, labels, out, seed=seed, is_cut=not everything)


def _parts(store: SegmentStore, split: Split | None) -> list[HeldOutPart]:
    return [_part(store, one) for one in store.recordings if split is None or one.split == split]


def _part(store: SegmentStore, one: StoredRecording) -> HeldOutPart:
    samples = one.recorded_samples
    return HeldOutPart(one.name, one.label, store.waveform[samples] * store.peak_mps2, store.motion[samples])
