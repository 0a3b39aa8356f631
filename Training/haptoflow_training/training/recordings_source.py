"""Prepares the store of a run's [data] section, from synthetic recordings or data set folders."""

from __future__ import annotations

import dataclasses
import hashlib
import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from haptoflow_training.errors import InputError
from haptoflow_training.recordings.landing import LabelInfo, landing_of, landing_of_spring, rib_wander_of, stick_slip_of
from haptoflow_training.preprocessing.preparation import prepare_store
from haptoflow_training.training.found_wave_vectors import with_found_ribs, with_rib_phases
from haptoflow_training.preprocessing.split import SPLITS
from haptoflow_training.preprocessing.store import SegmentStore, store_lock
from haptoflow_training.recordings.dataset import UNKNOWN, Dataset
from haptoflow_training.recordings.labels import LabelDefinition, LabelMap, load_labels
from haptoflow_training.recordings.open_recordings import RecordingFile, open_recordings
from haptoflow_training.recordings.recording import Recording, RecordingIdentity
from haptoflow_training.recordings.synthetic import (
    Material, hand_conditions, load_materials, machine_conditions, record_condition_of
)
from haptoflow_training.recordings.synthetic.materials import select_materials
from haptoflow_training.training.config import DataConfig
from haptoflow_training.waveform import SEGMENT_SAMPLES

_MAXIMUM_SHOWN = 10
SYNTHETIC_STATEMENT = "trained on synthetic recordings"


@dataclass(frozen=True)
class SyntheticRecording:
    """A synthetic recording that is generated when a worker prepares it."""

    material: Material
    identity: RecordingIdentity
    seed: int
    hand_duration_seconds: float
    hand_guided_share: float
    accelerometer_noise: bool = True

    @property
    def label(self) -> str:
        return self.material.label

    def load(self) -> Recording:
        return record_condition_of(
            self.material,
            self.identity,
            seed=self.seed,
            duration_seconds=self.hand_duration_seconds,
            guided_share=self.hand_guided_share,
            accelerometer_noise=self.accelerometer_noise,
        )


@dataclass(frozen=True)
class Provenance:
    """Where the recordings come from, as stated in the model file."""

    statement: str
    recordings: str
    licence: str


@dataclass(frozen=True)
class Source:
    """A store with what the model file states about its labels and origin. left_out: a line for each unusable file,
    and for each folder with recordings that no label names. turned_degrees: labels whose wave vectors were estimated, with
    the angle from the recordings' first axis to the label's, which lies across the clearest ribs."""

    store: SegmentStore
    labels: list[LabelInfo]
    provenance: Provenance
    left_out: tuple[str, ...] = ()
    turned_degrees: Mapping[str, float] = field(default_factory=dict)

    @property
    def wave_vectors(self) -> list[tuple[tuple[float, float], ...]]:
        """The wave vectors of each label's ribs, in cycles per millimetre."""
        return [info.known_wave_vectors for info in self.labels]


def synthetic_recordings(data: DataConfig) -> Iterator[SyntheticRecording]:
    """The synthetic recordings of `data`: both protocols, material by material."""
    for material in _materials(data):
        identities = machine_conditions(
            material,
            directions=data.machine_directions,
            speeds_mmps=data.machine_speeds_mmps,
            forces_millinewtons=data.machine_forces_millinewtons,
            repeats=data.machine_repeats,
        ) + hand_conditions(material, seed=data.recordings_seed, recordings=data.hand_recordings_per_label)
        for identity in identities:
            yield SyntheticRecording(
                material, identity, data.recordings_seed, data.hand_duration_seconds, data.hand_guided_share,
                data.accelerometer_noise,
            )  # fmt: skip


def _materials(data: DataConfig) -> tuple[Material, ...]:
    return select_materials(load_materials(), data.labels or None)


def _fingerprint(data: DataConfig, further: dict[str, Any]) -> dict[str, Any]:
    """A description of what the store was made from, as JSON; a store with another description is prepared again."""
    made_from: dict[str, Any] = {"data": dataclasses.asdict(data), **further}
    if data.source == "synthetic":
        made_from["materials"] = [dataclasses.asdict(material) for material in _materials(data)]
    result: dict[str, Any] = json.loads(json.dumps(made_from))
    return result


