"""Rivals given the same: each form learns its task, keeps phases, and becomes a model file."""

from __future__ import annotations

import dataclasses
import json
import math
from pathlib import Path

import numpy as np
import onnx
import pytest
import scipy.signal
import torch
from test_export import PROVENANCE
from test_graph_operators import _check
from test_trainer import ALONE
from torch import Tensor
from training_fixtures import make_store

from haptoflow_paper.rivals.autoregressive import AutoregressiveRival
from haptoflow_paper.runs.trainer import EvaluatedTrainer
from haptoflow_training.commands import train
from haptoflow_training.errors import InputError
from haptoflow_training.export.exporter import export_run
from haptoflow_training.export.label_info import LabelInfo
from haptoflow_training.export.level_table import MeasuredLevels
from haptoflow_training.export.model_file import read_model_file
from haptoflow_training.models.label_embedding import surface_phases
from haptoflow_training.training.config import BatchConfig, TrainingConfig, load_config
from haptoflow_training.training.recordings_source import Source
from haptoflow_training.training.trainer import planned_steps

CONFIGS = Path(__file__).parents[2] / "Training" / "haptoflow_paper" / "configs"
GIVEN_THE_SAME = (
    "field", "ar-ribs", "mean-flow-ribs", "reflow-ribs", "spsi-ribs", "transformer-noise", "dstn-noise",
)  # fmt: skip
INFOS = [LabelInfo("tone", "metal", 900.0, 0.3, 0.002, ((0.5, 0.0),)), LabelInfo("noise", "stone", 1500.0, 0.6)]
WAVE_VECTORS = [[(0.5, 0.0)], []]


def _shortened(name: str) -> TrainingConfig:
    """The shipped configuration with a few steps a phase."""
    config = load_config(CONFIGS / f"{name}.toml")
    few = {
        key: min(4, getattr(config.recipe, key))
        for key in ("filter_steps", "reflow_steps", "energy_steps", "self_forcing_steps")
    }
    return dataclasses.replace(
        config,
        optimiser=dataclasses.replace(
            config.optimiser, budget_seconds=0.0, batch_size=8, level_steps=4, level_polish_steps=2,
            steps=min(4, config.optimiser.steps), warm_up_steps=2, average_decay=0.5,
        ),
        batch=BatchConfig(),
        recipe=dataclasses.replace(config.recipe, **few, reflow_pairs=500, energy_batch_size=6),
    )  # fmt: skip


@pytest.mark.parametrize("name", GIVEN_THE_SAME)
def test_a_rival_given_the_same_has_the_recordings_batches_and_time_of_our_recipe(name: str) -> None:
    ours, rival = load_config(CONFIGS / "sketch.toml"), load_config(CONFIGS / f"{name}.toml")
    assert rival.model.network == "field" and rival.model.ribs
    assert rival.recipe.calibrate_level and ours.recipe.calibrate_level
    assert rival.data == ours.data
    assert rival.batch == ours.batch
    assert rival.optimiser.budget_seconds == ours.optimiser.budget_seconds > 0.0


@pytest.mark.parametrize("name", GIVEN_THE_SAME)
def test_a_rival_given_the_same_trains_through_its_phases_and_becomes_a_model_file(
    name: str, tmp_path: Path
) -> None:
    config, store = _shortened(name), make_store(seconds=6.0, recordings_per_split=4)
    EvaluatedTrainer(config, store, tmp_path / "run", ALONE, wave_vectors=WAVE_VECTORS).run()
    phases = json.loads((tmp_path / "run" / "run.json").read_text(encoding="utf-8"))["phases"]
    assert [phase["steps"] for phase in phases] == planned_steps(config)
    export_run(tmp_path / "run", Source(store, INFOS, PROVENANCE), tmp_path / "m.haptoflow", tmp_path / "parity.json")
    file = read_model_file(tmp_path / "m.haptoflow")
    graph = file.graphs[f"{config.tier}.field"]
    _check(graph)
    inputs = [value.name for value in onnx.load_from_string(graph).graph.input]
    assert "noisy" in inputs and inputs[-1] == "phases"


