"""Folders as laboratories have them: no file hides the others, and nothing is corrected without a word."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from own_samples import csv_one_axis, stroke, with_sidecar

from haptoflow_training.cli import main
from haptoflow_training.preprocessing.preparation import prepare_store
from haptoflow_training.recordings.labels import plain_name
from haptoflow_training.recordings.own_files import open_own_dataset
from places import SMALL, TRAINING

DEGREES = "columns Temp (\\xB0C) are not known and are ignored"


def with_column(path: Path, head: bytes, cell: bytes) -> Path:
    first, *rows = path.read_bytes().splitlines()
    path.write_bytes(b"\n".join([first + b"," + head, *(row + b"," + cell for row in rows)]) + b"\n")
    return path


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A good file, one with a column in Latin-1, one with a name in Latin-1, one whose force has the other sign, one
    whose force was not zeroed, and one that is no table."""
    made = stroke(4.0)
    root = tmp_path / "recordings"
    csv_one_axis(root, "good", "denim", made)
    with_column(csv_one_axis(root, "degrees", "denim", made), b"Temp (\xb0C)", b"21\xb0")
    named = csv_one_axis(root, "maerz", "denim", made)
    os.rename(named, os.path.join(os.fsencode(root), b"m\xe4rz.csv"))
    os.rename(named.with_suffix(".json"), os.path.join(os.fsencode(root), b"m\xe4rz.json"))
    force = made.force_newtons
    csv_one_axis(root, "turned", "denim", type(made)(**{**vars(made), "force_newtons": -force}))
    resting = np.where(made.time_seconds < 0.1, -0.05, force)
    csv_one_axis(root, "zero", "denim", type(made)(**{**vars(made), "force_newtons": resting}))
    (root / "broken.csv").write_bytes(b"\xff\xfe\x00t")
    with_sidecar(root / "broken.csv", {"label": "denim"})
    return root


def test_inspect_shows_the_folder_and_says_what_is_wrong_with_each_file(folder: Path) -> None:
    # In a process of its own, whose terminal is one of UTF-8.
    done = subprocess.run(
        [sys.executable, "-m", "haptoflow_training", "inspect", str(folder)], capture_output=True, encoding="utf-8",
        env={**os.environ, "PYTHONPATH": str(TRAINING), "PYTHONIOENCODING": "utf-8"}, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert ": 4 recordings" in done.stdout
    assert f"degrees.csv: {DEGREES}" in done.stdout
    assert "broken.csv: is text in UTF-16; expected a table in UTF-8" in done.stdout
    assert "turned.csv: force_newtons is negative in 100 % of the sliding" in done.stdout
    assert 'give the key "force_sign": -1 in turned.json' in done.stdout
    assert "zero.csv: force_newtons is below 0 in 2.5 % of its samples, down to -0.05 N, and taken as 0" in done.stdout
    assert "2 problems:" in done.stdout
    assert "Traceback" not in done.stderr


def test_a_material_is_made_of_the_files_of_a_folder_that_can_be_used(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "denim.haptomaterial"
    words = ["--model", str(SMALL), "--recording", str(folder), "--seconds-limit", "1", "-o", str(out)]
    assert main(["add-material", *words]) == 0
    said = capsys.readouterr().err
    assert out.is_file()
    assert "skipped: " in said and "turned.csv: force_newtons is negative" in said
    assert "broken.csv: is text in UTF-16" in said
    assert "zero.csv: force_newtons is below 0" in said
    assert DEGREES in said


def test_a_file_that_is_named_alone_is_refused_with_its_sentence(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ["add-material", "--model", str(SMALL), "-o", str(tmp_path / "a.haptomaterial"), "--recording"]
    assert main([*words, str(folder / "turned.csv")]) == 3
    assert "--force-sign -1" in capsys.readouterr().err
    with_sidecar(folder / "turned.csv", {"label": "denim", "force_sign": -1})
    assert main([*words, str(folder / "turned.csv"), "--seconds-limit", "1"]) == 0


def test_training_takes_no_force_below_nothing_and_keeps_what_was_said(folder: Path, tmp_path: Path) -> None:
    dataset = open_own_dataset(folder)
    assert [problem.path.name for problem in dataset.problems] == ["broken.csv"]
    store = prepare_store(list(dataset), ["denim"], tmp_path / "store")
    assert [one.name for one in store.skipped] == ["turned.csv"]
    assert sorted(one.name for one in store.recordings) == ["degrees.csv", "good.csv", "m\\xe4rz.csv", "zero.csv"]
    assert sum("force_newtons is below 0" in note for note in store.notes) == 1
    assert float(store.motion[:, 2].min()) > -0.01


def test_names_of_every_script_are_told_apart_and_known_however_their_accents_are_encoded() -> None:
    assert plain_name("A\u0308hre 2") == plain_name("\u00c4hre-2") == "\u00e4hre2"
    assert plain_name("Metal_Mesh") == plain_name("metal mesh") == "metalmesh"
    names = ("\u5e03", "\u9244", "\u00e4hre", "\u00f6hre", "\u0939\u093f", "\u0939\u0940")
    assert len({plain_name(name) for name in names}) == len(names) and "" not in map(plain_name, names)
