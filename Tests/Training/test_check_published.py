"""Imports of the published weights: our modules and the engine compute what the authors' code does (golden arrays of
their own), and every line of check-published's report passes, fails and does not apply where it should."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import numpy as np
import pytest
import torch
from scipy.io import wavfile

from haptoflow_benchmark.engine_library import EngineLibrary, default_engine
from haptoflow_benchmark.engine_render import render_motion
from haptoflow_paper.cli import main
from haptoflow_paper.commands import check_published
from haptoflow_paper.published import check_points
from haptoflow_paper.published import check_parity as reference_module
from haptoflow_paper.published.check_lines import FAIL, NOT_APPLICABLE, PASS, Line
from haptoflow_paper.published.check_parity import parity_lines
from haptoflow_paper.published.check_points import BUDGET_MS, Measured, Point, points_of, time_lines
from haptoflow_paper.published.check_signals import LabelWaves, signal_lines
from haptoflow_paper.published.checkpoint import read_checkpoint
from haptoflow_paper.published.level_measurement import band_rms
from haptoflow_paper.published.published_file import STANDARD_GRAVITY_MPS2, PublishedFile
from haptoflow_paper.published.published_model import PublishedModel
from haptoflow_paper.rows.engine_generator import EngineGenerator
from haptoflow_paper.rows.timing import Milliseconds
from haptoflow_training.export.model_file import read_model_file
from haptoflow_training.model_stamp import SHIPPED_MODEL
from published_samples import (
    PUBLISHED, SOLVERS, GoldenChain, assert_within_1e_4_of_its_rms, change_safetensors, copied,
    write_checkpoint_of_published_sizes
)
from places import ENGINE, ROOT

PEAK_G = 1.5
UNIT_MPS2 = PEAK_G * STANDARD_GRAVITY_MPS2


@pytest.fixture(scope="module", autouse=True)
def one_block() -> Iterator[None]:
    """Times of one short block of each pace: their figures are no test's."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(check_points, "_BLOCKS", 1)
        patch.setattr(check_published, "_LEAST_RUNS", 2)
        yield


