from __future__ import annotations

import errno
import json
import os
from collections import Counter
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from dataset_samples import small_recording
from haptoflow_training.cli import main
from haptoflow_training.errors import InputError
from haptoflow_training.preprocessing import preparation
from haptoflow_training.preprocessing.preparation import prepare_store
from haptoflow_training.preprocessing.settings import SETTINGS
from haptoflow_training.preprocessing.split import SPLITS, split_of, time_parts
from haptoflow_training.preprocessing.store import SegmentStore
from haptoflow_training.recordings.dataset_layout import (
    TextureEntry, write_provenance, write_recording, write_texture_list
)
from haptoflow_training.recordings.own_files import open_own_dataset
from haptoflow_training.recordings.recording import Recording, RecordingIdentity
from haptoflow_training.recordings.synthetic import (
    hand_conditions, load_materials, machine_conditions, record_condition_of
)
from haptoflow_training.training.config import DataConfig
from haptoflow_training.training.recordings_source import open_source
from own_samples import csv_one_axis, stroke

def published(root: Path) -> Path:
    for name in ("0_0_20_500_0", "0_90_40_1000_0", "66_0_20_500_0", "5_0_20_500_0"):
        write_recording(root, small_recording(name, seconds=1.2))
    entries = [TextureEntry(0, "Nyatoh", {}), TextureEntry(5, "Oak", {}), TextureEntry(66, "Steel", {})]
    write_texture_list(root, entries)
    return root


def synthetic(root: Path) -> Path:
    for repeat in range(3):
        write_recording(root, small_recording(f"0_hand_400_1500_{repeat}", seconds=1.2))
    write_texture_list(root, [TextureEntry(0, "carpet", {})])
    write_provenance(root, source="synthetic recorder", licence="MIT", synthetic=True)
    return root


