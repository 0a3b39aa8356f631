"""What an imported file says of itself: tiers, range, level, labels, provenance; and the command's errors."""

from __future__ import annotations

import io
import json
import os
import pickle
import struct
import subprocess
import zipfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import torch

from haptoflow_paper.cli import main
from haptoflow_paper.codec.checkpoint_file import read_tensors
from haptoflow_paper.published.checkpoint import read_checkpoint
from haptoflow_paper.published.labels import EmbeddingRows, published_labels
from haptoflow_paper.published.level_measurement import RenderedLevels, _motions, band_rms
from haptoflow_paper.published.meta_file import ControlStatistics
from haptoflow_paper.published.published_file import PublishedFile, TrainedRange, tiers_of
from haptoflow_training.errors import InputError
from haptoflow_training.export.model_file import read_model_file
from published_samples import PUBLISHED, change_meta, change_safetensors, copied
from places import ENGINE, ROOT


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


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return copied("heun", tmp_path)


def _refused(folder: Path, words: str) -> None:
    with pytest.raises(InputError, match=words):
        read_checkpoint(folder)


def test_sizes_come_from_the_tensors() -> None:
    model = read_checkpoint(PUBLISHED / "euler").model
    assert model.sizes.channels == (8, 16) and model.sizes.classes == 5 and model.sizes.time == 64
    assert model.codec.encoder.model[0].conv["conv"].out_channels == 2
    assert model.quantiser.codebooks.shape == (16, 32, 128)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda meta: meta.update(model_type="vq"), r"meta\.json: key 'model_type' is 'vq'; expected \"flow_matching\""),
        (lambda meta: meta["dataset"].update(sample_rate=44100.0), r"dataset\.sample_rate is 44100\.0 .* audio variant"),
        (lambda meta: meta.update(waveform_length=4410), "waveform_length 4410.*audio variant"),
        (lambda meta: meta["config"]["data"].update(root="datasets/texture_dataset_audio_converted"), "config.data.root.*audio"),
        (lambda meta: meta["config"]["encodec"].update(model_name="48khz"), "config.encodec.model_name.*48khz"),
        (lambda meta: meta["encodec_io"].update(encodec_model_name="48khz"), "encodec_io.encodec_model_name.*48khz"),
        (lambda meta: meta.pop("control_stats"), "key 'control_stats' is missing"),
        (lambda meta: meta["control_stats"].pop("velocity_y"), "key 'control_stats.velocity_y' is missing"),
        (lambda meta: meta["control_stats"]["force"].update(std=0.0), "control_stats.force.std' is 0.0"),
        (lambda meta: meta["control_stats"]["force"].update(mean="much"), "control_stats.force.mean' is 'much'; expected a number"),
        (lambda meta: meta["control_stats"]["force"].update(min=2.0), "control_stats.force.*min <= mean <= max"),
        (lambda meta: meta["config"]["sampling"].update(solver="rk4"), "config.sampling.solver.*'rk4'; expected one of heun, euler"),
        (lambda meta: meta["config"]["sampling"].update(steps=2.5), "config.sampling.steps' is 2.5"),
        (lambda meta: meta["config"]["sampling"].update(guidance_scale=None), "guidance_scale' is None"),
        (lambda meta: meta["config"]["model"].update(use_prev_segment=False), "use_prev_segment' is False; expected true"),
        (lambda meta: meta["config"]["model"]["control_embedding"].update(use_sinusoidal=False), "use_sinusoidal"),
        (lambda meta: meta["config"]["model"]["prev_segment_encoder"].update(pos_embed_max_distance=8), "pos_embed_max_distance"),
        (lambda meta: meta["dataset"]["classes"].append("Glass"), "label_to_int"),
        (lambda meta: meta["dataset"]["label_to_int"].update(Granite=0), "label_to_int"),
    ],
)
def test_what_is_wrong_in_the_meta_is_named(folder: Path, change: Callable[[dict[str, Any]], Any], words: str) -> None:
    change_meta(folder, change)
    _refused(folder, words)


def test_a_number_of_classes_that_the_weights_do_not_have_is_named(folder: Path) -> None:
    def add(meta: dict[str, Any]) -> None:
        meta["dataset"]["classes"].append("Glass")
        meta["dataset"]["label_to_int"]["Glass"] = 5

    change_meta(folder, add)
    _refused(folder, "5 rows in label_embed.emb.weight; expected 6")