@pytest.mark.parametrize(
    ("text", "key"),
    [
        ('[model]\nsampled = true\n', "model.sampled"),
        ('[model]\nnetwork = "field"\narchitecture = "autoregressive"\nsampled = true\n', "model.sampled"),
        ('[model]\nnetwork = "field"\narchitecture = "autoregressive"\n[recipe]\nreflow_steps = 3\n', "recipe"),
        ('[model]\nnetwork = "field"\narchitecture = "autoregressive"\n[recipe]\nself_forcing_steps = 3\n', "recipe.self_forcing_steps"),
        ('[model]\nnetwork = "field"\narchitecture = "autoregressive"\n[recipe]\nenergy_steps = 3\n', "recipe.energy_steps"),
        ('[model]\nnetwork = "field"\narchitecture = "dstn"\n[recipe]\nfilter_steps = 3\n', "recipe.filter_steps"),
        ("[optimiser]\nbudget_seconds = -1\n", "optimiser.budget_seconds"),
    ],
)
def test_an_unsupported_option_of_a_rival_is_refused_with_its_key_named(text: str, key: str, tmp_path: Path) -> None:
    (tmp_path / "run.toml").write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=f"key '{key}'"):
        load_config(tmp_path / "run.toml")


def _condition(count: int, speed_mps: float) -> tuple[Tensor, Tensor, Tensor]:
    """An embedding with ribs of 2 mm along x, motion across them, and the phases."""
    embedding = torch.full((1, 64), 0.3)
    embedding[:, -4:] = torch.tensor([0.5, 0.0, 0.0, 0.0])
    motion = torch.tensor([[speed_mps, 0.0, 1.0]])
    embedding, motion = embedding.expand(count, -1), motion.expand(count, -1)
    phases = surface_phases(embedding, motion, torch.zeros(count, 2), torch.zeros(count, 6))
    phases[:, 0] = torch.linspace(0.0, 0.9, count)
    return embedding, motion, phases


_RINGING = np.array([1.0, -2.0 * 0.9 * math.cos(2.0 * math.pi * 0.15), 0.81])
_DRIVE = 0.25
_LINE = 0.8


def _ribbed_texture(count: int, seed: int) -> tuple[Tensor, Tensor, tuple[Tensor, Tensor, Tensor]]:
    """Previous and segment [count, 1, 200] of an autoregressive texture with ribs that pass at 100 Hz in the
    surface's phase, and their conditions."""
    generator = np.random.default_rng(seed)
    noise = scipy.signal.lfilter([_DRIVE], _RINGING, generator.standard_normal((count, 900)))[:, 500:]
    embedding, motion, phase = _condition(count, 0.2)
    phase = torch.cat([torch.from_numpy(generator.random((count, 1))).float(), phase[:, 1:]], dim=1)
    turns = 100.0 * torch.arange(-200, 200) / 2000.0 + phase[:, :1]
    wave = torch.from_numpy(noise).float() + _LINE * torch.cos(2.0 * math.pi * turns)
    return wave[:, None, :200], wave[:, None, 200:], (embedding, motion, phase)


def test_the_energy_distance_trains_the_lines_and_only_the_likelihood_trains_the_filter() -> None:
    torch.manual_seed(7)
    baseline = AutoregressiveRival(ribs=True)
    previous, segment, condition = _ribbed_texture(4, 1)
    made = baseline(torch.randn(4, 1, 200), previous, *condition)
    (made - segment).square().mean().backward()
    assert baseline.lines is not None
    assert baseline.lines.gains.layers[-1].weight.grad is not None
    assert all(parameter.grad is None for parameter in baseline.perceptron.parameters())


def test_the_level_error_of_a_trained_row_is_corrected_at_its_export(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    store = make_store(seconds=6.0, recordings_per_split=4)
    source = Source(store, INFOS, PROVENANCE)  # type: ignore[arg-type]
    monkeypatch.setattr(train, "open_source", lambda *_: source)
    measured: list[Path] = []

    def levels_of(folder: Path, given: Source, extent: object) -> MeasuredLevels:
        measured.append(folder)
        return MeasuredLevels([2.0, -1.0])

    monkeypatch.setattr(train, "measured_levels", levels_of)
    text = (
        '[model]\nwidth = 16\nprevious_width = 8\n[optimiser]\nbatch_size = 8\nlevel_steps = 4\nsteps = 4\n'
        "level_polish_steps = 0\n[recipe]\ncalibrate_level = {}\n"
    )
    levels = []
    for name, value in (("as-is", "false"), ("calibrated", "true")):
        config, out = tmp_path / f"{name}.toml", tmp_path / name
        config.write_text(text.format(value), encoding="utf-8")
        words = ["--config", str(config), "--out", str(out), "--export", str(tmp_path / f"{name}.haptoflow")]
        assert _train(words) == 0
        said = json.loads((out / "export.json").read_text(encoding="utf-8"))
        levels.append(said.get("level_offsets_db"))
    assert levels == [None, {"tone": 2.0, "noise": -1.0}]
    assert measured == [tmp_path / "calibrated"]
    header = read_model_file(tmp_path / "calibrated.haptoflow").header
    assert header["measurements"]["level_offsets_db"] == [2.0, -1.0]


def _train(words: list[str]) -> int:
    from haptoflow_paper.cli import main

    return main(["train", *words])
