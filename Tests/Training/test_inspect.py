from __future__ import annotations

import dataclasses
import json
from collections.abc import Sequence
from pathlib import Path

import pytest
from dataset_samples import small_recording

from haptoflow_training.cli import main
from haptoflow_training.recordings.apparatus import plane_powers, x_over_y_db
from haptoflow_training.recordings.cluster_dataset import open_dataset
from haptoflow_training.recordings.dataset_inspection import inspect_dataset
from haptoflow_training.recordings.dataset_writer import TextureEntry, write_recording, write_texture_list
from haptoflow_training.recordings.recording import RecordingIdentity
from haptoflow_training.recordings.synthetic import load_materials, record_machine_condition

NAMES = ["0_0_20_500_0", "0_0_20_500_1", "0_90_40_1000_0", "66_0_20_500_0", "66_hand_400_1500_3"]


@pytest.fixture
def root(tmp_path: Path) -> Path:
    for name in NAMES:
        write_recording(tmp_path, small_recording(name, seconds=0.8))
    write_texture_list(tmp_path, [TextureEntry(0, "Nyatoh", {}), TextureEntry(66, "Steel", {})])
    audio = tmp_path / "sensor_data" / "audio"
    audio.mkdir()
    (audio / "0_0_20_500_0.wav").write_bytes(b"RIFF")
    return tmp_path


def test_inspect_counts_by_every_part_of_a_name(root: Path) -> None:
    assert inspect_dataset(open_dataset(root))["counts"] == {
        "protocol": {"hand": 1, "machine": 4},
        "material": {"Nyatoh": 3, "Steel": 2},
        "speed_mmps": {"20": 3, "40": 1},
        "direction_degrees": {"0": 3, "90": 1},
        "force_millinewtons": {"500": 3, "1000": 1},
        "repeat": {"0": 3, "1": 1},
    }


def test_inspect_prints_ranges_that_reveal_a_wrong_unit(root: Path, capsys: pytest.CaptureFixture[str]) -> None:
    ranges = inspect_dataset(open_dataset(root))["ranges"]
    assert (ranges["force"]["low"], ranges["force"]["high"]) == pytest.approx((0.49, 1.51), abs=0.02)
    # At rest before and after, otherwise at the speeds in the names, including the hand's 400 mm/s.
    assert ranges["speed"]["low"] == pytest.approx(0.0, abs=1.0)
    assert ranges["speed"]["high"] == pytest.approx(400.0, rel=0.02)
    assert 0.005 < ranges["vibration"]["middle"] < 0.2
    assert main(["inspect", str(root)]) == 0
    printed = capsys.readouterr().out
    assert "force         0.49 to 1.51 N, median 0.5 N" in printed
    assert "speed         0 to 400 mm/s" in printed


def test_inspect_names_missing_and_broken_files_and_still_succeeds(
    root: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (root / "sensor_data" / "force" / "66_0_20_500_0.csv").unlink()
    (root / "sensor_data" / "accel" / "0_0_20_500_1.csv").write_text("time,X\n0,1\n1,2\n")
    assert main(["inspect", str(root)]) == 0
    printed = capsys.readouterr().out
    assert "3 recordings" in printed and "2 problems:" in printed
    assert "66_0_20_500_0.csv: missing file; expected the sibling of accel/66_0_20_500_0.csv" in printed
    assert "0_0_20_500_1.csv: columns time,X; expected columns time,X,Y,Z" in printed


def test_inspect_prints_json_that_holds_the_whole_report(
    root: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["inspect", str(root), "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert report["recordings"] == 5 and report["audio_files"] == 1 and report["problems"] == []
    assert report["duration_seconds"]["total"] == pytest.approx(4.0, abs=0.01)
    assert report["provenance"]["licence"] == "CC BY 4.0"


def test_inspect_counts_by_label_where_a_labels_file_is_given(
    root: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    labels = root / "labels.toml"
    labels.write_text(
        '[[label]]\nname = "timber"\ncategory = "wood"\ntextures = ["nyatoh"]\n'
        "stiffness_newtons_per_metre = 1200\nfriction_coefficient = 0.2\n"
    )
    assert main(["inspect", str(root), "--labels", str(labels), "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert report["counts"]["material"] == {"timber": 3} and report["unlabelled"] == 2


def test_inspect_exits_3_where_nothing_is_readable(root: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for path in (root / "sensor_data" / "accel").iterdir():
        path.write_text("")
    assert main(["inspect", str(root)]) == 3
    assert "no recording could be read; the first problem" in capsys.readouterr().err


@pytest.mark.parametrize(("stronger", "directions", "said"), [
    (2.2, range(0, 360, 90), True), (1.0, range(0, 360, 90), False), (2.2, (0,), False),
])  # fmt: skip
def test_what_the_apparatus_adds_to_one_axis_shows_in_the_sum_of_all_directions(
    stronger: float, directions: Sequence[int], said: bool
) -> None:
    """Passes in one direction cannot tell the apparatus from the material."""
    wood = load_materials()[0]
    passes = [
        record_machine_condition(wood, RecordingIdentity(wood.texture_id, direction, 60, 1000, 0), seed=1)
        for direction in directions
    ]
    scaled = [dataclasses.replace(each, acceleration_g=each.acceleration_g * [stronger, 1.0, 1.0]) for each in passes]
    powers = [plane_powers(each) for each in scaled]
    found = x_over_y_db(each for each in powers if each is not None)
    if len(directions) == 1:
        assert found is None
    else:
        assert found is not None and (4.0 < found < 10.0) == said
