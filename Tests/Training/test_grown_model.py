"""Labels of one's own in the shipped model, by the commands of own-materials.md: the networks stay, the labels find their
places, and the end is judged."""

from __future__ import annotations

import json
import math
import re
import shlex
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import torch
from numpy.typing import NDArray
from own_samples import csv_one_axis, csv_three_axes, stroke, wav_with_motion, write_table

from haptoflow_benchmark import cli as benchmark
from haptoflow_benchmark.own_accuracy import LabelAccuracy, verdict
from haptoflow_training import cli
from haptoflow_training.commands import train as train_command
from haptoflow_training.commands.train import OWN_CONFIGURATION
from haptoflow_training.export.grown_model import without_labels
from haptoflow_training.export.model_file import ModelFile, model_space, read_model_file
from haptoflow_training.export.skeleton_tensors import skeleton_weights
from haptoflow_training.export.learning import learn_material
from haptoflow_training.recordings.own_files import open_own
from haptoflow_training.training.trainer import load_trained
from places import DEFAULT, ROOT, SMALL

PAGE = ROOT / "Documentation~" / "own-materials.md"
TEMPLATE = ROOT / "Training" / "templates" / "own-recordings"
HEADINGS = ("Recordings: forms, units, labels, licence", "Training a model on your recordings")
PROGRAMS = {"haptoflow_benchmark": benchmark.main, "haptoflow_training": cli.main}
LABEL = '[[label]]\nname = "{}"\ncategory = "own"\nstiffness_newtons_per_metre = 431.0\nfriction_coefficient = 0.41\n'


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


def _ribbed(path: Path, degrees: float) -> None:
    """A ruled surface, 1.6 mm from rib to rib, across a direction."""
    made = stroke(10.0, hertz=300, seed=8)
    across = np.array([math.cos(math.radians(degrees)), math.sin(math.radians(degrees))])
    speed = np.hypot(*made.velocity_mps.T)
    ribs = np.cos(2.0 * np.pi * (made.position_mm @ across) / 1.6)
    wave = made.acceleration_mps2 * 0.5 + 25.0 * speed * ribs
    columns: dict[str, NDArray[np.floating]] = {
        "time_s": made.time_seconds, "acceleration_mps2": wave, "velocity_x_mps": made.velocity_mps[:, 0],
        "velocity_y_mps": made.velocity_mps[:, 1], "force_newtons": made.force_newtons,
    }  # fmt: skip
    write_table(path, columns, {"label": "rack", "licence": "CC0 1.0"})


