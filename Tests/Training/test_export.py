"""From a trained run to a model file: header, seeds, exponents, graphs, golden vectors."""

from __future__ import annotations

import json
import struct
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import make_skeleton_model
import numpy as np
import onnx
import pytest
import torch
from torch import nn

from haptoflow_paper.codec.small_codec import SmallCodec, SmallCodecShape
from haptoflow_paper.report.accuracy_time import annotate_model
from haptoflow_paper.rows.row_plan import PlannedRow
from haptoflow_paper.rows.row_runner import _sizes
from haptoflow_paper.runs.tier import build_seed_bank
from haptoflow_paper.runs.trainer import EvaluatedTrainer
from haptoflow_training.errors import InputError
from haptoflow_training.export.exponents import fit_exponents
from haptoflow_training.export.exporter import export_run
from haptoflow_training.recordings.landing import LabelInfo, Landing, LandingMode, RibWander, StickSlip
from haptoflow_training.export.model_file import (
    VERSION, ModelFile, encode_model_file, model_space, read_model_file, with_label, write_model_file
)
from haptoflow_training.export.trained_tier import export_graph
from haptoflow_training.export.skeleton_tensors import condition_tensors, skeleton_tensors, skeleton_weights
from haptoflow_training.models.level_model import LevelModel
from haptoflow_training.models.skeleton import Skeleton
from haptoflow_training.training.batches import HeldOut
from haptoflow_training.training.recordings_source import Provenance, Source
from haptoflow_training.training.trainer import Trainer
from paper_samples import field_config
from test_trainer import ALONE, _config
from training_fixtures import FakeRecording, FakeStore, make_store, travelled_mm
from places import DEFAULT, ROOT

LANDING = Landing((LandingMode(180.0, 75.5, 170.0), LandingMode(640.0, 700.0, 40.0)), 0.25)
INFOS = [
    LabelInfo(
        "tone", "metal", 900.0, 0.3, 0.002, landing=LANDING, stick_slip=StickSlip(0.0011, 0.25, 0.004),
        rib_wander=(RibWander(0.12, 7.0 * 0.0017),),
    ),
    LabelInfo("noise", "stone", 1500.0, 0.6),
]  # fmt: skip
PROVENANCE = Provenance("trained on nothing real", "a test", "MIT")


@pytest.fixture(scope="module")
def exported(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, ModelFile, FakeStore]:
    folder = tmp_path_factory.mktemp("export")
    store = make_store(seconds=6.0, recordings_per_split=4)
    Trainer(_config(), store, folder / "run", ALONE).run()
    export_run(folder / "run", Source(store, INFOS, PROVENANCE), folder / "m.haptoflow", folder / "parity.json")
    return folder, read_model_file(folder / "m.haptoflow"), store


def test_the_header_says_origin_labels_range_and_tier(exported: tuple[Path, ModelFile, FakeStore]) -> None:
    header = exported[1].header
    assert header["provenance"]["statement"] == "trained on nothing real"
    assert header["provenance"]["configuration"]["optimiser"]["steps"] == 30
    assert [label["name"] for label in header["labels"]] == ["tone", "noise"]
    assert header["labels"][0]["periodic"] and not header["labels"][1]["periodic"]
    assert 0.55 < header["range"]["speed_mps"][1] <= 0.61
    assert header["tiers"][0]["kind"] == "skeleton"
    assert "skeleton" in header and "seed_bank" not in header
    assert header["measurements"]["steps"] == 60


def test_no_path_of_the_training_machine_is_in_the_file(exported: tuple[Path, ModelFile, FakeStore]) -> None:
    content = (exported[0] / "m.haptoflow").read_bytes()
    assert str(ROOT).encode() not in content
    assert str(exported[0]).encode() not in content


def test_seeds_are_recordings_of_unit_level_with_their_conditions(exported: tuple[Path, ModelFile, FakeStore]) -> None:
    store = exported[2]
    bank = build_seed_bank(store, np.zeros((2, 4), np.float32), seed=1, held_out=HeldOut())
    assert len(bank.entries) == len(bank.waves) >= 10
    np.testing.assert_allclose(np.sqrt(np.square(bank.waves).mean(axis=1)), 1.0, rtol=1e-3)
    tones = [wave for wave, entry in zip(bank.waves, bank.entries, strict=True) if entry["label"] == "tone"]
    spectra = np.abs(np.fft.rfft(tones, axis=1))
    assert (spectra.argmax(axis=1) == 30).all(), "150 Hz is bin 30 of 400 samples at 2 kHz"