@pytest.fixture(scope="module")
def imported(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    folder = tmp_path_factory.mktemp("imported")
    for solver in SOLVERS:
        arguments = ["import-published", str(PUBLISHED / solver), "--peak-g", str(PEAK_G), "-o"]
        assert main([*arguments, str(folder / f"{solver}.haptoflow")]) == 0
    return {solver: folder / f"{solver}.haptoflow" for solver in SOLVERS}


def _verdicts(lines: list[Line]) -> dict[str, str]:
    assert all(line.remedy and line.measured and line.expected for line in lines), "each says what to do"
    return {line.name: line.verdict for line in lines}


def _parity(engine: EngineLibrary, path: Path, folder: Path | None) -> tuple[list[Line], str]:
    return parity_lines(read_model_file(path), path, folder, None, engine, ROOT)


@pytest.mark.parametrize("solver", SOLVERS)
def test_three_segments_that_follow_each_other_are_the_golden_ones(solver: str) -> None:
    model, golden = read_checkpoint(PUBLISHED / solver).model, GoldenChain(solver)
    previous = golden.tensor(0, "previous")
    for segment in range(golden.segments):
        row = model.network.label_embed(torch.tensor([golden.label(segment)]))
        previous = model.segment(golden.tensor(segment, "noise"), row, golden.motion(segment), previous)
        assert_within_1e_4_of_its_rms(previous, golden.tensor(segment, "waveform"))


@pytest.mark.parametrize("solver", SOLVERS)
def test_three_segments_through_the_c_interface_are_the_golden_ones(
    engine: EngineLibrary, imported: dict[str, Path], solver: str
) -> None:
    golden, unused = GoldenChain(solver), np.zeros((1, 200), dtype=np.float32)
    with EngineGenerator(engine, imported[solver]) as generator:
        previous = golden.tensor(0, "previous").reshape(1, -1).numpy() * np.float32(UNIT_MPS2)
        for segment in range(golden.segments):
            row, noise = generator.embeddings[[golden.label(segment)]], golden.tensor(segment, "noise")
            motion = golden.motion(segment).numpy()
            previous = generator.generate(row, motion, previous, unused, latent_noise=noise.reshape(1, -1).numpy())
            assert_within_1e_4_of_its_rms(previous / UNIT_MPS2, golden.tensor(segment, "waveform")[0])


@pytest.mark.parametrize("solver", SOLVERS)
def test_the_offline_engine_plays_a_stroke_from_touch_down_at_the_measured_level(
    imported: dict[str, Path], solver: str, tmp_path: Path
) -> None:
    file = read_model_file(imported[solver])
    entries = file.header["seed_bank"]["entries"]
    seeds = [
        seed["gain"] * wave
        for seed, wave in zip(entries, file.tensors["seeds"], strict=True)
        if seed["label"] == "granite"
    ]
    expected = UNIT_MPS2 * np.sqrt(np.square(band_rms(np.array(seeds))).mean())
    motion = np.tile([0.04, 0.0, 0.75], (2000, 1))
    wave = render_motion(ENGINE, "granite", motion, tmp_path, model=imported[solver]).waveform_mps2
    assert np.isfinite(wave).all()
    assert abs(20 * np.log10(band_rms(wave[None, 400:])[0] / expected)) < 3.0
    # The seed sounds before the first segment is there.
    assert abs(20 * np.log10(band_rms(wave[None, 20:120])[0] / expected)) < 9.0


@pytest.mark.parametrize("solver", SOLVERS)
def test_learning_a_material_on_an_import_is_refused_because_its_network_has_its_own_unit(
    imported: dict[str, Path], solver: str, tmp_path: Path
) -> None:
    path = imported[solver]
    numbers = np.random.default_rng(1)
    recording = tmp_path / "board.wav"
    wavfile.write(recording, 8000, (0.1 * numbers.standard_normal(80000)).astype(np.float32))
    recording.with_suffix(".json").write_text('{"full_scale_mps2": 20}', encoding="utf-8")
    command = [str(ENGINE), "learn", str(recording), "--model", str(path), "-o", str(tmp_path / "board.haptomaterial")]
    command += ["--speed-mps", "0.04", "--force-newtons", "0.75"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 3, done.stderr
    assert f"{path}: the model gives all its labels one level, {UNIT_MPS2:.3g}" in done.stderr
    assert not (tmp_path / "board.haptomaterial").exists()


@pytest.mark.long(because="check-published runs whole; its lines of parity, signal and time are tested below")
class TestReport:
    """The whole command on a small import."""

    @pytest.fixture(scope="class")
    def out(self, imported: dict[str, Path], tmp_path_factory: pytest.TempPathFactory) -> Path:
        out = tmp_path_factory.mktemp("check")
        arguments = ["check-published", str(imported["heun"]), "--folder", str(PUBLISHED / "heun")]
        # Random weights have not the data set's level and spectrum.
        assert main([*arguments, "--seconds-limit", "0.5", "-o", str(out)]) == 3
        return out

    def test_the_page_has_every_line_of_the_json_and_both_pictures(self, out: Path) -> None:
        report = json.loads((out / "check.json").read_text(encoding="utf-8"))
        page = (out / "check.md").read_text(encoding="utf-8")
        assert len(report["lines"]) > 15
        for line in report["lines"]:
            assert f"| {line['part']} | {line['name']} | {line['verdict']} |" in page
        for picture in ("chart.png", "spectra.png"):
            assert f"]({picture})" in page
            assert (out / picture).read_bytes()[:4] == b"\x89PNG"

    def test_the_json_carries_versions_machine_and_provenance_and_nothing_of_the_user(self, out: Path) -> None:
        text = (out / "check.json").read_text(encoding="utf-8")
        report = json.loads(text)
        assert report["versions"]["haptoflow"] and report["versions"]["torch"] and report["machine"]
        assert "Apache-2.0" in report["provenance"]["licence"]
        assert report["parity_reference"] == "this project's own PyTorch modules"
        for private in (str(Path.home()), str(out), str(ROOT)):
            assert private not in text.replace("\\\\", "\\") or private == "/"

    def test_points_of_all_steps_with_and_without_guidance_have_times_and_distances(self, out: Path) -> None:
        points = json.loads((out / "check.json").read_text(encoding="utf-8"))["points"]
        assert {(each["family"], each["steps"]) for each in points} == {
            ("with guidance", 1), ("with guidance", 2), ("without guidance", 1), ("without guidance", 2),
        }  # fmt: skip
        best = points[-1]
        assert best["name"] == "published" and best["difference"] == 0.0 and best["lsd_db"] == 0.0
        assert all(each["difference"] > 0.0 and each["paced_ms"]["p50"] > 0.0 for each in points[:-1])


@pytest.mark.long(because="check-published runs whole; its lines of parity, signal and time are tested below")
def test_a_file_that_is_no_import_is_measured_and_its_parity_does_not_apply(tmp_path: Path) -> None:
    code = main(["check-published", str(ROOT / SHIPPED_MODEL), "--seconds-limit", "0.5", "-o", str(tmp_path)])
    report = json.loads((tmp_path / "check.json").read_text(encoding="utf-8"))
    lines = {line["name"]: line for line in report["lines"]}
    assert lines["the file against the checkpoint"]["verdict"] == NOT_APPLICABLE
    assert lines["level"]["verdict"] == lines["power below 500 Hz"]["verdict"] == NOT_APPLICABLE
    assert lines["more steps are nearer the best tier"]["verdict"] == NOT_APPLICABLE
    assert lines["labels differ"]["verdict"] == lines["finite numbers"]["verdict"] == PASS
    assert {point["name"] for point in report["points"]} == {"sketch", "draft", "standard"}
    assert code == (3 if any(line["verdict"] == FAIL for line in lines.values()) else 0)


class TestParity:
    @pytest.mark.parametrize("solver", SOLVERS)
    def test_an_import_passes_against_its_own_folder(
        self, engine: EngineLibrary, imported: dict[str, Path], solver: str
    ) -> None:
        lines, reference = _parity(engine, imported[solver], PUBLISHED / solver)
        verdicts = _verdicts(lines)
        missing = {"the authors' code is the reference", "codes of the quantiser"}
        assert {name for name, verdict in verdicts.items() if verdict == NOT_APPLICABLE} == missing
        assert {verdict for name, verdict in verdicts.items() if name not in missing} == {PASS}
        assert "own" in reference

    def test_changed_weights_fail_where_they_are_used(
        self, engine: EngineLibrary, imported: dict[str, Path], tmp_path: Path
    ) -> None:
        folder = copied("heun", tmp_path)

        def change(header: dict[str, Any], data: bytearray) -> None:
            begin, end = header["model.backbone.out_conv.weight"]["data_offsets"]
            data[begin:end] = (1.01 * np.frombuffer(data[begin:end], dtype="<f4")).astype("<f4").tobytes()

        change_safetensors(folder, change)
        verdicts = _verdicts(_parity(engine, imported["heun"], folder)[0])
        assert verdicts["the file was imported from this folder"] == FAIL
        assert verdicts["graph: velocity at t = 0.5"] == verdicts["engine: a chain of three segments"] == FAIL
        assert verdicts["graph: latent of the past"] == verdicts["graph: waveform of a latent"] == PASS


class _AuthorsEngine:
    """What this command uses of the authors' inference engine, by their names and shapes, around our own modules."""

    device = torch.device("cpu")
    velocity_gain = 1.0
    code_shift = 0
    status = "ok"

    def init_from_model_dir(self, folder: str) -> tuple[str, str]:
        self._own: PublishedModel = read_checkpoint(Path(folder)).model
        self.label_embed = self._own.network.label_embed
        self.control_embedding = self._own.network.control_embedding
        self.prev_segment_encoder = self._own.network.prev_segment_encoder
        self.encodec_wrapper = SimpleNamespace(
            encode_waveform=self._encode, quantize_latent=self._quantize, decode_from_codes=self._decode
        )
        self.model = SimpleNamespace(_velocity=self._velocity, generate=self._generate)
        return "message of theirs", self.status

    def _normalize_control_values(self, force: float, vx: float, vy: float) -> tuple[float, ...]:
        statistics = self._own.meta.controls
        values = {"force": force, "velocity_x": vx, "velocity_y": vy}
        return tuple((value - statistics[name].mean) / statistics[name].deviation for name, value in values.items())

    def _encode(self, x: torch.Tensor, **options: Any) -> dict[str, torch.Tensor]:
        assert options == {"return_latent": True, "return_codes": False, "input_sample_rate": 2000.0}
        return {"latent": self._own.encode(x)}

    def _quantize(self, latent: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
        codes = (self._own.quantiser.codes(latent) + self.code_shift) % self._own.quantiser.codebooks.shape[1]
        assert len(codes) == 1
        return codes[0], latent[0]

    def _decode(self, codes: torch.Tensor, target_sample_rate: float) -> torch.Tensor:
        assert target_sample_rate == 2000.0
        books = self._own.quantiser.codebooks
        latent = sum(books[level][codes[:, level]] for level in range(len(books)))
        assert isinstance(latent, torch.Tensor)
        wave = self._own.downwards(self._own.codec.decoder(latent.transpose(1, 2)))
        return wave[0] if len(codes) == 1 else wave

    def _velocity(self, x: torch.Tensor, time: float, cond: torch.Tensor, feats: list[torch.Tensor]) -> torch.Tensor:
        moment = torch.full((len(x), 1), time)
        return self.velocity_gain * self._own.velocity(x, moment, cond, feats, self._own.meta.guidance)

    def _generate(self, *, steps: int, cond: torch.Tensor, shape: torch.Size, encoder_feats: list[torch.Tensor], noise: torch.Tensor) -> torch.Tensor:  # fmt: skip
        assert steps == self._own.meta.steps and noise.shape == shape
        return self._own.generate(noise, cond, encoder_feats)


class TestAuthorsModules:
    """With a stand-in for the authors' package, which cannot be installed where the tests run."""

    def _install(self, monkeypatch: pytest.MonkeyPatch, **changes: Any) -> None:
        module = ModuleType(reference_module.AUTHORS_MODULE)
        module.FlowMatchingInference = type("FlowMatchingInference", (_AuthorsEngine,), changes)  # type: ignore[attr-defined]
        names = reference_module.AUTHORS_MODULE.split(".")
        for depth in range(1, len(names)):
            monkeypatch.setitem(sys.modules, ".".join(names[:depth]), ModuleType(names[depth - 1]))
        monkeypatch.setitem(sys.modules, reference_module.AUTHORS_MODULE, module)

    @pytest.mark.parametrize("solver", SOLVERS)
    def test_they_are_the_reference_and_every_stage_is_compared(
        self, engine: EngineLibrary, imported: dict[str, Path], monkeypatch: pytest.MonkeyPatch, solver: str
    ) -> None:
        self._install(monkeypatch)
        lines, reference = _parity(engine, imported[solver], PUBLISHED / solver)
        verdicts = _verdicts(lines)
        assert set(verdicts.values()) == {PASS}
        assert reference == "the authors' own modules"
        for stage in ("latent of the past", "features of the past, level 1", "condition", "velocity at t = 0.125", "codes of the quantiser", "waveform of a latent"):  # fmt: skip
            assert f"importer: {stage}" in verdicts


DATA_SET = {"provenance": {"recordings": "Cluster Haptic Texture Dataset, CC BY 4.0"}, "normalisation": {}}


def _waves(levels: list[float], centres_hz: list[float], floor: float = 0.15) -> LabelWaves:
    """Noise an octave wide about each label's centre above a white floor, of the stated RMS."""
    frequency = np.fft.rfftfreq(800, 1.0 / 2000.0)[1:]
    shapes = np.exp(-np.square(np.log2(frequency / np.array(centres_hz)[:, None]))) + floor
    shapes = np.concatenate([np.zeros((len(levels), 1)), shapes], axis=1)[:, None]
    white = np.fft.rfft(np.random.default_rng(1).standard_normal((len(levels), 2, 800)), axis=2)
    waves = np.fft.irfft(shapes * white, 800, axis=2)
    waves *= np.array(levels)[:, None, None] / np.sqrt(np.square(waves).mean(axis=2, keepdims=True))
    names = tuple(f"label {place}" for place in range(len(levels)))
    return LabelWaves(names, ("wood",) * len(levels), waves.astype(np.float32), len(levels))


class TestSignals:
    good = _waves([0.4, 0.57, 0.8], [60.0, 120.0, 200.0], floor=0.1)

    def test_a_signal_like_the_data_set_s_passes_every_line(self) -> None:
        assert set(_verdicts(signal_lines(self.good, DATA_SET)).values()) == {PASS}

    def test_a_wrong_level_fails(self) -> None:
        strong = replace(self.good, waves=self.good.waves * np.float32(9.81))
        verdicts = _verdicts(signal_lines(strong, DATA_SET))
        assert {name for name, verdict in verdicts.items() if verdict == FAIL} == {"level"}


    @pytest.mark.parametrize("tone_hz", [700.0, 900.0])
    def test_power_above_500_hz_fails(self, tone_hz: float) -> None:
        assert _verdicts(signal_lines(_waves([0.57, 0.57], [100.0, tone_hz]), DATA_SET))["power below 500 Hz"] == FAIL


def _tier(name: str, steps: int, **more: Any) -> dict[str, Any]:
    field = "unguided" if "unguided" in name else "field"
    return {"name": name, "kind": "flow", "field": field, "solver": "heun", "steps": steps, **more}


HEADER: dict[str, Any] = {
    "tiers": [_tier("published-2-unguided", 2), _tier("published-2", 2), _tier("published-4", 4), _tier("published", 8)],
    "default_tier": "published",
}


def _measured(milliseconds: dict[str, float], header: dict[str, Any] = HEADER) -> list[Measured]:
    return [
        Measured(point, *(2 * [Milliseconds(time, time)]), 0.0 if point.name == "published" else 1.0 / point.steps, 1.0)
        for point in points_of(header)
        for time in [milliseconds.get(point.name, 1.0)]
    ]


REFERENCE = Measured(Point("reference", "standard", "tier", 0, "reference", False), Milliseconds(0.5, 0.5), Milliseconds(0.5, 0.5), 0.0, 0.0)


class TestTimes:
    def test_the_chart_s_points_are_8_4_2_and_1_steps_with_and_without_guidance_and_the_best_is_last(self) -> None:
        points = points_of(HEADER)
        assert sorted((point.family, point.steps) for point in points) == [
            (family, steps) for family in ("with guidance", "without guidance") for steps in (1, 2, 4, 8)
        ]
        assert points[-1].name == "published"
        assert [point.name for point in points if point.is_tier] == [tier["name"] for tier in HEADER["tiers"]]


    def test_auto_takes_the_best_tier_that_fits(self) -> None:
        lines = time_lines(HEADER, _measured({"published-4": 3.0, "published": 6.0}), REFERENCE, "the reference")
        auto = next(line for line in lines if line.name == "quality auto")
        assert (auto.verdict, auto.measured) == (PASS, "auto takes published-4")
        assert "hot 6 times the reference" in next(line.measured for line in lines if line.name == "tier published-4 keeps up")


    def test_a_tier_slower_than_its_segment_fails(self) -> None:
        slow = {tier["name"]: 90.0 for tier in HEADER["tiers"]}
        verdicts = _verdicts(lines := time_lines(HEADER, _measured(slow), REFERENCE, "the reference"))
        assert verdicts["tier published keeps up"] == verdicts["tier published-2 keeps up"] == FAIL
        assert "breaks off" in next(line.measured for line in lines if line.name == "quality auto")


    def test_the_budget_is_the_engine_s(self) -> None:
        source = (ROOT / "NativePlugin" / "src" / "engine" / "quality_control.hpp").read_text(encoding="utf-8")
        assert "defaultUpdateRateHz = 72.0;" in source and "defaultBudgetShare = 0.25;" in source
        assert BUDGET_MS == pytest.approx(1000.0 * 0.25 / 72.0)


@pytest.mark.long(
    because="a network of the published sizes is exported and run; "
    "test_three_segments_through_the_c_interface_are_the_golden_ones holds the engine to the authors' own arrays at small "
    "sizes"
)
def test_a_model_of_the_published_sizes_computes_the_same_in_the_engine_as_in_pytorch(tmp_path: Path) -> None:
    checkpoint = read_checkpoint(write_checkpoint_of_published_sizes(tmp_path / "published"))
    file = PublishedFile(checkpoint)
    path = tmp_path / "published.haptoflow"
    file.write_draft(path)
    model, numbers = checkpoint.model, np.random.default_rng(5)
    labels, count = np.array([3, 117]), 2
    motions = np.array([[0.03, -0.02, 0.6], [-0.05, 0.01, 1.0]], dtype=np.float32)
    noise = numbers.standard_normal((count, 128, 8), dtype=np.float32)
    previous = 0.3 * numbers.standard_normal((count, 200), dtype=np.float32)
    with EngineGenerator(default_engine(ROOT), path, maximum_batch=count) as generator:
        rows = generator.embeddings[labels]
        unused = np.zeros_like(previous)
        for _ in range(2):
            found = generator.generate(rows, motions, previous, unused, latent_noise=noise.reshape(count, -1))
            expected = model.segment(
                torch.from_numpy(noise),
                model.network.label_embed(torch.from_numpy(labels)),
                torch.from_numpy(motions),
                torch.from_numpy(previous).unsqueeze(1),
            )
            assert_within_1e_4_of_its_rms(found, expected[:, 0])
            previous = found