def _open_or_prepare(
    data: DataConfig, out: Path, recordings: Any, labels: list[str], workers: int, further: dict[str, Any] | None = None
) -> SegmentStore:
    fingerprint = _fingerprint(data, further or {})
    if (found := _open_if_made_from(out, fingerprint)) is not None:
        return found
    # Synthetic recordings are split by their names alone, so that existing stores stay valid.
    with store_lock(out):
        if (found := _open_if_made_from(out, fingerprint)) is not None:
            return found
        return prepare_store(
            recordings, labels, out, seed=data.recordings_seed, provenance={"made_from": fingerprint}, workers=workers,
            is_cut=data.source != "synthetic",
        )  # fmt: skip


def _open_if_made_from(out: Path, fingerprint: dict[str, Any]) -> SegmentStore | None:
    if not (out / "store.json").exists():
        return None
    store = SegmentStore.open(out)
    return store if store.provenance.get("made_from") == fingerprint else None


def synthetic_label_infos(data: DataConfig) -> list[LabelInfo]:
    """The labels of the synthetic materials, with the finest ruling of a periodic one as its wavelength."""
    return [
        LabelInfo(
            name=material.label,
            category=material.category,
            stiffness_newtons_per_metre=material.stiffness_newtons_per_metre,
            friction_coefficient=material.friction,
            wavelength_metres=(1e-3 * material.dominant_ruling.wavelength_mm if material.dominant_ruling else None),
            wave_vectors_per_mm=material.wave_vectors_per_mm,
            landing=landing_of(material),
            stick_slip=stick_slip_of(material),
            rib_wander=rib_wander_of(material),
        )
        for material in _materials(data)
    ]


def open_source(data: DataConfig, store_folder: Path, workers: int) -> Source:
    """Prepare (or reuse) the store that `data` describes; InputError where folders hold nothing usable."""
    if data.source == "synthetic":
        infos = synthetic_label_infos(data)
        store = _open_or_prepare(data, store_folder, synthetic_recordings(data), [info.name for info in infos], workers)
        return Source(
            store,
            infos,
            Provenance(
                statement=SYNTHETIC_STATEMENT,
                recordings=(
                    f"synthetic recorder, seed {data.recordings_seed}: protocols machine and hand, "
                    f"{len(store.recordings)} recordings of {len(infos)} labels"
                ),
                licence="MIT",
            ),
        )
    return _open_folders(data, store_folder, workers)


def _open_folders(data: DataConfig, store_folder: Path, workers: int) -> Source:
    if not data.folders:
        raise InputError("data.folders is empty: name the data set's folder there, or pass --recordings DIR")
    roots = [open_recordings(Path(folder)) for folder in data.folders]
    synthetic = all(root.synthetic for root in roots)
    if synthetic:
        known = {info.name: info for info in synthetic_label_infos(DataConfig())}
        labels_made_from = None
    else:
        label_map = _label_map(data, roots)
        roots = [open_recordings(Path(folder), label_map) for folder in data.folders]
        known = {definition.name: _label_info(definition) for definition in label_map.definitions}
        asked = {
            one.name
            for one in label_map.definitions
            if one.wave_vectors_per_mm is None and one.wavelength_metres is None
        }
        labels_made_from = [dataclasses.asdict(definition) for definition in label_map.definitions]
    entries = [entry for root in roots for entry in root if not data.labels or entry.label in data.labels]
    left_out = tuple(line for root in roots for line in root.said)
    if not entries:
        first = f" ({left_out[0]})" if left_out else ""
        raise InputError(
            f"{', '.join(data.folders)}: no recording whose texture a label names{first}; "
            "look with `haptoflow-training inspect`"
        )
    found = {entry.label for entry in entries}
    infos = [info for name, info in known.items() if name in found]
    further = {"files": _files_of(entries), "labels": labels_made_from, "split_by_time": True, "without_noise": "of all files"}
    store = _open_or_prepare(data, store_folder, entries, [info.name for info in infos], workers, further)
    _require_splits(store, [f"skipped: {problem}" for root in roots for problem in root.problems])
    counted = f"{len(store.recordings)} recordings of {len(infos)} labels"
    if synthetic:
        return Source(store, infos, Provenance(SYNTHETIC_STATEMENT, f"synthetic recorder: {counted}", "MIT"))
    sources = _joined(root.provenance.get("source") for root in roots)
    store, infos, turned_degrees = with_found_ribs(store, infos, asked)
    return Source(
        with_rib_phases(store, [info.known_wave_vectors for info in infos]),
        infos,
        Provenance(
            statement="trained on recordings of unknown origin" if sources == UNKNOWN else f"trained on {sources}",
            recordings=f"{sources}: {counted}",
            licence=_joined(root.provenance.get("licence") for root in roots),
        ),
        left_out,
        turned_degrees,
    )


