from __future__ import annotations

import errno
import json
import os
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest
from dataset_samples import small_recording

from haptoflow_training.errors import InputError
from haptoflow_training.preprocessing import preparation
from haptoflow_training.preprocessing.preparation import prepare_store
from haptoflow_training.preprocessing.settings import PreprocessingSettings
from haptoflow_training.preprocessing.split import SPLITS
from haptoflow_training.preprocessing.store import SegmentStore
from haptoflow_training.recordings.recording import Recording, RecordingIdentity

SETTINGS = PreprocessingSettings()
LABELS = ["stone", "wood"]


@dataclass(frozen=True)
class OnDemand:
    """A recording that is generated in the worker that prepares it."""

    name: str
    label: str

    @property
    def identity(self) -> RecordingIdentity:
        return RecordingIdentity.parse(self.name)

    def load(self) -> Recording:
        return small_recording(self.name, self.label, seconds=1.2)


def some_recordings(directions: tuple[int, ...] = (0, 90, 180), repeats: int = 2) -> list[Recording]:
    machine = [
        small_recording(f"{texture}_{direction}_{speed}_500_{repeat}", LABELS[texture], seconds=1.2)
        for texture in (0, 1)
        for direction in directions
        for speed in (20, 40)
        for repeat in range(repeats)
    ]
    return machine + [small_recording(f"1_hand_{100 + n}_800_{n}", "wood", seconds=1.2) for n in range(4)]


@pytest.fixture(scope="module")
def store(tmp_path_factory: pytest.TempPathFactory) -> SegmentStore:
    out = tmp_path_factory.mktemp("prepared") / "store"
    return prepare_store(
        some_recordings(), LABELS, out, SETTINGS, seed=4, progress=False, provenance={"licence": "MIT"}
    )


def test_a_store_opened_again_is_the_store_that_was_written(store: SegmentStore) -> None:
    again = SegmentStore.open(store.path)
    assert again.recordings == store.recordings and again.settings == SETTINGS
    assert again.labels == LABELS and again.provenance == {"licence": "MIT"} and again.seed == 4
    np.testing.assert_array_equal(again.waveform, store.waveform)
    with pytest.raises(ValueError, match="read-only"):
        again.waveform[0] = 1.0


def test_every_recording_is_in_exactly_one_split_and_all_splits_occur(store: SegmentStore) -> None:
    names = [{stored.name for stored in store.split(split)} for split in SPLITS]
    assert all(names)
    assert sum(map(len, names)) == len(set.union(*names)) == len(store.recordings)


def test_no_sample_of_one_split_belongs_to_another_split(store: SegmentStore) -> None:
    splits_of_sample = np.zeros(len(store.waveform), dtype=int)
    for split in SPLITS:
        used = np.zeros(len(store.waveform), dtype=bool)
        for stored in store.split(split):
            used[stored.start : stored.start + stored.length] = True
        splits_of_sample += used
    assert splits_of_sample.max() == 1


def test_no_pass_over_a_track_of_the_surface_is_in_two_splits(store: SegmentStore) -> None:
    track = {}
    for stored in store.recordings:
        if stored.protocol == "machine":
            key = (stored.texture_id, stored.direction_degrees, stored.speed_mmps, stored.force_millinewtons)
            assert track.setdefault(key, stored.split) == stored.split


def test_a_recording_keeps_its_split_and_its_silence_when_others_are_added(
    store: SegmentStore, tmp_path: Path
) -> None:
    more = some_recordings(directions=(0, 45, 90, 180))[::-1]
    larger = prepare_store(more, LABELS, tmp_path / "larger", SETTINGS, seed=4, progress=False)
    found = {stored.name: stored for stored in larger.recordings}
    assert len(found) > len(store.recordings)
    for stored in store.recordings:
        other = found[stored.name]
        assert (stored.split, stored.padding_before, stored.padding_after, stored.length) == (
            (other.split, other.padding_before, other.padding_after, other.length)
        )


def test_held_out_directions_and_speeds_land_in_the_test_split(tmp_path: Path) -> None:
    settings = replace(SETTINGS, held_out_directions=(90,), held_out_speeds_mmps=(40,))
    store = prepare_store(some_recordings(), LABELS, tmp_path / "store", settings, seed=4, progress=False)
    held_out = [one for one in store.recordings if one.direction_degrees == 90 or one.speed_mmps == 40]
    assert held_out and {one.split for one in held_out} == {"test"}
    assert store.split("train")


def test_a_broken_recording_is_skipped_with_its_reason_and_the_rest_is_kept(tmp_path: Path) -> None:
    good, bad = small_recording("1_0_20_500_0", seconds=1.2), small_recording("1_0_30_500_0", seconds=1.2)
    bad.force_newtons[3] = np.nan
    store = prepare_store([bad, good], LABELS, tmp_path / "store", SETTINGS, progress=False)
    assert [stored.name for stored in store.recordings] == ["1_0_20_500_0"]
    assert [skipped.name for skipped in store.skipped] == ["1_0_30_500_0"]
    assert "force holds values that are not finite" in store.skipped[0].reason


