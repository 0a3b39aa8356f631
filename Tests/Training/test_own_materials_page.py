"""Runs the commands of two sections of own-materials.md as printed, on recordings of every form."""

from __future__ import annotations

import json
import re
import shlex
import shutil
from pathlib import Path

import numpy as np
import pytest
from own_samples import csv_one_axis, csv_three_axes, stroke, wav_with_motion

from haptoflow_benchmark import cli as benchmark
from haptoflow_training import cli as training
from haptoflow_training.errors import InputError
from haptoflow_training.export.model_file import read_model_file
from haptoflow_training.model_stamp import SHIPPED_MODEL
from haptoflow_training.recordings.native_recording import read_native

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "Documentation~" / "own-materials.md"
TEMPLATE = ROOT / "Training" / "templates" / "own-recordings"
# Keys of a sidecar without an underscore, which a sentence may also hold as words.
SHORT_KEYS = {"label", "motion", "licence", "source"}
HEADINGS = ("Recordings: forms, units, labels, licence", "Training a model on your recordings")
LABELS = (
    '[[label]]\nname = "{name}"\ncategory = "own"\nstiffness_newtons_per_metre = 400.0\nfriction_coefficient = 0.4\n'
    "wave_vectors_per_mm = []\n"
)
PROGRAMS = {"haptoflow_benchmark": benchmark.main, "haptoflow_training": training.main}


def commands(heading: str) -> list[list[str]]:
    """The words of each command, its program first, in the blocks without a language below a heading."""
    section = PAGE.read_text(encoding="utf-8").split(f"\n## {heading}\n")[1].split("\n## ")[0]
    # Every second part lies inside a block; one with a language begins with its name.
    blocks = [part for part in section.split("\n```")[1::2] if part.startswith("\n")]
    lines = [line for block in blocks for line in block.strip().splitlines()]
    found = []
    for line in lines:
        python = re.fullmatch(r"PYTHONPATH=Training python3 -m haptoflow_(?:training|benchmark) .*", line)
        npm = re.fullmatch(r"npm run (train|evaluate) -- (.*)", line)
        assert python or npm, f"not a command of this page: {line}"
        if npm:
            program = {"train": "haptoflow_training", "evaluate": "haptoflow_benchmark"}[npm[1]]
            found.append([program, npm[1], *shlex.split(npm[2])])
        else:
            found.append(shlex.split(line)[3:])
    return found


@pytest.fixture(scope="module")
def standing(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with recordings of every form, one label and one recording each."""
    folder = tmp_path_factory.mktemp("own")
    made = folder / "recordings"
    csv_one_axis(made, "denim", "denim", stroke(11.0, hertz=90, seed=1), licence="CC0 1.0", source="a jacket")
    csv_three_axes(made / "tiles", "tile", "tile", stroke(11.0, hertz=320, exponent=1.3, seed=2))
    wav_with_motion(made, "felt", "felt", stroke(11.0, hertz=180, exponent=0.6, seed=3), licence="CC BY 4.0")
    (folder / "labels.toml").write_text("".join(LABELS.format(name=name) for name in ("denim", "tile", "felt")))
    return folder


def test_every_command_of_the_page_runs_where_the_recordings_are(
    standing: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(standing)
    ran = []
    for heading in HEADINGS:
        for program, *words in commands(heading):
            shortened = ["0.1" if before == "--minutes" else word for before, word in zip(["", *words], words)]
            assert PROGRAMS[program](shortened) == 0, (words, capsys.readouterr().err)
            ran.append(words[0])
    assert ran == ["inspect", "inspect", "train", "evaluate", "discriminate"]
    header = read_model_file(standing / "own.haptoflow").header
    shipped = read_model_file(ROOT / SHIPPED_MODEL).header
    known = [label["name"] for label in shipped["labels"]]
    assert [label["name"] for label in header["labels"]] == [*known, "denim", "tile", "felt"]
    assert [tier["name"] for tier in header["tiers"]] == [tier["name"] for tier in shipped["tiers"]]
    assert set(header["provenance"]["licence"].split(", ")) == {"MIT", "CC0 1.0", "CC BY 4.0", "unknown"}
    assert str(standing) not in json.dumps(header)
    accuracy = json.loads((standing / "out" / "own" / "accuracy" / "own-accuracy.json").read_text())
    assert {one["label"] for one in accuracy["labels"]} == {"denim", "tile", "felt"}
    for one in accuracy["labels"]:
        assert one["seconds"] >= 1.0 and np.isfinite(one["level_error_median_db"]) and 0.0 <= one["gfc"] <= 1.0
        assert abs(one["level_error_median_db"]) < 2.0 and one["gfc"] > 0.8
    assert (standing / "out" / "own" / "accuracy" / "own-accuracy.png").stat().st_size > 5000
    discrimination = json.loads((standing / "out" / "own" / "discrimination" / "label-discrimination.json").read_text())
    assert discrimination["recording_accuracy"] == 1.0


def test_the_template_can_be_inspected_and_prepared_as_it_is(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    shutil.copytree(TEMPLATE, tmp_path / "own")
    monkeypatch.chdir(tmp_path / "own")
    assert training.main(["inspect", "recordings", "--labels", "labels.toml", "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert report["counts"]["material"] == {"denim": 1, "felt": 1}
    assert report["problems"] == [] and report["notes"] == []
    assert report["provenance"]["licence"] == "MIT"
    assert training.main(["prepare", "--recordings", "recordings", "--labels", "labels.toml", "--out", "store"]) == 0


def test_the_page_lists_exactly_the_columns_and_keys_that_are_read() -> None:
    section = PAGE.read_text(encoding="utf-8").split(f"\n## {HEADINGS[0]}\n")[1].split("\n## ")[0]
    named = {word for code in re.findall(r"`([^`\n]+)`", section) for word in re.findall(r"[a-z0-9_]+", code)}
    plain = "time_s,acceleration_mps2\n" + "".join(f"0.00{row},{row % 3}\n" for row in range(1, 9))
    known = {"time_s"}
    for files in (
        {"a.csv": "time_s,mood\n0,1\n"},
        {"a.csv": plain},
        {"a.csv": plain, "a.json": '{"speed_mps": 0.1}'},
        {"a.csv": plain, "a.json": '{"mood": 1}'},
    ):
        with pytest.raises(InputError, match="; expected ") as raised:
            read_native(Path("a.csv"), {name: text.encode() for name, text in files.items()}, complete=True)
        expected = str(raised.value).split("; expected ")[1]
        known |= {word for word in re.findall(r"[a-z0-9_]+", expected) if "_" in word or word in SHORT_KEYS}
    assert len(known) >= 25, known
    assert known <= named, known - named


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["evaluate", "--model", "own.haptoflow"], "--recordings is missing"),
        (["evaluate", "--recordings", "gone"], "gone: does not exist"),
        (["evaluate", "--recordings", "recordings"], "no recording of a label of default.haptoflow; found denim"),
        (["train", "--recordings", "recordings", "--out", "out/x"], "of your own; name their labels.*--labels FILE"),
        (["evaluate", "--recordings", "recordings", "--engine", "gone"], "run `npm run build`"),
    ],
)
def test_missing_input_is_reported_in_one_line(
    standing: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], words: list[str], said: str
) -> None:
    monkeypatch.chdir(standing)
    program = training if words[0] == "train" else benchmark
    assert program.main(words) == 3
    error = capsys.readouterr().err.strip().splitlines()[-1]
    assert re.search(said, error), error
