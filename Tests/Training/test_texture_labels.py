from __future__ import annotations

from pathlib import Path

import pytest
from parquet_samples import HUB

from haptoflow_training.cli import main
from haptoflow_training.errors import InputError
from haptoflow_training.recordings.labels import LabelDefinition, LabelMap, load_labels
from haptoflow_training.recordings.texture_labels import labels_of_textures

LISTED = {0: "Nyatoh", 1: "Steel", 38: "Granite", 49: "HDPE", 103: "Corduroy", 104: "Cotton broadcloth"}


def test_chosen_textures_become_labels_known_or_of_their_own_name(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "labels.toml"
    assert main(["labels", str(HUB), "--textures", "49,0,38", "--out", str(out)]) == 0
    assert capsys.readouterr().out == "49\thdpe\n0\twood\n38\tstone\n"
    hdpe, wood, stone = load_labels(out).definitions
    assert (hdpe.category, hdpe.textures, hdpe.stiffness_newtons_per_metre) == ("polymer", (49,), 900.0)
    known = {definition.name: definition for definition in load_labels().definitions}
    assert wood == known["wood"] and stone == known["stone"]


def test_without_a_choice_every_known_label_is_there_by_its_id() -> None:
    labels = labels_of_textures(load_labels(), LISTED, ())
    assert sorted(labels.names) == sorted(load_labels().names)
    assert {definition.name: definition.textures for definition in labels.definitions}["cotton"] == (104,)


def test_a_label_whose_texture_is_not_listed_is_named() -> None:
    with pytest.raises(InputError, match=r"texture_list\.xlsx lists no texture of the labels .*corduroy.*--textures"):
        labels_of_textures(load_labels(), {}, ())


def test_an_id_outside_the_data_set_is_refused(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    with pytest.raises(InputError, match="--textures 118: .*no such texture; expected ids from 0 to 117"):
        labels_of_textures(load_labels(), LISTED, (0, 118))
    with pytest.raises(SystemExit):
        main(["labels", str(HUB), "--textures", "oak", "--out", str(tmp_path / "l.toml")])
    assert "'oak'; expected ids with commas between them" in capsys.readouterr().err


def test_a_texture_that_is_called_like_another_label_is_told_apart_by_its_id() -> None:
    known = LabelMap((LabelDefinition("steel", "wood", (66,), 1.0, 0.5),))
    assert labels_of_textures(known, LISTED, (1, 66)).names == ["steel 1", "steel"]