def test_nothing_usable_is_an_error_that_names_the_first_problem(tmp_path: Path) -> None:
    with pytest.raises(
        InputError, match=r"no recording could be prepared \(1 were skipped.*1_0_20_500_0.*trimming"
    ):
        prepare_store(
            [small_recording("1_0_20_500_0", seconds=0.15)], LABELS, tmp_path / "s", SETTINGS, progress=False
        )
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("names", "label", "words"),
    [
        (["1_0_20_500_0"] * 2, "wood", "came twice"),
        (["1_0_20_500_0"], "cheese", "label 'cheese'; expected one of stone"),
    ],
)
def test_a_name_given_twice_or_an_unknown_label_is_refused(
    names: list[str], label: str, words: str, tmp_path: Path
) -> None:
    with pytest.raises(InputError, match=words):
        prepare_store(
            (OnDemand(name, label) for name in names), LABELS, tmp_path / "store", SETTINGS, progress=False
        )


def test_a_full_disk_is_an_input_error_and_leaves_the_older_store_as_it_was(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out = tmp_path / "store"
    prepare_store([OnDemand("1_0_20_500_0", "wood")], LABELS, out, SETTINGS, progress=False)
    before = {path.name: path.read_bytes() for path in out.iterdir()}

    def refuse(*_: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(preparation, "_append", refuse)
    with pytest.raises(InputError, match="No space left on device; make room"):
        prepare_store([OnDemand("1_0_30_500_0", "wood")], LABELS, out, SETTINGS, progress=False)
    assert {path.name: path.read_bytes() for path in out.iterdir()} == before
    assert [path.name for path in tmp_path.iterdir()] == ["store"]


def test_a_rename_that_fails_puts_the_older_store_back(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out = tmp_path / "store"
    prepare_store([OnDemand("1_0_20_500_0", "wood")], LABELS, out, SETTINGS, progress=False)
    rename = os.replace

    def refuse_the_new(source: Path, target: Path) -> None:
        if source.name.endswith(".unfinished"):
            raise PermissionError(errno.EACCES, "Permission denied")
        rename(source, target)

    monkeypatch.setattr(os, "replace", refuse_the_new)
    with pytest.raises(InputError, match="Permission denied"):
        prepare_store([OnDemand("1_0_30_500_0", "wood")], LABELS, out, SETTINGS, progress=False)
    assert [stored.name for stored in SegmentStore.open(out).recordings] == ["1_0_20_500_0"]
    assert [path.name for path in tmp_path.iterdir()] == ["store"]


def test_an_older_store_is_replaced_but_a_folder_of_other_files_is_not(tmp_path: Path) -> None:
    out = tmp_path / "store"
    prepare_store([OnDemand("1_0_20_500_0", "wood")], LABELS, out, SETTINGS, progress=False)
    newer = prepare_store([OnDemand("1_0_30_500_0", "wood")], LABELS, out, SETTINGS, progress=False)
    assert [stored.name for stored in newer.recordings] == ["1_0_30_500_0"]
    assert [path.name for path in tmp_path.iterdir()] == ["store"]
    (out / "notes.txt").write_text("mine")
    with pytest.raises(InputError, match="holds files that are not a store"):
        prepare_store([OnDemand("1_0_20_500_0", "wood")], LABELS, out, SETTINGS, progress=False)
    assert (out / "notes.txt").read_text() == "mine"


@pytest.mark.parametrize(
    ("damage", "words"),
    [
        (lambda root: (root / "store.json").unlink(), "an unfinished store"),
        (lambda root: (root / "motion.f32").write_bytes(b"1234"), "motion.f32: 4 bytes long, expected"),
        (lambda root: (root / "position.f32").unlink(), "position.f32: missing, expected"),
        (lambda root: (root / "waveform.f32").unlink(), "waveform.f32: missing"),
        (lambda root: (root / "wander.f32").unlink(), "wander.f32: missing"),
        (lambda root: (root / "store.json").write_text("{"), "not readable as JSON"),
        (lambda root: (root / "store.json").write_text('{"version": 99}'), "store version 99, expected 3"),
        (lambda root: (root / "store.json").write_text('{"version": 2}'), "store version 2, expected 3"),
        (lambda root: [path.unlink() for path in root.iterdir()], "not a store"),
    ],
)
def test_a_damaged_store_is_refused_by_what_is_wrong_with_it(damage, words: str, tmp_path: Path) -> None:
    out = tmp_path / "store"
    prepare_store([OnDemand("1_0_20_500_0", "wood")], LABELS, out, SETTINGS, progress=False)
    damage(out)
    with pytest.raises(InputError, match=words):
        SegmentStore.open(out)
