"""Our modules compute what the authors' compute: golden arrays of their own code, stage by stage."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import numpy as np
import pytest
import torch
from numpy.typing import NDArray
from scipy.io import wavfile

from haptoflow_benchmark.engine_library import EngineLibrary
from haptoflow_benchmark.engine_render import render_motion
from haptoflow_paper.cli import main
from haptoflow_paper.published.checkpoint import read_checkpoint
from haptoflow_paper.published.level_measurement import band_rms
from haptoflow_paper.published.published_file import STANDARD_GRAVITY_MPS2
from haptoflow_paper.published.published_model import PublishedModel
from haptoflow_paper.rows.engine_generator import EngineGenerator
from haptoflow_training.export.model_file import ModelFile, read_model_file
from published_samples import PUBLISHED, SOLVERS, GoldenChain, assert_within_1e_4_of_its_rms
from places import ENGINE

@pytest.fixture(scope="module", params=SOLVERS)
def solver(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.fixture(scope="module")
def model(solver: str) -> PublishedModel:
    return read_checkpoint(PUBLISHED / solver).model


@pytest.fixture(scope="module")
def golden(solver: str) -> GoldenChain:
    return GoldenChain(solver)


def _row(model: PublishedModel, golden: GoldenChain, segment: int) -> torch.Tensor:
    return model.network.label_embed(torch.tensor([golden.label(segment)]))


def test_three_segments_that_follow_each_other_are_the_golden_ones(model: PublishedModel, golden: GoldenChain) -> None:
    previous = golden.tensor(0, "previous")
    for segment in range(golden.segments):
        noise, row = golden.tensor(segment, "noise"), _row(model, golden, segment)
        previous = model.segment(noise, row, golden.motion(segment), previous)
        assert_within_1e_4_of_its_rms(previous, golden.tensor(segment, "waveform"))


PEAK_G = 1.5
UNIT_MPS2 = PEAK_G * STANDARD_GRAVITY_MPS2


@pytest.fixture(scope="module")
def path(solver: str, tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("imported") / f"{solver}.haptoflow"
    arguments = ["import-published", str(PUBLISHED / solver), "--peak-g", str(PEAK_G), "-o", str(out)]
    assert main(arguments) == 0
    return out


@pytest.fixture(scope="module")
def file(path: Path) -> ModelFile:
    return read_model_file(path)


def _generated(
    generator: EngineGenerator, golden: GoldenChain, segment: int, previous: NDArray[np.float32]
) -> NDArray[np.float32]:
    row = generator.embeddings[[golden.label(segment)]]
    noise = golden.tensor(segment, "noise").reshape(1, -1).numpy()
    unused = np.zeros((1, 200), dtype=np.float32)
    return generator.generate(row, golden.motion(segment).numpy(), previous, unused, latent_noise=noise)


def test_three_segments_through_the_c_interface_are_the_golden_ones(
    engine: EngineLibrary, path: Path, golden: GoldenChain
) -> None:
    with EngineGenerator(engine, path) as generator:
        previous = golden.tensor(0, "previous").reshape(1, -1).numpy() * np.float32(UNIT_MPS2)
        for segment in range(golden.segments):
            previous = _generated(generator, golden, segment, previous)
            assert_within_1e_4_of_its_rms(previous / UNIT_MPS2, golden.tensor(segment, "waveform")[0])


def test_the_offline_engine_plays_a_stroke_from_touch_down_at_the_measured_level(
    path: Path, file: ModelFile, tmp_path: Path
) -> None:
    entries = file.header["seed_bank"]["entries"]
    seeds = [
        seed["gain"] * wave for seed, wave in zip(entries, file.tensors["seeds"], strict=True) if seed["label"] == "granite"
    ]
    expected = UNIT_MPS2 * np.sqrt(np.square(band_rms(np.array(seeds))).mean())
    motion = np.tile([0.04, 0.0, 0.75], (2000, 1))
    wave = render_motion(ENGINE, "granite", motion, tmp_path, model=path).waveform_mps2
    assert np.isfinite(wave).all()
    assert abs(20 * np.log10(band_rms(wave[None, 400:])[0] / expected)) < 3.0
    # The seed sounds before the first segment is there.
    assert abs(20 * np.log10(band_rms(wave[None, 20:120])[0] / expected)) < 9.0


def test_learning_a_material_on_an_import_is_refused_because_its_network_has_its_own_unit(path: Path, tmp_path: Path) -> None:
    numbers = np.random.default_rng(1)
    recording = tmp_path / "board.wav"
    wavfile.write(recording, 8000, (0.1 * numbers.standard_normal(80000)).astype(np.float32))
    recording.with_suffix(".json").write_text('{"full_scale_mps2": 20}', encoding="utf-8")
    command = [str(ENGINE), "learn", str(recording), "--model", str(path), "-o", str(tmp_path / "board.haptomaterial")]
    done = subprocess.run([*command, "--speed-mps", "0.04", "--force-newtons", "0.75"], capture_output=True, text=True, check=False)
    assert done.returncode == 3, done.stderr
    assert f"{path}: the model gives all its labels one level, {UNIT_MPS2:.3g}" in done.stderr
    assert not (tmp_path / "board.haptomaterial").exists()
