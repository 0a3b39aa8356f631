from __future__ import annotations

from pathlib import Path

import pytest
from dataset_samples import small_recording

from haptoflow_training.cli import main
from haptoflow_training.preprocessing.store import SegmentStore
from haptoflow_training.recordings.dataset_writer import (
    TextureEntry,
    write_provenance,
    write_recording,
    write_texture_list,
)


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
        ("0_0_20_500_0", "wood"),
        ("0_90_40_1000_0", "wood"),
        ("66_0_20_500_0", "metal"),
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


def test_prepare_exits_3_where_no_recording_has_a_label(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_recording(tmp_path / "data", small_recording("5_0_20_500_0", seconds=1.2))
    write_texture_list(tmp_path / "data", [TextureEntry(0, "Nyatoh", {}), TextureEntry(5, "Oak", {})])
    assert main(["prepare", "--recordings", str(tmp_path / "data"), "--out", str(tmp_path / "store")]) == 3
    assert "no recording with a label" in capsys.readouterr().err


def test_prepare_refuses_two_folders_with_the_same_names(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    first, second = published(tmp_path / "a"), published(tmp_path / "b")
    assert main(["prepare", "--recordings", str(first), str(second), "--out", str(tmp_path / "store")]) == 3
    assert "came twice" in capsys.readouterr().err
    assert not (tmp_path / "store").exists()