def test_a_meta_that_is_no_json_is_named(folder: Path) -> None:
    (folder / "meta.json").write_text("{", encoding="utf-8")
    _refused(folder, r"meta\.json: not valid JSON")


@pytest.mark.parametrize("name", ["meta.json", "model.safetensors", "encodec.th"])
def test_a_missing_file_is_named(folder: Path, name: str) -> None:
    (folder / name).unlink()
    _refused(folder, name.split(".")[1])


def test_two_files_of_weights_are_named(folder: Path) -> None:
    (folder / "other.safetensors").write_bytes(b"")
    _refused(folder, r"model\.safetensors, other\.safetensors; expected one file")


BIAS = "model.backbone.in_conv.bias"


def _set(key: str, value: Any) -> Callable[[dict[str, Any], bytearray], None]:
    return lambda header, data: header[BIAS].update({key: value})


def _not_a_number(header: dict[str, Any], data: bytearray) -> None:
    struct.pack_into("<f", data, header[BIAS]["data_offsets"][0], float("nan"))


def _overlapping(header: dict[str, Any], data: bytearray) -> None:
    begin, end = header[BIAS]["data_offsets"]
    header[BIAS]["data_offsets"] = [begin - 4, end - 4]


def _beyond(header: dict[str, Any], data: bytearray) -> None:
    del data[-4:]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (_set("dtype", "F16"), f"tensor '{BIAS}' has the dtype 'F16'; expected F32"),
        (_set("shape", [9]), f"tensor '{BIAS}' has 32 bytes; expected 36"),
        (_set("shape", [-8]), f"tensor '{BIAS}' has the shape"),
        (_set("shape", [2, 4]), rf"of another shape: {BIAS} \[2, 4\] instead of \[8\]"),
        (_set("data_offsets", [0]), f"tensor '{BIAS}' .* expected whole numbers"),
        (_overlapping, "overlaps|leaves a hole"),
        (_beyond, "cut off in tensor"),
        (_not_a_number, f"tensor '{BIAS}' holds a number that is not finite"),
        (lambda header, data: header.update({BIAS: 3}), f"tensor '{BIAS}' is 3; expected dtype"),
        (lambda header, data: data.extend(b"\0" * 8), "8 bytes after the last tensor"),
        (lambda header, data: header.update({"model.backbone.extra": header.pop(BIAS)}), f"missing: {BIAS}; unexpected: model.backbone.extra"),
        (lambda header, data: header.update({"other": header.pop("label_embed.emb.weight")}), "'label_embed.emb.weight' is missing"),
    ],
)
def test_what_is_wrong_in_the_weights_is_named(
    folder: Path, change: Callable[[dict[str, Any], bytearray], None], words: str
) -> None:
    change_safetensors(folder, change)
    _refused(folder, words)


@pytest.mark.parametrize("bytes_left", [0, 7, 8, 100, 20_000, 333_727])
def test_weights_that_are_cut_off_anywhere_are_refused(folder: Path, bytes_left: int) -> None:
    path = folder / "model.safetensors"
    path.write_bytes(path.read_bytes()[:bytes_left])
    _refused(folder, r"model\.safetensors: .*(cut off|not a \.safetensors|after the last|leaves a hole)")


class _Runs:
    """Leaves a trace if a reader runs the pickle."""

    def __init__(self, trace: Path) -> None:
        self.trace = trace

    def __reduce__(self) -> tuple[Any, ...]:
        return os.mkdir, (str(self.trace),)


@pytest.mark.parametrize("zipped", [True, False])
def test_a_pickle_that_names_another_function_is_refused_by_that_name_and_not_run(
    folder: Path, tmp_path: Path, zipped: bool
) -> None:
    state = {"best_state": {"encoder.model.0.conv.conv.bias": torch.zeros(2), "quantizer": _Runs(tmp_path / "trace")}}
    torch.save(state, folder / "encodec.th", _use_new_zipfile_serialization=zipped)
    _refused(folder, r"encodec\.th: .*names (posix|nt)\.mkdir")
    assert not (tmp_path / "trace").exists()


