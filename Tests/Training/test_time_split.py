"""One recording is cut by time into training, validation and test; existing stores stay as they were."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from own_samples import csv_one_axis, stroke

from haptoflow_training.errors import InputError
from haptoflow_training.preprocessing.preparation import prepare_cut_where_needed, prepare_store
from haptoflow_training.preprocessing.settings import PreprocessingSettings
from haptoflow_training.preprocessing.split import SPLITS, time_parts
from haptoflow_training.recordings.own_dataset import open_own_dataset
from haptoflow_training.recordings.synthetic import (
    hand_conditions,
    load_materials,
    machine_conditions,
    record_hand_condition,
    record_machine_condition,
)
from haptoflow_training.training.config import DataConfig
from haptoflow_training.training.recordings_source import open_source

SETTINGS = PreprocessingSettings()
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
    parts = time_parts(samples, SETTINGS)
    assert {part.split for part in parts} == set(SPLITS)
    assert parts[0].start == 0 and parts[-1].stop <= samples
    for before, after in pairwise(parts):
        assert after.start - before.stop >= SETTINGS.segment_samples
    share = {split: sum(one.stop - one.start for one in parts if one.split == split) / samples for split in SPLITS}
    assert share["train"] > 0.3 and share["validation"] > 0.05 and share["test"] > 0.08
    if seconds > 9.0:
        assert 0.66 < share["train"] < 0.71 and sum(share.values()) > 0.95
    # Every split covers a long recording from its beginning to its end.
    assert len(parts) == 3 * max(1, round(seconds / 10.0))


def test_one_recording_of_each_label_trains_validates_and_tests(tmp_path: Path) -> None:
    csv_one_axis(tmp_path / "data", "denim", "denim", stroke(10.0, seed=1))
    csv_one_axis(tmp_path / "data", "felt", "felt", stroke(4.0, seed=2))
    store = prepare_cut_where_needed(list(open_own_dataset(tmp_path / "data")), ["denim", "felt"], tmp_path / "store")
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
    store = prepare_cut_where_needed(list(open_own_dataset(tmp_path / "data")), ["denim"], tmp_path / "store")
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
        recordings += [record_machine_condition(material, identity, seed=1) for identity in machine]
        recordings += [
            record_hand_condition(material, identity, seed=1, duration_seconds=3.0)
            for identity in hand_conditions(material, seed=1, recordings=2)
        ]
    store = prepare_store(recordings, [one.label for one in chosen], tmp_path / "store", progress=False)
    found = [
        (one.name, one.split, one.start, one.length, one.padding_before, one.padding_after) for one in store.recordings
    ]
    assert found == BEFORE
    waveform = np.asarray(store.waveform, dtype=np.float64)
    assert np.sqrt(np.mean(waveform**2)) == pytest.approx(WAVEFORM_RMS, rel=1e-4)
    assert np.abs(waveform[::500]).sum() == pytest.approx(WAVEFORM_SUM, rel=1e-4)