def test_prepare_takes_a_published_folder_with_the_default_labels(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "store"
    assert main(["prepare", "--recordings", str(published(tmp_path / "data")), "--out", str(out)]) == 0
    store = SegmentStore.open(out)
    assert store.labels == ["wood", "metal"]
    assert [(one.name, one.label) for one in store.recordings] == [
        ("0_0_20_500_0", "wood"), ("0_90_40_1000_0", "wood"), ("66_0_20_500_0", "metal")
    ]
    assert store.provenance["recordings"][0]["licence"] == "CC BY 4.0"
    printed = capsys.readouterr().out
    assert "3 recordings" in printed and "1 recordings are left out: no label names their texture" in printed


def test_prepare_takes_synthetic_recordings_with_their_own_names(tmp_path: Path) -> None:
    out = tmp_path / "store"
    assert main(
        ["prepare", "--recordings", str(synthetic(tmp_path / "data")), "--out", str(out), "--workers", "2"]
    ) == 0
    store = SegmentStore.open(out)
    assert store.labels == ["carpet"] and len(store.recordings) == 3
    assert store.provenance["recordings"][0]["synthetic"] is True


def test_prepare_skips_a_broken_file_and_says_so(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    data = published(tmp_path / "data")
    (data / "sensor_data" / "force" / "0_0_20_500_0.csv").write_text("")
    assert main(["prepare", "--recordings", str(data), "--out", str(tmp_path / "store")]) == 0
    store = SegmentStore.open(tmp_path / "store")
    assert len(store.recordings) == 2 and [one.name for one in store.skipped] == ["0_0_20_500_0"]
    assert "skipped: 0_0_20_500_0" in capsys.readouterr().out


def test_prepare_exits_3_where_no_recording_has_a_label(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write_recording(tmp_path / "data", small_recording("5_0_20_500_0", seconds=1.2))
    write_texture_list(tmp_path / "data", [TextureEntry(0, "Nyatoh", {}), TextureEntry(5, "Oak", {})])
    assert main(["prepare", "--recordings", str(tmp_path / "data"), "--out", str(tmp_path / "store")]) == 3
    assert "no recording with a label" in capsys.readouterr().err


def test_prepare_refuses_two_folders_with_the_same_names(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    first, second = published(tmp_path / "a"), published(tmp_path / "b")
    assert main(["prepare", "--recordings", str(first), str(second), "--out", str(tmp_path / "store")]) == 3
    assert "came twice" in capsys.readouterr().err
    assert not (tmp_path / "store").exists()


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
        some_recordings(), LABELS, out, seed=4, provenance={"licence": "MIT"}
    )


def test_a_store_opened_again_is_the_store_that_was_written(store: SegmentStore) -> None:
    again = SegmentStore.open(store.path)
    assert again.recordings == store.recordings
    assert again.labels == LABELS and again.provenance == {"licence": "MIT"} and again.seed == 4
    np.testing.assert_array_equal(again.waveform, store.waveform)
    with pytest.raises(ValueError, match="read-only"):
        again.waveform[0] = 1.0


def test_every_sample_belongs_to_one_split_and_all_splits_occur(store: SegmentStore) -> None:
    splits_of_sample = np.zeros(len(store.waveform), dtype=int)
    for split in SPLITS:
        used = np.zeros(len(store.waveform), dtype=bool)
        assert store.split(split)
        for stored in store.split(split):
            used[stored.start : stored.start + stored.length] = True
        splits_of_sample += used
    assert np.all(splits_of_sample == 1)


def test_a_recording_keeps_its_split_and_its_silence_when_others_are_added(store: SegmentStore, tmp_path: Path) -> None:
    more = some_recordings(directions=(0, 45, 90, 180))[::-1]
    larger = prepare_store(more, LABELS, tmp_path / "larger", seed=4)
    found = {stored.name: stored for stored in larger.recordings}
    assert len(found) > len(store.recordings)
    for stored in store.recordings:
        other = found[stored.name]
        assert (stored.split, stored.padding_before, stored.padding_after, stored.length) == (
            (other.split, other.padding_before, other.padding_after, other.length)
        )


def test_a_broken_recording_is_skipped_with_its_reason_and_the_rest_is_kept(tmp_path: Path) -> None:
    good, bad = small_recording("1_0_20_500_0", seconds=1.2), small_recording("1_0_30_500_0", seconds=1.2)
    bad.force_newtons[3] = np.nan
    store = prepare_store([bad, good], LABELS, tmp_path / "store")
    assert [stored.name for stored in store.recordings] == ["1_0_20_500_0"]
    assert [skipped.name for skipped in store.skipped] == ["1_0_30_500_0"]
    assert "force holds values that are not finite" in store.skipped[0].reason


def test_nothing_usable_is_an_error_that_names_the_first_problem(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"no recording could be prepared \(1 were skipped.*1_0_20_500_0.*trimming"):
        prepare_store([small_recording("1_0_20_500_0", seconds=0.15)], LABELS, tmp_path / "s")
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
        prepare_store((OnDemand(name, label) for name in names), LABELS, tmp_path / "store")


def test_a_full_disk_is_an_input_error_and_leaves_the_older_store_as_it_was(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out = tmp_path / "store"
    prepare_store([OnDemand("1_0_20_500_0", "wood")], LABELS, out)
    before = {path.name: path.read_bytes() for path in out.iterdir()}

    def refuse(*_: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(preparation, "_append", refuse)
    with pytest.raises(InputError, match="No space left on device; make room"):
        prepare_store([OnDemand("1_0_30_500_0", "wood")], LABELS, out)
    assert {path.name: path.read_bytes() for path in out.iterdir()} == before
    assert [path.name for path in tmp_path.iterdir()] == ["store"]


def test_a_rename_that_fails_puts_the_older_store_back(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    out = tmp_path / "store"
    prepare_store([OnDemand("1_0_20_500_0", "wood")], LABELS, out)
    rename = os.replace

    def refuse_the_new(source: Path, target: Path) -> None:
        if source.name.endswith(".unfinished"):
            raise PermissionError(errno.EACCES, "Permission denied")
        rename(source, target)

    monkeypatch.setattr(os, "replace", refuse_the_new)
    with pytest.raises(InputError, match="Permission denied"):
        prepare_store([OnDemand("1_0_30_500_0", "wood")], LABELS, out)
    assert [stored.name for stored in SegmentStore.open(out).recordings] == ["1_0_20_500_0"]
    assert [path.name for path in tmp_path.iterdir()] == ["store"]


def test_an_older_store_is_replaced_but_a_folder_of_other_files_is_not(tmp_path: Path) -> None:
    out = tmp_path / "store"
    prepare_store([OnDemand("1_0_20_500_0", "wood")], LABELS, out)
    newer = prepare_store([OnDemand("1_0_30_500_0", "wood")], LABELS, out)
    assert [stored.name for stored in newer.recordings] == ["1_0_30_500_0"]
    assert [path.name for path in tmp_path.iterdir()] == ["store"]
    (out / "notes.txt").write_text("mine")
    with pytest.raises(InputError, match="holds files that are not a store"):
        prepare_store([OnDemand("1_0_20_500_0", "wood")], LABELS, out)
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
    prepare_store([OnDemand("1_0_20_500_0", "wood")], LABELS, out)
    damage(out)
    with pytest.raises(InputError, match=words):
        SegmentStore.open(out)


def machine_grid(texture_id: int) -> list[RecordingIdentity]:
    return [
        RecordingIdentity(texture_id, direction, speed, force, repeat)
        for direction in range(0, 360, 45)
        for speed in (20, 30, 40, 50, 60)
        for force in (500, 1000)
        for repeat in (0, 1)
    ]


def hand_strokes(texture_id: int, count: int) -> list[RecordingIdentity]:
    generator = np.random.default_rng(texture_id)
    speeds, forces = generator.integers(15, 900, count), generator.integers(150, 3500, count)
    return [RecordingIdentity(texture_id, None, int(speeds[n]), int(forces[n]), n) for n in range(count)]


@pytest.mark.parametrize("texture_id", range(0, 118, 13))
def test_every_texture_is_split_70_10_20_on_the_machine(texture_id: int) -> None:
    found = Counter(split_of(identity, 7) for identity in machine_grid(texture_id))
    assert found["train"] == pytest.approx(112, abs=4)
    assert found["validation"] == pytest.approx(16, abs=4)
    assert found["test"] == pytest.approx(32, abs=4)


@pytest.mark.parametrize("texture_id", range(0, 118, 13))
def test_a_few_hand_strokes_of_a_texture_reach_all_three_splits(texture_id: int) -> None:
    found = Counter(split_of(identity, 7) for identity in hand_strokes(texture_id, 24))
    assert found["train"] == pytest.approx(17, abs=3)
    assert found["validation"] >= 1
    assert found["test"] == pytest.approx(5, abs=3)


def test_repeats_of_one_machine_pass_share_a_split_because_they_share_its_bumps() -> None:
    for texture_id in range(20):
        for identity in machine_grid(texture_id):
            twin = replace(identity, repeat=1 - identity.repeat)
            assert split_of(identity, 7) == split_of(twin, 7)


def test_the_split_of_a_name_never_changes_between_releases() -> None:
    names = ["0_0_20_500_0", "5_135_40_1000_1", "81_315_60_500_0", "3_hand_400_1500_3", "3_hand_400_1500_4"]
    found = [split_of(RecordingIdentity.parse(name), 0) for name in names]
    assert found == ["train", "test", "test", "train", "test"]


# Of the same store's waveform: its RMS, and the sum of every 500th sample's magnitude.
WAVEFORM_RMS, WAVEFORM_SUM = 0.1121996, 3.370311
# Name, split, start, length, silence before and after, as in stores before short recordings were trimmed less.
BEFORE = [
    ("0_0_60_500_0", "train", 0, 3759, 400, 0),
    ("0_45_60_500_0", "validation", 3759, 4359, 400, 600),
    ("0_hand_72_767_0", "train", 8118, 4980, 0, 200),
    ("0_hand_277_278_1", "train", 13098, 5380, 400, 200),
    ("13_0_60_500_0", "validation", 18478, 3359, 0, 0),
    ("13_45_60_500_0", "test", 21837, 3559, 0, 200),
    ("13_hand_11_2166_0", "train", 25396, 5380, 200, 400),
    ("13_hand_205_516_1", "train", 30776, 5380, 600, 0),
]


@pytest.mark.parametrize("seconds", [1.2, 3.0, 9.4, 31.0, 299.4])
def test_every_split_gets_its_share_and_no_sample_is_near_another_split_s(seconds: float) -> None:
    samples = int(2000 * seconds)
    parts = time_parts(samples)
    assert {split for split, _ in parts} == set(SPLITS)
    assert parts[0][1].start == 0 and parts[-1][1].stop <= samples
    for (_, before), (_, after) in pairwise(parts):
        assert after.start - before.stop >= SETTINGS.segment_samples
    share = {split: sum(one.stop - one.start for name, one in parts if name == split) / samples for split in SPLITS}
    assert share["train"] > 0.3 and share["validation"] > 0.05 and share["test"] > 0.08
    if seconds > 9.0:
        assert 0.66 < share["train"] < 0.71 and sum(share.values()) > 0.95
    # Every split covers a long recording from its beginning to its end.
    assert len(parts) == 3 * max(1, round(seconds / 10.0))


def test_one_recording_of_each_label_trains_validates_and_tests(tmp_path: Path) -> None:
    csv_one_axis(tmp_path / "data", "denim", "denim", stroke(10.0, seed=1))
    csv_one_axis(tmp_path / "data", "felt", "felt", stroke(4.0, seed=2))
    store = prepare_store(list(open_own_dataset(tmp_path / "data")), ["denim", "felt"], tmp_path / "store", is_cut=True)
    for label in ("denim", "felt"):
        own = [one for one in store.recordings if one.label == label]
        assert {one.split for one in own} == set(SPLITS)
        assert len({one.name for one in own}) == len(own)
    kept = sum(one.recorded_samples.stop - one.recorded_samples.start for one in store.recordings if one.label == "denim")
    assert kept > 0.9 * 10.0 * 2000
    for one in store.recordings:
        assert one.padding_before + one.padding_after <= one.length


def test_too_short_recordings_are_named_before_training(tmp_path: Path) -> None:
    csv_one_axis(tmp_path / "data", "denim", "denim", stroke(1.2, seed=1))
    labels = tmp_path / "labels.toml"
    labels.write_text(
        '[[label]]\nname = "denim"\ncategory = "cloth"\nstiffness_newtons_per_metre = 250.0\nfriction_coefficient = 0.4\n'
    )
    data = DataConfig(source="folders", folders=(str(tmp_path / "data"),), labels_file=str(labels))
    with pytest.raises(InputError, match=r"by time where there .*are few and they last 2 s at least"):
        open_source(data, tmp_path / "store", 1)


def test_labels_with_recordings_enough_for_every_split_are_split_by_their_names(tmp_path: Path) -> None:
    names = [f"stroke-{number:02d}" for number in range(24)]
    for number, name in enumerate(names):
        csv_one_axis(tmp_path / "data", name, "denim", stroke(1.5, seed=number))
    store = prepare_store(list(open_own_dataset(tmp_path / "data")), ["denim"], tmp_path / "store", is_cut=True)
    assert [one.name for one in store.recordings] == [f"{name}.csv" for name in names]
    assert {one.split for one in store.recordings} == set(SPLITS)


def test_recordings_of_published_length_give_the_same_store_as_before(tmp_path: Path) -> None:
    materials = load_materials()
    chosen = (materials[0], materials[13])
    recordings = []
    for material in chosen:
        machine = machine_conditions(
            material, directions=(0, 45), speeds_mmps=(60,), forces_millinewtons=(500,), repeats=1
        )
        recordings += [record_condition_of(material, identity, seed=1) for identity in machine]
        recordings += [
            record_condition_of(material, identity, seed=1, duration_seconds=3.0)
            for identity in hand_conditions(material, seed=1, recordings=2)
        ]
    store = prepare_store(recordings, [one.label for one in chosen], tmp_path / "store")
    found = [
        (one.name, one.split, one.start, one.length, one.padding_before, one.padding_after) for one in store.recordings
    ]
    assert found == BEFORE
    waveform = np.asarray(store.waveform, dtype=np.float64)
    assert np.sqrt(np.mean(waveform**2)) == pytest.approx(WAVEFORM_RMS, rel=1e-4)
    assert np.abs(waveform[::500]).sum() == pytest.approx(WAVEFORM_SUM, rel=1e-4)
