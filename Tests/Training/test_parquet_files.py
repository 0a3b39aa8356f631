"""Parquet by Node, on files that Apache's C++ library and DuckDB wrote (Tests/Golden/parquet)."""

from __future__ import annotations

import multiprocessing
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pandas
import pytest
from own_samples import with_sidecar
from parquet_samples import COLUMNS, HUB, HUB_NAMES, column_table, hub_recording, hub_tables

from haptoflow_training.cli import main
from haptoflow_training.errors import InputError
from haptoflow_training.recordings import cluster_dataset_files as parquet_files
from haptoflow_training.recordings.cluster_dataset import open_dataset
from haptoflow_training.recordings.cluster_dataset_files import DatasetFileError, read_parquet, read_sensor
from haptoflow_training.recordings.dataset_layout import ACCELERATION, FORCE, write_recording
from haptoflow_training.recordings.own_files import read_own
from haptoflow_training.recordings.recording import Recording

FLAT = ("row-groups", *(f"codec-{each}" for each in ("uncompressed", "snappy", "gzip", "brotli", "zstd", "lz4hadoop")))
SENSORS = ("acceleration_time_seconds", "force_time_seconds", "position_time_seconds")


@pytest.fixture(autouse=True)
def by_node(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """These tests are of the reader by Node, wherever pyarrow is installed as well."""
    monkeypatch.setattr(parquet_files, "_has_pyarrow", lambda: False)
    yield


@pytest.mark.parametrize("name", FLAT)
def test_every_column_comes_as_it_was_written_in_value_and_type(name: str) -> None:
    table = read_parquet(COLUMNS / f"{name}.parquet")
    pandas.testing.assert_frame_equal(table, column_table(len(table)), check_exact=True)
    assert len(table) == (3000 if name == "row-groups" else 200)


@pytest.mark.parametrize("name", ["nested-v1", "nested-v2"])
def test_numbers_beside_groups_and_lists_are_read_and_the_others_say_what_they_are(name: str) -> None:
    table = read_parquet(COLUMNS / f"{name}.parquet")
    expected = column_table(3000)
    pandas.testing.assert_frame_equal(table[list(expected)], expected, check_exact=True)
    np.testing.assert_array_equal(table["quarter"], expected["count"] / 4)
    others = {"tip": "a group", "pair": "a list", "touched": "true or false", "clock": "a date or a time of day"}
    assert {column: set(table[column]) for column in others} == {column: {kind} for column, kind in others.items()}


def test_one_process_reads_many_files_and_ends_with_the_program() -> None:
    program = (
        "import sys; from pathlib import Path; from haptoflow_training.recordings import cluster_dataset_files as files\n"
        "files._has_pyarrow = lambda: False\n"
        "ids = set()\n"
        "for path in sorted(Path(sys.argv[1]).glob('codec-*.parquet')) * 3:\n"
        "    files.read_parquet(path); ids.add(files._NodeReader._running._process.pid)\n"
        "print(*ids)"
    )
    result = subprocess.run(
        [sys.executable, "-W", "error", "-c", program, str(COLUMNS)], capture_output=True, text=True, timeout=120
    )
    assert result.returncode == 0 and not result.stderr, result.stderr
    (process_id,) = result.stdout.split()
    with pytest.raises(ProcessLookupError):
        os.kill(int(process_id), 0)


def _rows(path: Path) -> int:
    return len(read_parquet(path))


def test_a_forked_process_reads_by_a_node_of_its_own() -> None:
    path = COLUMNS / "codec-snappy.parquet"
    assert _rows(path) == 200
    with multiprocessing.get_context("fork").Pool(2) as pool:
        assert pool.map(_rows, [path] * 8) == [200] * 8
    assert _rows(path) == 200


def _refusal(path: Path) -> str:
    with pytest.raises(DatasetFileError) as caught:
        read_sensor(path, ACCELERATION)
    assert str(caught.value).startswith(str(path))
    return caught.value.found


def test_what_is_no_parquet_file_is_named(tmp_path: Path) -> None:
    good = (COLUMNS / "codec-snappy.parquet").read_bytes()
    path = tmp_path / "0_0_20_500_0.parquet"
    found = {}
    for name, content in {
        "page": b"<!DOCTYPE html><html>",
        "short": b"PAR1",
        "half": good[: len(good) // 2],
        "encrypted": good[:-4] + b"PARE",
        "length": good[:-8] + b"\xff\xff\xff\x7f" + good[-4:],
        "zeros": good[:4] + bytes(len(good) - 3000) + good[len(good) - 2996 :],
    }.items():
        path.write_bytes(content)
        found[name] = _refusal(path)
    assert found["page"] == found["short"] == "not a table (not a Parquet file)"
    assert found["half"] == "not a table (a truncated Parquet file: its end is missing)"
    assert found["encrypted"] == "not a table (an encrypted Parquet file)"
    for name in ("length", "zeros"):
        assert found[name].startswith("not a table (a damaged Parquet file ("), found[name]
    path.write_bytes(good)
    assert len(read_sensor(path, ACCELERATION)[0]) == 199, "a good file is read after the bad ones"


def test_any_changed_byte_gives_a_table_or_a_named_problem_and_the_next_file_is_read(tmp_path: Path) -> None:
    good = (COLUMNS / "codec-snappy.parquet").read_bytes()
    path = tmp_path / "changed.parquet"
    generator = np.random.default_rng(1)
    refused = 0
    for place in generator.integers(len(good), size=300):
        changed = bytearray(good)
        changed[place] ^= int(generator.integers(1, 256))
        path.write_bytes(changed)
        try:
            read_parquet(path)
        except ValueError as error:
            assert "Parquet" in str(error) or "column" in str(error), error
            refused += 1
    assert refused > 30
    assert _rows(COLUMNS / "codec-snappy.parquet") == 200


def test_an_unknown_codec_is_named_with_its_column(tmp_path: Path) -> None:
    # In Thrift's compact form field 4 of a column's metadata is the codec: i32 (0x15), zigzag; 1, Snappy, is 0x02.
    good = (COLUMNS / "text.parquet").read_bytes()
    codec = good.index(b"time_ns", good.rindex(b"time_ns") - 1) + len(b"time_ns")
    assert good[codec : codec + 2] == b"\x15\x02"
    (tmp_path / "lzo.parquet").write_bytes(good[: codec + 1] + b"\x06" + good[codec + 2 :])
    with pytest.raises(ValueError, match="column time_ns is compressed by LZO, which is not known here"):
        read_parquet(tmp_path / "lzo.parquet")


def test_a_missing_column_and_one_that_is_no_number_are_named() -> None:
    assert _refusal(COLUMNS / "text.parquet") == "columns time,X"
    path = COLUMNS / "nested-v1.parquet"
    with pytest.raises(DatasetFileError, match=r"nested-v1\.parquet: text among the numbers .*'a group'.*numbers only"):
        read_sensor(path, type(FORCE)("force", ("time", "tip")))


def test_the_remedy_is_named_where_node_or_its_packages_are_missing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = COLUMNS / "codec-snappy.parquet"
    monkeypatch.setattr(parquet_files._NodeReader, "_running", None)
    with monkeypatch.context() as without:
        without.setattr(shutil, "which", lambda _: None)
        with pytest.raises(InputError, match=r"codec-snappy\.parquet: .*nor Node is installed.*npm ci.*pip install"):
            read_parquet(path)
    # A checkout in which nobody ran `npm ci`.
    for name in ("parquet_server.mjs", "parquet_columns.mjs"):
        shutil.copy(parquet_files.SCRIPT.parent / name, tmp_path)
    monkeypatch.setattr(parquet_files, "SCRIPT", tmp_path / "parquet_server.mjs")
    with pytest.raises(InputError, match=r"codec-snappy\.parquet: .*nor hyparquet is installed; run `npm ci` in "):
        read_parquet(path)


def test_pyarrow_is_asked_where_it_is_installed(monkeypatch: pytest.MonkeyPatch) -> None:
    asked = []

    def by_pyarrow(path: Path, engine: str) -> pandas.DataFrame:
        asked.append((path.name, engine))
        return hub_tables(hub_recording(HUB_NAMES[0]))["accel"]

    monkeypatch.setattr(parquet_files, "_has_pyarrow", lambda: True)
    monkeypatch.setattr(pandas, "read_parquet", by_pyarrow)
    time, _ = read_sensor(COLUMNS / "codec-snappy.parquet", ACCELERATION)
    assert asked == [("codec-snappy.parquet", "pyarrow")]
    np.testing.assert_allclose(time, hub_recording(HUB_NAMES[0]).acceleration_time_seconds, rtol=0, atol=0.6e-9)


@pytest.fixture(scope="module")
def csv_release(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The recordings of Golden/parquet/hub in the file release's layout."""
    root = tmp_path_factory.mktemp("files")
    for name in HUB_NAMES:
        write_recording(root, hub_recording(name))
    shutil.copy(HUB / "texture_list.xlsx", root)
    return root


def _assert_same(of_hub: Recording, of_files: Recording) -> None:
    """Times to the nanosecond, values to float32, which are the units of the hub's release."""
    assert of_hub.identity == of_files.identity and of_hub.label == of_files.label
    for sensor in SENSORS:
        np.testing.assert_allclose(getattr(of_hub, sensor), getattr(of_files, sensor), rtol=0, atol=0.6e-9)
    for sensor in ("acceleration_g", "force_newtons", "position_mm"):
        np.testing.assert_array_equal(getattr(of_hub, sensor), getattr(of_files, sensor).astype(np.float32))


def test_the_hub_s_release_gives_the_recordings_of_the_file_release(csv_release: Path) -> None:
    hub, files = open_dataset(HUB), open_dataset(csv_release)
    assert not hub.problems and hub.published and files.published
    assert [entry.identity.name for entry in hub] == sorted(HUB_NAMES, key=lambda name: int(name.split("_")[0]))
    for of_hub, of_files in zip(hub, files, strict=True):
        assert of_hub.paths[0].suffix == ".parquet" and of_files.paths[0].suffix == ".csv"
        _assert_same(of_hub.load(), of_files.load())


def test_inspect_reads_the_hub_s_release_without_pyarrow(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["inspect", str(HUB)]) == 0
    shown = capsys.readouterr().out
    assert "5 recordings" in shown and "CC BY 4.0" in shown and "problems" not in shown
    assert "position      100.0 Hz" in shown


def test_a_recording_of_one_s_own_is_read_and_its_column_of_text_is_noted(tmp_path: Path) -> None:
    path = tmp_path / "denim.parquet"
    shutil.copy(COLUMNS / "own.parquet", path)
    with_sidecar(path, {"label": "denim"})
    recording = read_own(path)
    assert recording.label == "denim" and recording.acceleration is not None
    row = np.arange(4000)
    expected = (((row * 37) % 101 - 50) / 25).astype(np.float32)
    np.testing.assert_allclose(recording.acceleration.values[:, 0], expected, rtol=1e-7)
    np.testing.assert_allclose(recording.acceleration.time_seconds, row / 2000, atol=1e-12)
    assert any("remark" in note for note in recording.notes)
