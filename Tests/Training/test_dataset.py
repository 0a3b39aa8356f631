from __future__ import annotations

import dataclasses
import json
import pickle
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas
import pytest

from dataset_samples import small_recording
from haptoflow_training.cli import main
from haptoflow_training.errors import InputError
from haptoflow_training.recordings.dataset_inspection import inspect_dataset, plane_powers, x_over_y_db
from haptoflow_training.recordings.cluster_dataset import open_dataset, read_texture_list
from haptoflow_training.recordings.cluster_dataset_files import DatasetFileError
from haptoflow_training.recordings.dataset import Dataset
from haptoflow_training.recordings.dataset_layout import (
    TextureEntry, published_name, write_recording, write_texture_list
)
from haptoflow_training.recordings.labels import load_labels
from haptoflow_training.recordings.recording import Recording, RecordingIdentity
from haptoflow_training.recordings.synthetic import load_materials, record_condition_of

NAMES = ["0_0_20_500_0", "0_135_40_500_0", "66_90_60_1000_1", "0_hand_400_1500_3"]
KINDS = ("accel", "force", "position")


def assert_same(first: Recording, second: Recording) -> None:
    assert first.identity == second.identity
    for sensor in ("acceleration_time_seconds", "force_time_seconds", "position_time_seconds"):
        np.testing.assert_array_equal(getattr(first, sensor), getattr(second, sensor))
    for sensor in ("acceleration_g", "force_newtons", "position_mm"):
        np.testing.assert_array_equal(getattr(first, sensor), getattr(second, sensor))


@pytest.fixture
def file_release(tmp_path: Path) -> Path:
    root = tmp_path / "files"
    for name in NAMES:
        write_recording(root, small_recording(name, seconds=0.8))
    return root


def sensor_file(root: Path, kind: str, name: str = NAMES[1]) -> Path:
    return root / "sensor_data" / kind / f"{name}.csv"


def only_problem(dataset: Dataset) -> DatasetFileError:
    """The single problem that occurs when every recording is loaded."""
    found = []
    for entry in dataset:
        try:
            entry.load()
        except DatasetFileError as error:
            found.append(error)
    assert len(found) == 1
    return found[0]


def test_what_is_written_comes_back_without_loss_from_the_file_release(file_release: Path) -> None:
    dataset = open_dataset(file_release)
    assert not dataset.problems
    assert sorted(entry.identity.name for entry in dataset) == sorted(NAMES)
    for entry in dataset:
        assert_same(entry.load(), small_recording(entry.identity.name, seconds=0.8))


def test_a_recording_that_is_not_finite_is_not_written(tmp_path: Path) -> None:
    recording = small_recording(seconds=0.5)
    recording.position_mm[3, 0] = np.inf
    with pytest.raises(ValueError, match="position holds values that are not finite"):
        write_recording(tmp_path, recording)
    assert not list(tmp_path.rglob("*position*/*"))