@pytest.fixture(scope="module")
def grown(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """A folder with recordings in every form of `wood`, which the shipped model knows, and of ribs, in which every command
    of the page has run; only the training has fewer steps."""
    folder = tmp_path_factory.mktemp("grown")
    made = folder / "recordings"
    csv_one_axis(made, "plank", "wood", stroke(11.0, hertz=140, seed=1), licence="CC0 1.0", source="a shelf")
    csv_three_axes(made / "tiles", "board", "wood", stroke(6.0, hertz=140, seed=2))
    wav_with_motion(made, "floor", "wood", stroke(6.0, hertz=140, seed=3), licence="CC BY 4.0")
    _ribbed(made / "rack.csv", 35.0)
    (folder / "labels.toml").write_text(LABEL.format("wood") + LABEL.format("rack"), encoding="utf-8")
    quick = folder / "quick.toml"
    quick.write_text(f'extends = "{OWN_CONFIGURATION}"\n[recipe]\nembedding_steps = 80\n', encoding="utf-8")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        ran = []
        for heading in HEADINGS:
            for program, *words in commands(heading):
                more = ["--config", str(quick)] if words[0] == "train" else []
                assert PROGRAMS[program]([*words, *more]) == 0, words
                ran.append(words[0])
        assert ran == ["inspect", "inspect", "train", "evaluate", "discriminate"]
        yield folder


def test_every_command_of_the_page_writes_what_it_names(grown: Path) -> None:
    assert {one["label"] for one in _accuracies(grown)} == {"wood", "rack"}
    for one in _accuracies(grown):
        assert one["seconds"] >= 1.0 and abs(one["level_error_median_db"]) < 2.0 and 0.8 < one["gfc"] <= 1.0, one
    assert (grown / "out" / "own" / "accuracy" / "own-accuracy.png").stat().st_size > 5000
    discrimination = json.loads((grown / "out" / "own" / "discrimination" / "label-discrimination.json").read_text())
    assert discrimination["recording_accuracy"] == 1.0


def _accuracies(grown: Path) -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = json.loads((grown / "out/own/accuracy/own-accuracy.json").read_text())["labels"]
    return found


def test_the_networks_are_those_that_it_began_with(grown: Path) -> None:
    shipped, file = read_model_file(DEFAULT), read_model_file(grown / "own.haptoflow")
    assert file.graphs == shipped.graphs and model_space(file) == model_space(shipped)
    for name, tensor in shipped.tensors.items():
        if name not in ("embedding", "pieces"):
            np.testing.assert_array_equal(file.tensors[name], tensor)
    _, _, model = load_trained(grown / "out" / "own")
    trained = model.state_dict()
    for name, weights in skeleton_weights(shipped).items():
        assert torch.equal(trained[name], weights), name


def test_the_run_is_exported_again_as_it_was(grown: Path, tmp_path: Path) -> None:
    words = ["--run", str(grown / "out" / "own"), "--store", str(grown / "out" / "store"), "--out", str(tmp_path / "again.haptoflow")]
    assert cli.main(["export", *words]) == 0
    assert (tmp_path / "again.haptoflow").read_bytes() == (grown / "own.haptoflow").read_bytes()


def test_a_label_of_a_known_name_is_replaced_and_a_new_one_is_added(grown: Path) -> None:
    shipped, file = read_model_file(DEFAULT), read_model_file(grown / "own.haptoflow")
    names = [label["name"] for label in shipped.header["labels"] if label["name"] != "wood"]
    assert [label["name"] for label in file.header["labels"]] == [*names, "wood", "rack"]
    wood, rack = file.header["labels"][-2:]
    for label in (wood, rack):
        assert label["friction_coefficient"] == 0.41 and label["stiffness_newtons_per_metre"] == 431.0
        assert label["category"] == "own" and "tone" in label and "level" in label
    assert rack["periodic"] and rack["wavelength_metres"] == pytest.approx(1.6e-3, rel=0.01)
    for label in shipped.header["labels"]:
        if label["name"] != "wood":
            same = next(each for each in file.header["labels"] if each["name"] == label["name"])
            row, own = label["embedding_row"], same["embedding_row"]
            np.testing.assert_array_equal(file.tensors["embedding"][own], shipped.tensors["embedding"][row])
    stated = file.header["provenance"]
    assert set(stated["licence"].split(", ")) == {"MIT", "CC0 1.0", "CC BY 4.0", "unknown"}
    assert str(grown) not in json.dumps(file.header)


def test_ribs_are_turned_as_learning_turns_them(grown: Path) -> None:
    file = read_model_file(grown / "own.haptoflow")
    turned = file.header["provenance"]["turned_degrees"]
    assert list(turned) == ["rack"]
    recording = open_own(grown / "recordings" / "rack.csv")
    _, report = learn_material(SMALL, recording, "rack", seconds_limit=1.0)
    # The library looks at the whole recording, training at its own part.
    assert math.remainder(turned["rack"] - report["turn_degrees"], 180.0) == pytest.approx(0.0, abs=1.0)
    row = next(label["embedding_row"] for label in file.header["labels"] if label["name"] == "rack")
    assert file.tensors["embedding"][row, -4:] == pytest.approx([1.0 / 1.6, 0.0, 0.0, 0.0], abs=0.01)


def test_a_label_with_too_little_to_fit_level_and_tone_is_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(train_command, "MINIMUM_MINUTES", 0.01)
    csv_one_axis(tmp_path / "recordings", "short", "felt", stroke(2.5, hertz=140, seed=7))
    (tmp_path / "labels.toml").write_text(LABEL.format("felt"), encoding="utf-8")
    words = ["--recordings", str(tmp_path / "recordings"), "--labels", str(tmp_path / "labels.toml"), "--minutes", "0.03"]
    out = ["--out", str(tmp_path / "run"), "--export", str(tmp_path / "own.haptoflow")]
    assert cli.main(["train", *words, *out]) == 3
    shown = capsys.readouterr().err
    assert "label 'felt'" in shown and "record 10 s or more" in shown
    assert not (tmp_path / "own.haptoflow").exists()


def test_labels_that_are_taken_out_leave_the_rows_of_the_others() -> None:
    labels = [{"name": name, "embedding_row": row} for row, name in enumerate(("a", "b", "c"))]
    rows = np.arange(9, dtype=np.float32).reshape(3, 3)
    file = ModelFile({"labels": labels}, {"embedding": rows, "level.law.bias": rows[0]}, {})
    left = without_labels(file, ["b", "z"])
    assert left.header["labels"] == [{"name": "a", "embedding_row": 0}, {"name": "c", "embedding_row": 1}]
    np.testing.assert_array_equal(left.tensors["embedding"], rows[[0, 2]])
    np.testing.assert_array_equal(left.tensors["level.law.bias"], rows[0])


def _accuracy(level_db: float, gfc: float, lsd_db: float) -> LabelAccuracy:
    return LabelAccuracy("a", 1, 2.0, (level_db,), gfc, lsd_db, ())


@pytest.mark.parametrize(
    ("level_db", "gfc", "lsd_db", "is_worse"),
    [(-0.3, 0.98, 1.2, False), (-0.3, 0.96, 1.2, False), (0.3, 0.96, 1.6, True), (-0.9, 0.98, 1.6, True)],
)
def test_a_model_is_not_worth_using_if_learning_is_ahead_in_two_of_three_figures(
    level_db: float, gfc: float, lsd_db: float, is_worse: bool
) -> None:
    words, found = verdict([_accuracy(level_db, gfc, lsd_db)], [_accuracy(0.5, 0.97, 1.5)])
    assert found == is_worse
    assert words.startswith("not worth using" if is_worse else "worth using")
    assert "level 0.50 dB, GFC 0.970, LSD 1.50 dB" in words


def test_the_template_can_be_inspected_and_prepared_as_it_is(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    shutil.copytree(TEMPLATE, tmp_path / "own")
    monkeypatch.chdir(tmp_path / "own")
    assert cli.main(["inspect", "recordings", "--labels", "labels.toml", "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert report["counts"]["material"] == {"denim": 1, "felt": 1}
    assert report["problems"] == [] and report["notes"] == []
    assert report["provenance"]["licence"] == "MIT"
    assert cli.main(["prepare", "--recordings", "recordings", "--labels", "labels.toml", "--out", "store"]) == 0


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["evaluate", "--model", "own.haptoflow"], "--recordings is missing"),
        (["evaluate", "--recordings", "gone"], "gone: does not exist"),
        (["evaluate", "--recordings", "recordings/rack.csv"], "no recording of a label of default.haptoflow; found rack"),
        (["train", "--recordings", "recordings", "--out", "out/x"], "of your own; name their labels.*--labels FILE"),
        (["evaluate", "--recordings", "recordings", "--engine", "gone"], "run `npm run build`"),
    ],
)
def test_missing_input_is_reported_in_one_line(
    grown: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], words: list[str], said: str
) -> None:
    monkeypatch.chdir(grown)
    program = cli if words[0] == "train" else benchmark
    assert program.main(words) == 3
    error = capsys.readouterr().err.strip().splitlines()[-1]
    assert re.search(said, error), error
