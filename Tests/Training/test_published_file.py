"""What an imported file says of itself: tiers, range, level, labels, provenance; and the command's errors."""

from __future__ import annotations

import json
import subprocess
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import torch

from haptoflow_paper.cli import main
from haptoflow_paper.published.checkpoint import read_checkpoint
from haptoflow_paper.published.labels import EmbeddingRows, published_labels
from haptoflow_paper.published.level_measurement import RenderedLevels, band_rms, _motions
from haptoflow_paper.published.meta_file import ControlStatistics
from haptoflow_paper.published.published_file import PublishedFile, TrainedRange, tiers_of
from haptoflow_training.export.model_file import read_model_file
from published_samples import PUBLISHED, copied

ROOT = Path(__file__).parents[2]
ENGINE = ROOT / "build" / "native" / "haptoflow"


@pytest.fixture(scope="module")
def assumed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("assumed") / "heun.haptoflow"
    assert main(["import-published", str(PUBLISHED / "heun"), "-o", str(out)]) == 0
    return out


def _inspected(path: Path) -> str:
    return subprocess.run([str(ENGINE), "inspect", str(path)], capture_output=True, text=True, check=True).stdout


def test_an_assumed_level_is_said_where_inspect_shows_it(assumed: Path) -> None:
    assert "level assumed" in _inspected(assumed)
    header = read_model_file(assumed).header
    assert header["normalisation"]["assumed"] is True
    assert "level assumed" in header["provenance"]["statement"]


def test_an_assumed_level_makes_the_median_of_the_labels_the_measured_one(assumed: Path) -> None:
    file = read_model_file(assumed)
    unit = file.header["normalisation"]["peak_mps2"]
    seeds = file.header["seed_bank"]["entries"]
    levels: dict[str, list[float]] = {}
    for seed, wave in zip(seeds, file.tensors["seeds"], strict=True):
        if abs(np.hypot(*seed["velocity_mps"]) - 0.04) < 1e-4:
            levels.setdefault(seed["label"], []).append(float(band_rms(unit * seed["gain"] * wave[None])[0]))
    of_classes = [np.sqrt(np.mean(np.square(levels[label["name"]]))) for label in file.header["labels"][:5]]
    # Seeds are the second half of what the level was measured on.
    assert abs(20 * np.log10(np.median(of_classes) / 0.57)) < 1.5


def test_every_part_s_licence_and_origin_stand_in_the_file(assumed: Path) -> None:
    text = _inspected(assumed)
    for words in ("Apache-2.0", "tamago117/HaptoFlow", "CC BY 4.0", "EnCodec"):
        assert words in text


def test_the_commit_of_a_download_stands_in_the_file(tmp_path: Path) -> None:
    folder = copied("heun", tmp_path)
    origin = "hf://tamago117/HaptoFlow/haptoflow_accel@0123456789abcdef0123456789abcdef01234567"
    (folder / "origin.json").write_text(json.dumps({"origin": origin}), encoding="utf-8")
    file = PublishedFile(read_checkpoint(folder))
    file.write_draft(tmp_path / "draft.haptoflow")
    assert f"imported from the published weights {origin};" in _inspected(tmp_path / "draft.haptoflow")