def _require_splits(store: SegmentStore, unusable: Sequence[str]) -> None:
    """InputError if a label has nothing to train on, or nothing is left for validation; raised before training.
    unusable: lines about files that were excluded before preparation."""
    counts = {label: dict.fromkeys(SPLITS, 0) for label in store.labels}
    for recording in store.recordings:
        # Shorter recordings contain no window of past and segment.
        if recording.split != "train" or recording.length > 2 * SEGMENT_SAMPLES:
            counts[store.labels[recording.label_index]][recording.split] += 1
    lacking = [label for label, of_label in counts.items() if of_label["train"] == 0]
    if lacking:
        counted = (f"{label} ({', '.join(f'{counts[label][split]} {split}' for split in SPLITS)})" for label in lacking)
        damaged = [f"skipped: {one}" for one in store.skipped if one.label in lacking]
        raise InputError(
            f"nothing to train with for {'; '.join(counted)}: {_remedy([*damaged, *unusable], ' of these labels')}, "
            "leave the labels out (data.labels), or draw another split (data.recordings_seed)"
        )
    if not any(of_label["validation"] for of_label in counts.values()):
        damaged = [f"skipped: {one}" for one in store.skipped]
        raise InputError(
            f"no recording is left for validation: {_remedy([*damaged, *unusable], '')}, or draw another split "
            "(data.recordings_seed)"
        )


def _remedy(unusable: Sequence[str], of_what: str) -> str:
    """The reason and its remedy: files that could not be used are named first, because mending them may suffice."""
    if unusable:
        more = [f"and {len(unusable) - _MAXIMUM_SHOWN} more"] if len(unusable) > _MAXIMUM_SHOWN else []
        listed = "\n  ".join(["files could not be used:", *unusable[:_MAXIMUM_SHOWN], *more])
        return f"{listed}\nmend or replace these files, record more{of_what}"
    return (
        "recordings are split 70:10:20 by their names, or by time where there are few and they last 2 s at least; "
        f"record more{of_what}"
    )


def _label_map(data: DataConfig, roots: list[Dataset]) -> LabelMap:
    if not data.labels_file:
        own = [str(root.root) for root in roots if root.is_own]
        if own:
            raise InputError(
                f"{', '.join(own)}: recordings of your own; name their labels, with stiffness and friction, in a file like "
                "Training/templates/own-recordings/labels.toml (--labels FILE, or data.labels_file)"
            )
        foreign = [str(root.root) for root in roots if not root.published and not root.synthetic]
        if foreign:
            raise InputError(
                f"{', '.join(foreign)}: not the Cluster Haptic Texture Dataset, whose ids the default labels are of; "
                "name textures and labels in a file of your own (--labels FILE, or data.labels_file) like "
                "Training/configs/labels-cluster.toml"
            )
    return load_labels(Path(data.labels_file) if data.labels_file else None)


def _joined(words: Iterable[object]) -> str:
    """The distinct values joined; "unknown" where none is stated."""
    return ", ".join(dict.fromkeys(str(word) if word else UNKNOWN for word in words))


def _files_of(entries: list[RecordingFile]) -> str:
    """A digest of the recordings' names, sizes and modification times: a changed file means another store."""
    digest = hashlib.sha256()
    for entry in entries:
        for path in entry.paths:
            described = path.stat()
            digest.update(f"{entry.label}:{path.name}:{described.st_size}:{described.st_mtime_ns}\n".encode())
    return digest.hexdigest()


def _label_info(definition: LabelDefinition) -> LabelInfo:
    return LabelInfo(
        definition.name,
        definition.category,
        definition.stiffness_newtons_per_metre,
        definition.friction_coefficient,
        definition.wavelength_metres,
        definition.wave_vectors_per_mm or (),
        landing_of_spring(definition.stiffness_newtons_per_metre),
    )