def test_exponents_are_those_of_the_recordings() -> None:
    store = make_store(seconds=8.0, recordings_per_split=8)
    tone = fit_exponents(store, 0, periodic=True, seed=1, held_out=HeldOut())
    assert tone.level_speed == pytest.approx(1.0, abs=0.08)
    assert tone.level_force == pytest.approx(0.3, abs=0.08)
    assert tone.frequency == 1.0
    noise = fit_exponents(store, 1, periodic=False, seed=1, held_out=HeldOut())
    assert noise.level_speed == pytest.approx(0.5, abs=0.08)
    assert noise.frequency == pytest.approx(0.0, abs=0.05)


def test_a_surface_that_levels_off_at_high_speeds_is_extrapolated_with_the_slope_of_its_fastest_octave() -> None:
    generator = np.random.default_rng(3)
    speeds = np.geomspace(0.02, 1.6, 64)
    samples = 2400
    motion = np.zeros((len(speeds) * samples, 3), dtype=np.float32)
    motion[:, 0], motion[:, 2] = np.repeat(speeds, samples), np.tile(np.repeat([0.5, 2.0], samples // 2), len(speeds))
    level = np.minimum(motion[:, 0], 0.6) * motion[:, 2] ** 0.4
    wave = (level * generator.standard_normal(len(motion))).astype(np.float32)
    recordings = [FakeRecording(0, "hand", "train", start, samples) for start in range(0, len(motion), samples)]
    store = FakeStore(wave, motion, travelled_mm(motion), 1.0, ["coarse"], recordings)
    fitted = fit_exponents(store, 0, periodic=False, seed=1, held_out=HeldOut())
    assert fitted.level_speed == pytest.approx(0.0, abs=0.05) and fitted.level_force == pytest.approx(0.4, abs=0.05)


def test_golden_vectors_name_the_file_they_belong_to(exported: tuple[Path, ModelFile, FakeStore]) -> None:
    golden = json.loads((exported[0] / "parity.json").read_text(encoding="utf-8"))
    assert golden["model_crc32"] == f"{zlib.crc32((exported[0] / 'm.haptoflow').read_bytes()):08x}"
    assert len(golden["cases"]) == 10
    for case in golden["cases"]:
        assert len(case["segment"]) == len(case["noise"]) == len(case["previous"]) == 200
        assert np.abs(case["segment"]).max() > 0.0


def test_measured_figures_go_into_the_header_and_the_golden_vectors_follow(
    exported: tuple[Path, ModelFile, FakeStore], tmp_path: Path
) -> None:
    for name in ("m.haptoflow", "parity.json"):
        (tmp_path / name).write_bytes((exported[0] / name).read_bytes())
    row = {"level_error_db": -0.2, "gfc_recording": 0.99, "f0_error_percent": None,
           "ms_per_segment": {"p50": 0.2, "p99": 0.3}, "ms_paced": {"p50": 0.4, "p99": 0.6}}  # fmt: skip
    checksum = annotate_model(tmp_path / "m.haptoflow", "a machine", {"standard": row}, tmp_path / "parity.json")
    tier = read_model_file(tmp_path / "m.haptoflow").header["tiers"][0]
    assert tier["accuracy"] == {"level_error_db": -0.2, "gfc_recording": 0.99}
    assert tier["cost"] == {"machine": "a machine", "ms_p50": 0.2, "ms_live_p50": 0.4, "ms_live_p99": 0.6}
    golden = json.loads((tmp_path / "parity.json").read_text(encoding="utf-8"))
    assert int(golden["model_crc32"], 16) == checksum
    assert golden["cases"] == json.loads((exported[0] / "parity.json").read_text(encoding="utf-8"))["cases"]


def test_a_run_in_latents_is_exported_with_its_encoder_and_decoder(tmp_path: Path) -> None:
    SmallCodec(SmallCodecShape()).save(tmp_path / "codec.pt")
    store = make_store(seconds=6.0, recordings_per_split=4)
    codec = {"kind": "small-codec", "checkpoint": str(tmp_path / "codec.pt")}
    config = field_config(steps=4, model={"patch": 5, "representation": codec})
    EvaluatedTrainer(config, store, tmp_path / "run", ALONE).run()
    export_run(tmp_path / "run", Source(store, INFOS, PROVENANCE), tmp_path / "m.haptoflow")
    file = read_model_file(tmp_path / "m.haptoflow")
    tier = file.header["tiers"][0]
    assert tier["representation"] == "latent" and tier["kind"] == "flow" and "skeleton" not in file.header
    assert len(file.header["seed_bank"]["entries"]) == len(file.tensors["seeds"]) and set(file.graphs) >= {"level"}
    encoder, decoder = (onnx.load_from_string(file.graphs[tier[name]]) for name in ("encoder", "decoder"))
    latent = [size.dim_value for size in encoder.graph.output[0].type.tensor_type.shape.dim[1:]]
    assert latent == tier["latent_shape"]
    assert [value.name for value in decoder.graph.input] == ["latent"]
    field = onnx.load_from_string(file.graphs[tier["field"]])
    assert [size.dim_value for size in field.graph.input[0].type.tensor_type.shape.dim[1:]] == latent


def test_a_rival_becomes_a_direct_tier_with_the_inputs_that_it_reads(tmp_path: Path) -> None:
    store = make_store(seconds=6.0, recordings_per_split=4)
    config = field_config(steps=4, model={"architecture": "spsi"})
    EvaluatedTrainer(config, store, tmp_path / "run", ALONE).run()
    export_run(tmp_path / "run", Source(store, INFOS, PROVENANCE), tmp_path / "m.haptoflow", tmp_path / "parity.json")
    file = read_model_file(tmp_path / "m.haptoflow")
    assert file.header["tiers"][0]["kind"] == "direct"
    field = onnx.load_from_string(file.graphs["standard.field"])
    assert [value.name for value in field.graph.input] == ["noisy", "embedding", "motion"]
    cases = json.loads((tmp_path / "parity.json").read_text(encoding="utf-8"))["cases"]
    assert {case["solver"] for case in cases} == {"euler"}


def test_the_default_exporter_of_pytorch_2_9_is_not_used(monkeypatch: pytest.MonkeyPatch) -> None:
    traced: Callable[..., Any] = torch.onnx.export
    told: list[bool] = []

    def as_of_2_9(model: nn.Module, args: Any, f: Any, *, dynamo: bool = True, **options: Any) -> None:
        told.append(dynamo)
        if dynamo:
            raise ModuleNotFoundError("No module named 'onnxscript'")
        traced(model, args, f, **options)

    monkeypatch.setattr(torch.onnx, "export", as_of_2_9)
    graph = export_graph(nn.Linear(4, 2), {"given": torch.zeros(2, 4)}, "made")
    assert told == [False]
    assert len(graph) > 100


def test_an_older_pytorch_is_given_no_argument_that_it_does_not_know(monkeypatch: pytest.MonkeyPatch) -> None:
    traced: Callable[..., Any] = torch.onnx.export
    names = ("opset_version", "input_names", "output_names", "dynamic_axes", "do_constant_folding")

    def as_of_1_13(
        model: nn.Module, args: Any, f: Any, opset_version: int, input_names: Any, output_names: Any,
        dynamic_axes: Any, do_constant_folding: bool,
    ) -> None:  # fmt: skip
        values = (opset_version, input_names, output_names, dynamic_axes, do_constant_folding)
        traced(model, args, f, **dict(zip(names, values, strict=True)))

    monkeypatch.setattr(torch.onnx, "export", as_of_1_13)
    assert export_graph(nn.Linear(4, 2), {"given": torch.zeros(2, 4)}, "made")


GOLDEN = ROOT / "Tests" / "Golden"
MODEL = ModelFile(
    header={"name": "tést", "labels": [{"name": "wood"}]},
    tensors={"embedding": np.arange(128, dtype=np.float32).reshape(2, 64), "seeds": np.ones((1, 400), np.float32)},
    graphs={"field": b"graph bytes", "level": b"x" * 1000},
)


def _of_version(version: int, content: bytes) -> bytes:
    return content[:8] + struct.pack("<I", version) + content[12:]


def test_what_is_written_with_lengths_and_checksums_is_read_back(tmp_path: Path) -> None:
    path = tmp_path / "model.haptoflow"
    checksum = write_model_file(path, MODEL)
    content = path.read_bytes()
    assert checksum == zlib.crc32(content)
    magic, version, header_length, total, header_crc, own_crc = struct.unpack_from("<8sIIQII", content)
    assert (magic, version, total) == (b"HAPTFLOW", VERSION, len(content))
    assert zlib.crc32(content[32 : 32 + header_length]) == header_crc
    assert zlib.crc32(content[:28]) == own_crc
    read = read_model_file(path)
    assert read.header == MODEL.header
    assert read.graphs == MODEL.graphs
    np.testing.assert_array_equal(read.tensors["embedding"], MODEL.tensors["embedding"])


def test_header_and_blobs_end_and_start_on_multiples_of_64(tmp_path: Path) -> None:
    for name_length in range(1, 140):
        model = ModelFile({"name": "n" * name_length}, MODEL.tensors, MODEL.graphs)
        content = encode_model_file(model)
        (header_length,) = struct.unpack_from("<I", content, 12)
        assert (32 + header_length) % 64 == 0
        path = tmp_path / "m.haptoflow"
        path.write_bytes(content)
        assert read_model_file(path).header["name"] == "n" * name_length


@pytest.mark.parametrize(
    ("damage", "complaint"),
    [
        (lambda content: content[:-1], "truncated"),
        (lambda content: b"NOTAMODL" + content[8:], "not a .haptoflow file"),
        (lambda content: _of_version(VERSION + 1, content), f"version {VERSION + 1}, expected {VERSION}: update"),
        (lambda content: _of_version(VERSION - 1, content), f"{VERSION - 1}, expected {VERSION}: .*training export"),
        (lambda content: content[:40] + b"#" + content[41:], "header"),
        (lambda content: content[:-3] + b"#" + content[-2:], "'level'"),
    ],
    ids=["truncated", "other magic", "newer", "older", "header", "blob"],
)
def test_damage_is_named(tmp_path: Path, damage: object, complaint: str) -> None:
    path = tmp_path / "broken.haptoflow"
    path.write_bytes(damage(encode_model_file(MODEL)))  # type: ignore[operator]
    with pytest.raises(InputError, match=complaint):
        read_model_file(path)


def test_a_tensor_that_is_not_finite_is_refused() -> None:
    with pytest.raises(ValueError, match="'embedding'"):
        encode_model_file(ModelFile({}, {"embedding": np.array([np.nan], np.float32)}, {}))


def test_the_space_follows_the_networks_and_neither_labels_nor_embedding() -> None:
    spaces = json.loads((GOLDEN / "material" / "expected.json").read_text(encoding="utf-8"))["spaces"]
    model = read_model_file(GOLDEN / "model" / "tiny.haptoflow")
    assert model_space(model) == spaces["tiny"]
    assert model_space(read_model_file(DEFAULT)) == spaces["default"]
    model.header["labels"].pop()
    model.tensors["embedding"] = model.tensors["embedding"] * 2.0
    assert model_space(model) == spaces["tiny"]
    name = model.header["tiers"][1]["field"]
    model.graphs[name] = model.graphs[name] + b"\0"
    assert model_space(model) != spaces["tiny"]


def _part(weights: dict[str, torch.Tensor], name: str, module: nn.Module) -> nn.Module:
    module.load_state_dict(
        {key.removeprefix(name): value for key, value in weights.items() if key.startswith(name)}, strict=True
    )
    return module


def test_level_and_skeleton_are_written_again_as_they_were_read() -> None:
    file = read_model_file(DEFAULT)
    weights = skeleton_weights(file)
    # Of two perceptrons or one, a file knows one.
    skeleton = _part(weights, "skeleton.", Skeleton((file.header["skeleton"]["hidden"],)))
    level = _part(weights, "level.", LevelModel())
    assert isinstance(level, LevelModel) and isinstance(skeleton, Skeleton)
    for name, tensor in skeleton_tensors(level, skeleton).items():
        np.testing.assert_allclose(tensor, file.tensors[name], rtol=1e-6, atol=0.0)


@pytest.fixture(scope="module")
def skeleton_file() -> ModelFile:
    return read_model_file(GOLDEN / "model" / "skeleton.haptoflow")


def test_the_file_is_that_of_the_model_which_made_the_golden_vectors(skeleton_file: ModelFile) -> None:
    sketch, refined = make_skeleton_model.build()
    assert refined.refiner is not None
    written = {
        "embedding": sketch.embedding.weight.numpy(), "pieces": sketch.embedding.offsets.numpy(),
        **skeleton_tensors(sketch.level, sketch.skeleton), **condition_tensors("standard", refined.refiner),
    }  # fmt: skip
    assert written.keys() == skeleton_file.tensors.keys()
    for name, values in written.items():
        np.testing.assert_allclose(values, skeleton_file.tensors[name], rtol=1e-6, atol=1e-7, err_msg=name)


def test_the_model_makes_the_golden_vectors_that_native_code_must_reproduce() -> None:
    models = make_skeleton_model.exact(*make_skeleton_model.build())
    made = [make_skeleton_model.golden_case(*models, number) for number in range(len(make_skeleton_model.CASES))]
    stream = make_skeleton_model.golden_stream(models[0])
    checksum = zlib.crc32((GOLDEN / "model" / "skeleton.haptoflow").read_bytes())
    for name, wanted in (("parity", {"cases": made}), ("stream", stream)):
        golden = json.loads((GOLDEN / "model" / f"skeleton.{name}.json").read_text(encoding="utf-8"))
        assert golden.pop("model_crc32") == f"{checksum:08x}"
        assert golden.keys() == wanted.keys()
        for key, values in wanted.items():
            for one, other in zip(_numbers(values), _numbers(golden[key]), strict=True):
                np.testing.assert_allclose(one, other, rtol=1e-6, atol=1e-6, err_msg=f"{name}: {key}")


def _numbers(values: Any) -> list[Any]:
    """A list of numbers, or those of a list of tables one after the other."""
    return [number for table in values for number in table.values()] if isinstance(values[0], dict) else [values]


def test_a_further_label_of_a_model_with_specimens_has_the_offsets_of_the_label_itself(skeleton_file: ModelFile) -> None:
    material = {"name": "learnt", "space": model_space(skeleton_file), "category": "own", "embedding": [0.1] * 64}
    larger = with_label(skeleton_file, material)
    assert larger.tensors["embedding"].shape == (3, 64)
    assert larger.tensors["pieces"].shape == (3, make_skeleton_model.SPECIMENS, 60)
    assert not larger.tensors["pieces"][2].any() and larger.tensors["pieces"].dtype == np.float32
    np.testing.assert_array_equal(larger.tensors["pieces"][:2], skeleton_file.tensors["pieces"])
    assert "seeds" not in larger.tensors and "seed_bank" not in larger.header


def test_the_bytes_of_a_tier_are_its_graph_and_all_tensors_that_native_code_computes_with(skeleton_file: ModelFile) -> None:
    blobs = [{"name": name, "bytes": values.nbytes} for name, values in skeleton_file.tensors.items()]
    blobs += [{"name": name, "bytes": len(graph)} for name, graph in skeleton_file.graphs.items()]

    class Generator:
        header = {**skeleton_file.header, "blobs": blobs}

    def size(tier: str) -> int:
        row = PlannedRow(name=tier, family="HaptoFlow", block="ours", model="m.haptoflow", tier=tier)
        return _sizes(Generator(), row)["bytes"]  # type: ignore[arg-type]

    def weights(*beginnings: str) -> int:
        return sum(values.nbytes for name, values in skeleton_file.tensors.items() if name.startswith(beginnings))

    assert size("sketch") == weights("skeleton.", "level.")
    assert size("standard") - size("sketch") == weights("standard.condition.") + len(skeleton_file.graphs["standard.field"])
