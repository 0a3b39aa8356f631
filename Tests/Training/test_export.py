"""From a trained run to a model file: header, seeds, exponents, graphs, golden vectors."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import onnx
import pytest
from paper_samples import field_config
from test_trainer import ALONE, _config
from training_fixtures import FakeRecording, FakeStore, make_store, travelled_mm

from haptoflow_paper.codec.small_codec import SmallCodec, SmallCodecShape
from haptoflow_paper.report.accuracy_time import annotate_model
from haptoflow_paper.runs.tier import build_seed_bank
from haptoflow_paper.runs.trainer import EvaluatedTrainer
from haptoflow_training.export.exponents import fit_exponents
from haptoflow_training.export.exporter import export_run
from haptoflow_training.export.label_info import LabelInfo
from haptoflow_training.export.model_file import ModelFile, read_model_file
from haptoflow_training.recordings.landing import Landing, LandingMode, RibWander, StickSlip
from haptoflow_training.training.batches import HeldOut
from haptoflow_training.training.recordings_source import Provenance, Source
from haptoflow_training.training.trainer import Trainer

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
    assert str(Path(__file__).parents[2]).encode() not in content
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
    import zlib

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