@pytest.mark.parametrize("zipped", [True, False])
def test_both_forms_of_a_state_dict_are_read_as_pytorch_reads_them(tmp_path: Path, zipped: bool) -> None:
    shared = torch.arange(12, dtype=torch.float32)
    state = {
        "turned": shared.reshape(3, 4).t(), "part": shared[2:5], "half": torch.ones(3, dtype=torch.float16),
        "count": torch.tensor(7), "empty": torch.zeros(0, 4), "parameter": torch.nn.Parameter(torch.ones(2)), "epoch": 3,
    }
    torch.save(state, tmp_path / "state.th", _use_new_zipfile_serialization=zipped)
    found, expected = read_tensors(tmp_path / "state.th"), torch.load(tmp_path / "state.th")
    assert found.keys() == expected.keys() and found["epoch"] == 3
    for name in found.keys() - {"epoch"}:
        assert found[name].dtype == expected[name].dtype and torch.equal(found[name], expected[name]), name


def test_a_tensor_that_claims_more_than_its_storage_is_refused(tmp_path: Path) -> None:
    torch.save({"a": torch.zeros(4)}, tmp_path / "state.th")
    with zipfile.ZipFile(tmp_path / "state.th") as archive:
        parts = {name: archive.read(name) for name in archive.namelist()}
    name = next(name for name in parts if name.endswith("data.pkl"))
    # The pickle's BININT1 4 K\x04 of the shape becomes 200.
    parts[name] = parts[name].replace(b"K\x04\x85", b"K\xc8\x85")
    with zipfile.ZipFile(tmp_path / "state.th", "w") as archive:
        for part, content in parts.items():
            archive.writestr(part, content)
    with pytest.raises(InputError, match=r"shape \[200\] ends outside its storage of 4 numbers"):
        read_tensors(tmp_path / "state.th")


@pytest.mark.parametrize("content", [b"", b"PK", b"\x80\x02.", pickle.dumps({"a": 1}), b"nothing of that kind"])
def test_a_file_that_is_no_state_dict_is_refused(folder: Path, content: bytes) -> None:
    (folder / "encodec.th").write_bytes(content)
    _refused(folder, r"encodec\.th: not a PyTorch checkpoint")


def _change_codec(folder: Path, change: Callable[[dict[str, Any]], Any]) -> None:
    state = read_tensors(folder / "encodec.th")
    change(state)
    torch.save(state, folder / "encodec.th")


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda state: state.update({"encoder.model.0.conv.conv.weight_v": torch.zeros(2, 2, 7)}), "takes 2 channels; expected 1.*48 kHz"),
        (lambda state: state.pop("encoder.model.0.conv.conv.weight_v"), "expected EnCodec's 24 kHz state dict"),
        (lambda state: state.pop("decoder.model.0.conv.conv.bias"), "missing: decoder.model.0.conv.conv.bias"),
        (lambda state: state.update({"decoder.model.99.bias": torch.zeros(1)}), "unexpected: decoder.model.99.bias"),
        (lambda state: state.update({"quantizer.other": torch.zeros(1)}), "unexpected: quantizer.other"),
        (lambda state: state.pop("quantizer.vq.layers.3._codebook.embed"), "codebooks .*numbered from 0"),
        (lambda state: state["quantizer.vq.layers.3._codebook.embed"].fill_(float("inf")), "not a finite number in codebook 3"),
        (lambda state: state["decoder.model.0.conv.conv.bias"].fill_(float("nan")), "not a finite number in decoder.model.0"),
        (lambda state: state.update({"quantizer.vq.layers.3._codebook.embed": torch.zeros(32, 64)}), r"codebook 3 has the shape \[32, 64\]"),
    ],
)
def test_what_is_wrong_in_the_codec_is_named(folder: Path, change: Callable[[dict[str, Any]], Any], words: str) -> None:
    _change_codec(folder, change)
    _refused(folder, rf"encodec\.th: .*{words}")


def test_a_state_dict_under_best_state_is_read(folder: Path) -> None:
    state = read_tensors(folder / "encodec.th")
    buffer = io.BytesIO()
    torch.save({"best_state": state, "epoch": 5}, buffer)
    (folder / "encodec.th").write_bytes(buffer.getvalue())
    assert read_checkpoint(folder).model.sizes.latent == 128