def test_a_stated_peak_is_the_level(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    info = tmp_path / "dataset_info.json"
    info.write_text(json.dumps({"preprocessing": {"global_peak_value": 1.25}}), encoding="utf-8")
    out = tmp_path / "out.haptoflow"
    assert main(["import-published", str(PUBLISHED / "euler"), "--dataset-info", str(info), "-o", str(out)]) == 0
    header = read_model_file(out).header
    assert header["normalisation"]["peak_mps2"] == pytest.approx(1.25 * 9.80665)
    assert header["normalisation"]["assumed"] is False
    assert "level stated: a peak of 1.25 g" in header["provenance"]["statement"]
    assert "Apache-2.0" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("{}", "key 'preprocessing.global_peak_value' is None"),
        ('{"preprocessing": {"global_peak_value": null}}', "global_peak_value' is None"),
        ('{"preprocessing": {"global_peak_value": -1}}', "global_peak_value is -1; expected a peak in g"),
        ("[", "not valid JSON"),
    ],
)
def test_a_dataset_info_without_a_peak_is_refused(
    tmp_path: Path, content: str, words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    info = tmp_path / "dataset_info.json"
    info.write_text(content, encoding="utf-8")
    out = tmp_path / "out.haptoflow"
    assert main(["import-published", str(PUBLISHED / "euler"), "--dataset-info", str(info), "-o", str(out)]) == 3
    assert words in capsys.readouterr().err
    assert not out.exists()


def _meta(**changes: Any) -> Any:
    return replace(read_checkpoint(PUBLISHED / "heun").model.meta, **changes)


def test_the_best_tier_is_as_trained_and_the_last_and_fewer_steps_and_no_guidance_come_before() -> None:
    tiers = tiers_of(_meta(steps=8, guidance=3.0))
    assert [(tier.name, tier.steps, tier.guidance) for tier in tiers] == [
        ("published-2-unguided", 2, 1.0), ("published-2", 2, 3.0), ("published-4", 4, 3.0), ("published", 8, 3.0),
    ]
    assert [tier.name for tier in tiers_of(_meta(steps=2, guidance=1.0))] == ["published-1", "published"]
    assert [tier.name for tier in tiers_of(_meta(steps=1, guidance=1.0))] == ["published"]
    assert tiers_of(_meta(steps=50))[-1].steps == 16


def test_the_range_is_that_of_strokes_at_20_40_60_mm_s_and_two_forces() -> None:
    direction, speed, force = np.meshgrid(np.arange(8) * np.pi / 4, [0.02, 0.04, 0.06], [0.5, 1.0])
    axes = {"velocity_x": speed * np.cos(direction), "velocity_y": speed * np.sin(direction), "force": force}
    controls = {
        name: ControlStatistics(float(values.mean()), float(values.std()), float(values.min()), float(values.max()))
        for name, values in axes.items()
    }
    found = TrainedRange.of(_meta(controls=controls))
    assert found.speed_mps == pytest.approx((0.02, 0.06), abs=1e-4)
    assert found.force_newtons == pytest.approx((0.5, 1.0), abs=1e-4)


def _power_law(speed_exponent: float, force_exponent: float, level: float) -> RenderedLevels:
    motions = _motions((0.02, 0.06), (0.5, 1.0))
    speed, force = np.hypot(motions[:, 0], motions[:, 1]), motions[:, 2]
    rms = level * (speed / 0.04) ** speed_exponent * (force / 0.75) ** force_exponent
    return RenderedLevels(motions, rms[None], 100.0 * (speed[None] / 0.04) ** 0.15, np.zeros((1, len(motions), 400), np.float32))


def test_the_exponents_are_those_of_the_rendered_levels() -> None:
    found = _power_law(0.9, 0.25, 0.3).exponents(0)
    assert found.level_speed == pytest.approx(0.9, abs=1e-3)
    assert found.level_force == pytest.approx(0.25, abs=1e-3)
    assert found.frequency == pytest.approx(0.15, abs=1e-3)
    assert _power_law(0.9, 0.25, 0.3).reference == pytest.approx(0.3)


def test_every_class_has_a_category_of_the_data_set_and_scenes_find_it_by_its_short_name() -> None:
    classes = ("Cotton", "Cotton broadcloth", "Alumina", "Aluminum", "Wool felt", "Wool", "Paper phenol", "Cow leather", "Nyatoh", "Keyaki", "Steel")
    labels = {label.name: label for label in published_labels(classes)}
    assert {name: labels[name].category for name in map(str.lower, classes)} == {
        "cotton": "biodegradable", "cotton broadcloth": "cloth", "alumina": "ceramic", "aluminum": "metal",
        "wool felt": "biodegradable", "wool": "cloth", "paper phenol": "polymer", "cow leather": "biodegradable",
        "nyatoh": "wood", "keyaki": "wood", "steel": "metal",
    }
    assert labels["wood"].row == 8 and labels["metal"].row == 10 and labels["leather"].row == 7
    assert labels["cotton"].row == 0, "a class keeps its own name"
    assert "rubber" not in labels and "stone" not in labels


def test_rows_that_need_all_64_numbers_are_found_again_and_make_no_ribs() -> None:
    rows = torch.randn(118, 64, generator=torch.Generator().manual_seed(1))
    embedding = EmbeddingRows(rows)
    found = embedding(torch.from_numpy(embedding.embeddings))
    assert (found - rows).abs().max() < 1e-4
    assert np.abs(embedding.embeddings[:, 60:]).max() < 1e-4, "cycles per millimetre"
    assert np.square(embedding.embeddings[:, 60:] / 1e-6).sum() < 0.02 * rows.square().sum()


def test_the_golden_model_of_the_other_languages_is_what_the_importer_writes(assumed: Path) -> None:
    """Unity's stand-in and the page play it, where nothing imports. To renew it: haptoflow-paper import-published
    Tests/Golden/published/heun -o Tests/Golden/model/published.haptoflow"""
    golden, made = (read_model_file(path) for path in (ROOT / "Tests/Golden/model/published.haptoflow", assumed))
    for key in ("name", "description", "range", "tiers", "default_tier", "provenance"):
        assert golden.header[key] == made.header[key], key
    assert [label["name"] for label in golden.header["labels"]] == [label["name"] for label in made.header["labels"]]
    peak = pytest.approx(made.header["normalisation"]["peak_mps2"], rel=1e-3)
    assert golden.header["normalisation"] == {**made.header["normalisation"], "peak_mps2": peak}
    assert golden.graphs.keys() == made.graphs.keys()
    np.testing.assert_array_equal(golden.tensors["embedding"], made.tensors["embedding"])
    np.testing.assert_allclose(golden.tensors["seeds"], made.tensors["seeds"], atol=1e-3)
