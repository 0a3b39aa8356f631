"""Recordings of unknown origin: no origin is claimed for them, and no label is guessed."""

from __future__ import annotations

import argparse
import os
import re
from pathlib import Path

import pytest
from dataset_samples import small_recording

from haptoflow_training.cli import main
from haptoflow_training.commands import train
from haptoflow_training.commands.train import configuration, report_left_out
from haptoflow_training.errors import InputError
from haptoflow_training.preprocessing.preparation import prepare_store
from haptoflow_training.recordings.cluster_dataset import open_dataset
from haptoflow_training.recordings.dataset_layout import TextureEntry, write_recording, write_texture_list
from haptoflow_training.training.config import DataConfig
from haptoflow_training.training.recordings_source import Source, open_source

HAND = "3_hand_400_1500_0"
LABEL = (
    '[[label]]\nname = "{name}"\ncategory = "cloth"\ntextures = ["{texture}"]\n'
    "stiffness_newtons_per_metre = 250.0\nfriction_coefficient = 0.4\n"
)
FEW = ("0_0_20_500_0", "0_90_40_1000_0", "66_0_20_500_0")
GRID = tuple(f"{texture}_{direction}_50_500_0" for texture in (0, 66) for direction in range(0, 360, 45))
NAMES = (*FEW, "0_45_30_500_1", *GRID)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Denim and felt, under the ids of wood and steel in the Cluster data set."""
    return recorded(tmp_path / "recordings", NAMES)


def recorded(root: Path, names: tuple[str, ...]) -> Path:
    for name in names:
        write_recording(root, small_recording(name, seconds=1.2))
    write_texture_list(root, [TextureEntry(0, "denim", {}), TextureEntry(66, "felt", {})])
    return root


def labels_file(path: Path, *labels: str) -> Path:
    path.write_text("".join(LABEL.format(name=label, texture=label) for label in labels), encoding="utf-8")
    return path


def opened(folder: Path, labels: Path | None, store: Path) -> Source:
    return open_source(
        DataConfig(source="folders", folders=(str(folder),), labels_file=str(labels) if labels else ""), store, 1
    )


def test_the_ids_of_other_recordings_are_not_matched_against_the_cluster_s_labels(folder: Path, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="not the Cluster Haptic Texture Dataset.*--labels FILE"):
        opened(folder, None, tmp_path / "store")
    assert not (tmp_path / "store").exists()


def test_a_labels_file_names_the_textures_and_the_model_states_an_unknown_origin(folder: Path, tmp_path: Path) -> None:
    source = opened(folder, labels_file(tmp_path / "labels.toml", "denim", "felt"), tmp_path / "store")
    assert [info.name for info in source.labels] == ["denim", "felt"]
    assert source.provenance.statement == "trained on recordings of unknown origin"
    assert source.provenance.licence == "unknown"
    assert "Cluster" not in source.provenance.recordings


def test_a_label_with_nothing_to_train_with_is_named_before_training(tmp_path: Path) -> None:
    folder = recorded(tmp_path / "recordings", FEW)
    labels = labels_file(tmp_path / "labels.toml", "denim", "felt")
    outcomes = set()
    for seed in range(6):
        data = DataConfig(source="folders", folders=(str(folder),), labels_file=str(labels), recordings_seed=seed)
        try:
            source = open_source(data, tmp_path / "store", 1)
        except InputError as error:
            counted = r"nothing to train with for .*\(0 train, \d validation, \d test\)"
            assert re.search(f"{counted}|left for validation", str(error))
            assert "data.recordings_seed" in str(error)
            outcomes.add("refused")
        else:
            trained = {one.label for one in source.store.recordings if one.split == "train"}
            assert trained == {"denim", "felt"}
            outcomes.add("opened")
    assert "refused" in outcomes


def test_recordings_that_are_left_out_are_listed_with_the_reason(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = folder / "sensor_data" / "force" / "0_45_30_500_1.csv"
    lines = path.read_text().splitlines()
    rows = [f"{time},{1000.0 * float(force)}" for time, force in (line.split(",") for line in lines[1:])]
    path.write_text("\n".join([lines[0], *rows]) + "\n")
    report_left_out(opened(folder, labels_file(tmp_path / "labels.toml", "denim"), tmp_path / "store"))
    printed = capsys.readouterr().err
    assert "skipped: 0_45_30_500_1: " in printed and "expected newtons" in printed
    assert "9 recordings are left out: no label names their textures (felt)" in printed
    assert main(["inspect", str(folder)]) == 0
    assert re.search(r"force/0_45_30_500_1\.csv: force is 500.*expected newtons", capsys.readouterr().out)


def test_a_row_without_a_number_is_dropped_and_a_gap_drops_only_samples_near_it(tmp_path: Path) -> None:
    recording = small_recording(HAND, label="denim", seconds=4.0)
    whole = prepare_store([recording], ["denim"], tmp_path / "whole")
    write_recording(tmp_path / "data", recording)
    write_texture_list(tmp_path / "data", [TextureEntry(3, "denim", {})])
    path = tmp_path / "data" / "sensor_data" / "accel" / f"{HAND}.csv"
    rows = path.read_text().splitlines()
    time, *_ = rows[9000].split(",")
    rows[9000] = f"{time},nan,,0.1"
    middle = float(rows[len(rows) // 2].split(",")[0])
    lost = [row for row in rows[1:] if not middle < float(row.split(",")[0]) < middle + 0.007]
    path.write_text("\n".join([rows[0], *lost]) + "\n")
    dataset = open_dataset(tmp_path / "data")
    store = prepare_store(dataset, ["denim"], tmp_path / "store")
    assert [one.name for one in store.recordings] == [HAND, f"{HAND} part 2"]
    assert store.skipped == []
    # 0.3 s are trimmed at each end of each part, which the padding may lengthen again.
    assert len(store.waveform) > len(whole.waveform) - 2 * 2000 * 0.75
    assert len({one.split for one in store.recordings}) == 1


def test_the_published_data_set_keeps_its_name_licence_and_labels(folder: Path, tmp_path: Path) -> None:
    write_texture_list(folder, [TextureEntry(0, "Nyatoh", {}), TextureEntry(66, "Steel", {})])
    source = opened(folder, None, tmp_path / "store")
    assert [info.name for info in source.labels] == ["wood", "metal"]
    assert source.provenance.statement.startswith("trained on Cluster Haptic Texture Dataset")
    assert source.provenance.licence == "CC BY 4.0"


def test_a_store_is_prepared_again_only_if_recordings_or_labels_have_changed(folder: Path, tmp_path: Path) -> None:
    labels = labels_file(tmp_path / "labels.toml", "denim", "felt")
    store = tmp_path / "store"
    header = store / "store.json"

    def made() -> int:
        opened(folder, labels, store)
        return header.stat().st_mtime_ns

    first = made()
    assert made() == first, "nothing has changed"
    path = folder / "sensor_data" / "accel" / "66_0_20_500_0.csv"
    text = path.read_text()
    path.write_text(text.replace("0.01", "0.02", 1))
    os.utime(path, ns=(1, 1))
    second = made()
    assert second != first, "a recording has changed"
    labels.write_text(labels.read_text().replace("250.0", "300.0"))
    assert made() != second, "the labels have changed"
    labels_file(labels, "denim")
    assert opened(folder, labels, store).store.labels == ["denim"]


def test_paths_are_relative_to_the_current_folder_and_those_of_a_configuration_to_its_file(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    labels_file(tmp_path / "labels.toml", "denim", "felt")
    (tmp_path / "run.toml").write_text('[data]\nsource = "folders"\nfolders = ["recordings"]\nlabels_file = "labels.toml"\n')
    elsewhere = tmp_path / "elsewhere" / "deep"
    elsewhere.mkdir(parents=True)
    monkeypatch.chdir(elsewhere)
    words = ["train", "--config", "../../run.toml", "--out", "out"]
    data = configuration(parsed(words)).data
    assert [Path(path) for path in data.folders] == [folder] and Path(data.labels_file) == tmp_path / "labels.toml"
    assert len(open_source(data, tmp_path / "store", 1).labels) == 2
    (elsewhere / "mine").mkdir()
    data = configuration(parsed([*words, "--recordings", "mine", "--labels", "mine.toml"])).data
    assert data.folders == (str(elsewhere / "mine"),) and data.labels_file == str(elsewhere / "mine.toml")


def parsed(words: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser()
    train.add_options(parser.add_subparsers().add_parser("train"))
    return parser.parse_args(words)


def test_a_label_whose_files_are_damaged_names_them_before_it_asks_for_more(tmp_path: Path) -> None:
    folder = recorded(tmp_path / "recordings", NAMES)
    for path in (folder / "sensor_data" / "force").glob("66_*"):
        path.write_text("time,force\n0,1\n", encoding="utf-8")
    (folder / "sensor_data" / "position" / "0_45_30_500_1.csv").unlink()
    labels = labels_file(tmp_path / "labels.toml", "denim", "felt")
    with pytest.raises(InputError) as refused:
        opened(folder, labels, tmp_path / "store")
    said = str(refused.value)
    assert said.startswith("nothing to train with for felt (0 train, 0 validation, 0 test): files could not be used:")
    assert re.search(r"\n  skipped: 66_0_20_500_0: .*force/66_0_20_500_0\.csv", said)
    assert re.search(r"\n  skipped: .*position/0_45_30_500_1\.csv: missing file", said)
    assert "\nmend or replace these files, record more of these labels, leave the labels out" in said
    assert "denim (" not in said