def test_a_file_half_written_is_never_seen(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_recording(tmp_path, small_recording(seconds=0.5))
    before = {path: path.read_bytes() for path in tmp_path.rglob("*.csv")}

    def half(self: Path, data: bytes) -> None:
        assert self.suffix == ".part", "a reader could see this file"
        with self.open("wb") as file:
            file.write(data[: len(data) // 2])
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "write_bytes", half)
    with pytest.raises(InputError, match="No space"):
        write_recording(tmp_path, small_recording(seconds=0.6))
    assert {path: path.read_bytes() for path in tmp_path.rglob("*.csv")} == before


@pytest.mark.parametrize(
    ("kind", "text", "found"),
    [
        ("accel", "", "empty file"),
        ("accel", "t,x,y,z\n0,0,0,0\n1,0,0,0\n", "columns t,x,y,z"),
        ("accel", "time,X,Y\n0,0,0\n1,0,0\n", "columns time,X,Y"),
        ("force", "time,force\n", "0 rows"),
        ("force", "time,force\n0,0.5\n0.1,\n", "no number in row 3, column force"),
        ("force", "time,force\n0,0.5\nnan,0.5\n", "no number in row 3, column time"),
        ("force", "time,force\n0,0.5\n1,inf\n", "no number in row 3, column force"),
        ("force", "time,force\n0,0.5\n0.1,soft\n", "text among the numbers"),
        ("position", "time,X,Y\n0,0,0\n0.2,1,0\n0.1,2,0\n", "time runs back at row 4"),
        ("position", "time,X,Y\n0,0,0\n0,1,0\n0,2,0\n", "2 of 3 time stamps repeat"),
        ("accel", "\x00\x01\x02" * 40, ""),
    ],
)
def test_a_broken_file_is_named_with_what_was_expected(file_release: Path, kind: str, text: str, found: str) -> None:
    path = sensor_file(file_release, kind)
    path.write_text(text)
    problem = only_problem(open_dataset(file_release))
    assert problem.path == path
    assert found in problem.found
    assert problem.expected


def test_a_stray_repeated_time_stamp_is_dropped(file_release: Path) -> None:
    path = sensor_file(file_release, "accel")
    lines = path.read_text().splitlines()
    path.write_text("\n".join([*lines[:100], lines[99], *lines[100:]]) + "\n")
    entry = next(entry for entry in open_dataset(file_release) if entry.identity.name == NAMES[1])
    assert_same(entry.load(), small_recording(NAMES[1], seconds=0.8))


@pytest.mark.parametrize("kind", KINDS)
def test_a_missing_sibling_is_a_problem_and_the_rest_stays_readable(file_release: Path, kind: str) -> None:
    sensor_file(file_release, kind).unlink()
    dataset = open_dataset(file_release)
    assert [problem.path for problem in dataset.problems] == [sensor_file(file_release, kind)]
    assert dataset.problems[0].found == "missing file"
    assert len(dataset) == len(NAMES) - 1


def test_a_file_of_another_name_is_a_problem_and_hidden_files_are_not(file_release: Path) -> None:
    folder = file_release / "sensor_data" / "accel"
    (folder / "readme.csv").write_text("hello")
    (folder / ".123.0_0_20_500_0.csv").write_text("unfinished")
    problems = open_dataset(file_release).problems
    assert [problem.path.name for problem in problems] == ["readme.csv"]


def test_a_folder_without_sensor_data_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="expected the folder that holds sensor_data"):
        open_dataset(tmp_path)


def test_recording_files_and_their_errors_can_be_passed_to_another_process(file_release: Path) -> None:
    entry = open_dataset(file_release).recordings[0]
    assert pickle.loads(pickle.dumps(entry)) == entry
    error = DatasetFileError(Path("a.csv"), "empty file", "columns")
    again = pickle.loads(pickle.dumps(error))
    assert (again.path, again.found, str(again)) == (error.path, error.found, str(error))


@pytest.mark.parametrize(
    ("headings", "title_rows"),
    [
        (["id", "name", "static friction", "kinetic friction"], 0),
        (["ID", "Texture Name", "Static friction coefficient", "Kinetic Friction Coefficient"], 0),
        (["No.", "Material", "μ static friction", "μ kinetic friction"], 2),
    ],
)
def test_a_texture_list_is_understood_with_other_headings(tmp_path: Path, headings: list[str], title_rows: int) -> None:
    rows = [[None] * 4] * title_rows + [headings, [38, " Granite ", 0.4, 0.3], [48, "Concrete", None, 0.5], [None] * 4]
    pandas.DataFrame(rows).to_excel(tmp_path / "texture_list.xlsx", header=False, index=False)
    found = read_texture_list(tmp_path)
    assert found == {38: "Granite", 48: "Concrete"}


def test_the_published_names_are_used_if_the_texture_list_is_the_published_one(file_release: Path) -> None:
    write_texture_list(file_release, [TextureEntry(0, "nyatoh", {})])
    assert open_dataset(file_release).textures == {0: "nyatoh", 66: "Steel"}
    known = {38: "Granite", 48: "Concrete", 49: "HDPE", 64: "Carbon fiber", 73: "Titanium", 81: "Sandpaper"}
    known |= {82: "Alumina", 86: "Earth style porcelain", 87: "Jute", 101: "Seal skin", 104: "cloth 104"}
    assert {texture_id: published_name(texture_id) for texture_id in known} == known


def test_a_damaged_texture_list_is_a_problem_but_not_fatal(file_release: Path) -> None:
    (file_release / "texture_list.xlsx").write_bytes(b"not a workbook")
    dataset = open_dataset(file_release)
    assert [problem.path.name for problem in dataset.problems] == ["texture_list.xlsx"]
    assert dataset.textures[66] == "texture 66"
    assert dataset.provenance["licence"] == "unknown"


def test_labels_are_found_by_id_and_by_the_name_in_the_texture_list(tmp_path: Path) -> None:
    for name in ("0_0_20_500_0", "1_0_20_500_0", "105_0_20_500_0"):
        write_recording(tmp_path, small_recording(name, seconds=0.5))
    write_texture_list(
        tmp_path,
        [TextureEntry(0, "Nyatoh", {}), TextureEntry(1, "Oak", {}), TextureEntry(105, "cotton-broadcloth", {})],
    )
    dataset = open_dataset(tmp_path, load_labels())
    assert [(entry.identity.texture_id, entry.label) for entry in dataset] == [(0, "wood"), (105, "cotton")]
    assert [entry.identity.texture_id for entry in dataset.unlabelled] == [1]


GOOD_LABEL = (
    '[[label]]\nname = "wood"\ncategory = "wood"\ntextures = [0]\n'
    "stiffness_newtons_per_metre = 1200.0\nfriction_coefficient = 0.22\n"
)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", r"no \[\[label\]\] entries"),
        ("[[label", "not valid TOML"),
        (GOOD_LABEL.replace('category = "wood"\n', ""), "label 1: key 'category' is missing"),
        (GOOD_LABEL.replace("[0]", "[true]"), "label 1: key 'textures'"),
        (GOOD_LABEL.replace("1200.0", "-1"), "label 1: key 'stiffness_newtons_per_metre' is -1"),
        (GOOD_LABEL + "colour = 3\n", "label 1: unknown key 'colour'"),
        (GOOD_LABEL.replace('"wood"', '"Wood"', 1), "'Wood'; expected lower case, as the engine reads labels: 'wood'"),
        (GOOD_LABEL + GOOD_LABEL, "label 'wood' occurs twice"),
        (GOOD_LABEL + GOOD_LABEL.replace('name = "wood"', 'name = "oak"'), "texture 0 belongs to 'wood' and to 'oak'"),
    ],
)
def test_a_wrong_labels_file_is_refused_by_entry_and_key(tmp_path: Path, text: str, words: str) -> None:
    path = tmp_path / "labels.toml"
    path.write_text(text)
    with pytest.raises(InputError, match=words):
        load_labels(path)


INSPECT_NAMES = ["0_0_20_500_0", "0_0_20_500_1", "0_90_40_1000_0", "66_0_20_500_0", "66_hand_400_1500_3"]


@pytest.fixture
def root(tmp_path: Path) -> Path:
    for name in INSPECT_NAMES:
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


def test_inspect_counts_by_label_where_a_labels_file_is_given(root: Path, capsys: pytest.CaptureFixture[str]) -> None:
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
        record_condition_of(wood, RecordingIdentity(wood.texture_id, direction, 60, 1000, 0), seed=1)
        for direction in directions
    ]
    scaled = [dataclasses.replace(each, acceleration_g=each.acceleration_g * [stronger, 1.0, 1.0]) for each in passes]
    powers = [plane_powers(each) for each in scaled]
    found = x_over_y_db(each for each in powers if each is not None)
    if len(directions) == 1:
        assert found is None
    else:
        assert found is not None and (4.0 < found < 10.0) == said
