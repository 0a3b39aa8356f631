"""Labels of one's own in the shipped model: the networks stay, the labels find their places, and the end is judged."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
import torch
from numpy.typing import NDArray
from own_samples import csv_one_axis, stroke, write_table

from haptoflow_benchmark.own_accuracy import LabelAccuracy, verdict
from haptoflow_training import cli
from haptoflow_training.export.grown_model import without_labels
from haptoflow_training.export.model_file import ModelFile, model_space, read_model_file
from haptoflow_training.export.skeleton_tensors import skeleton_weights
from haptoflow_training.fewshot.learning import MaterialWords, learn_material
from haptoflow_training.model_stamp import SHIPPED_MODEL
from haptoflow_training.recordings.own_files import read_own
from haptoflow_training.training.trainer import load_trained

SHIPPED = Path(__file__).parents[2] / SHIPPED_MODEL
LABEL = '[[label]]\nname = "{}"\ncategory = "own"\nstiffness_newtons_per_metre = 431.0\nfriction_coefficient = 0.41\n'


def _ribbed(path: Path, degrees: float) -> None:
    """A ruled surface, 1.6 mm from rib to rib, across a direction."""
    made = stroke(14.0, hertz=300, seed=8)
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
def grown(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with recordings of `wood`, which the shipped model knows, and of ribs; the run; and the model file."""
    folder = tmp_path_factory.mktemp("grown")
    csv_one_axis(folder / "recordings", "plank", "wood", stroke(14.0, hertz=140, seed=7))
    _ribbed(folder / "recordings" / "rack.csv", 35.0)
    (folder / "labels.toml").write_text(LABEL.format("wood") + LABEL.format("rack"), encoding="utf-8")
    words = ["--recordings", str(folder / "recordings"), "--labels", str(folder / "labels.toml")]
    out = ["--out", str(folder / "run"), "--export", str(folder / "own.haptoflow"), "--minutes", "0.1"]
    assert cli.main(["train", *words, *out]) == 0
    return folder


def test_the_networks_are_those_that_it_began_with(grown: Path) -> None:
    shipped, file = read_model_file(SHIPPED), read_model_file(grown / "own.haptoflow")
    assert file.graphs == shipped.graphs and model_space(file) == model_space(shipped)
    for name, tensor in shipped.tensors.items():
        if name not in ("embedding", "pieces"):
            np.testing.assert_array_equal(file.tensors[name], tensor)
    _, _, model = load_trained(grown / "run")
    trained = model.state_dict()
    for name, weights in skeleton_weights(shipped).items():
        assert torch.equal(trained[name], weights), name


def test_the_run_is_exported_again_as_it_was(grown: Path, tmp_path: Path) -> None:
    words = ["--run", str(grown / "run"), "--store", str(grown / "store"), "--out", str(tmp_path / "again.haptoflow")]
    assert cli.main(["export", *words]) == 0
    assert (tmp_path / "again.haptoflow").read_bytes() == (grown / "own.haptoflow").read_bytes()


def test_a_label_of_a_known_name_is_replaced_and_a_new_one_is_added(grown: Path) -> None:
    shipped, file = read_model_file(SHIPPED), read_model_file(grown / "own.haptoflow")
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
    assert "CC0 1.0" in stated["licence"] and "MIT" in stated["licence"] and str(grown) not in json.dumps(file.header)


def test_ribs_are_turned_as_learning_turns_them(grown: Path) -> None:
    file = read_model_file(grown / "own.haptoflow")
    turned = file.header["provenance"]["turned_degrees"]
    assert list(turned) == ["rack"]
    even = read_own(grown / "recordings" / "rack.csv").even
    assert even is not None
    learnt = learn_material(SHIPPED, even, MaterialWords("rack"), seconds_limit=1.0)
    # The library looks at the whole recording, training at its own part.
    assert math.remainder(turned["rack"] - learnt.report["turn_degrees"], 180.0) == pytest.approx(0.0, abs=1.0)
    row = next(label["embedding_row"] for label in file.header["labels"] if label["name"] == "rack")
    assert file.tensors["embedding"][row, -4:] == pytest.approx([1.0 / 1.6, 0.0, 0.0, 0.0], abs=0.01)


def test_a_label_with_too_little_to_fit_level_and_tone_is_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    csv_one_axis(tmp_path / "recordings", "short", "felt", stroke(2.5, hertz=140, seed=7))
    (tmp_path / "labels.toml").write_text(LABEL.format("felt"), encoding="utf-8")
    words = ["--recordings", str(tmp_path / "recordings"), "--labels", str(tmp_path / "labels.toml"), "--minutes", "0.1"]
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
    found = verdict([_accuracy(level_db, gfc, lsd_db)], [_accuracy(0.5, 0.97, 1.5)])
    assert found.is_worse == is_worse
    assert found.words.startswith("not worth using" if is_worse else "worth using")
    assert "level 0.50 dB, GFC 0.970, LSD 1.50 dB" in found.words
