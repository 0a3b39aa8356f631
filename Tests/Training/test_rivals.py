"""Rivals given the same: each form learns its task, keeps phases, and becomes a model file."""

from __future__ import annotations

import dataclasses
import io
import json
import math
import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np
import onnx
import pytest
import scipy.signal
import torch
from torch import Tensor

from haptoflow_paper.rivals import ARCHITECTURES, Rival, build_rival
from haptoflow_paper.rivals.autoregressive import AutoregressiveRival
from haptoflow_paper.rivals.rival import INPUTS, SegmentNetworkGraph
from haptoflow_paper.rivals.spsi import SpsiRival
from haptoflow_paper.runs.trainer import EvaluatedTrainer
from haptoflow_training.commands import train
from haptoflow_training.errors import InputError
from haptoflow_training.export.exporter import export_run
from haptoflow_training.recordings.landing import LabelInfo
from haptoflow_training.export.level_table import MeasuredLevels
from haptoflow_training.export.model_file import read_model_file
from haptoflow_training.export.trained_tier import trace_graph
from haptoflow_training.models.conditioning import EMBEDDING_SIZE
from haptoflow_training.training.config import BatchConfig, TrainingConfig, load_config
from haptoflow_training.training.recordings_source import Source
from haptoflow_training.training.trainer import planned_steps
from test_export import PROVENANCE
from test_networks import _check
from test_trainer import ALONE
from training_fixtures import make_store
from places import ROOT

CONFIGS = ROOT / "Training" / "haptoflow_paper" / "configs"
GIVEN_THE_SAME = ("field", "ar-ribs", "mean-flow-ribs", "reflow-ribs", "spsi-ribs", "transformer-noise", "dstn-noise")
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


_LARGE = pytest.mark.long(because="the two largest networks; the other rivals train and are exported by the same code")


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[_LARGE] if name.endswith("-noise") else []) for name in GIVEN_THE_SAME]
)
def test_a_rival_given_the_same_trains_through_its_phases_and_becomes_a_model_file(name: str, tmp_path: Path) -> None:
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
        '[model]\nhidden = [8, 8]\n[optimiser]\nbatch_size = 8\nlevel_steps = 4\nsteps = 4\n'
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


DETERMINISTIC = ("transformer", "dstn")
RANDOM = ("spsi", "autoregressive")
SAMPLED = ("transformer", "dstn", "spsi")
# In the forms as published and given the same.
FORMS = {
    **{architecture: {"architecture": architecture} for architecture in ARCHITECTURES},
    "autoregressive with ribs": {"architecture": "autoregressive", "ribs": True},
    **{
        f"{architecture}, sampled with ribs": {"architecture": architecture, "ribs": True, "sampled": True}
        for architecture in SAMPLED
    },
}

Batch = Callable[[int], tuple[Tensor, Tensor]]


def _inputs(batch: int) -> dict[str, Tensor]:
    generator = torch.Generator().manual_seed(5)
    # Ribs must pass fast enough for the past to hold their partials.
    turns, rates_hz = torch.rand(2, batch, 3, generator=generator).unbind()
    return {
        "noisy": torch.randn(batch, 1, 200, generator=generator),
        "previous": torch.randn(batch, 1, 200, generator=generator),
        "embedding": torch.randn(batch, EMBEDDING_SIZE, generator=generator),
        "motion": 0.2 * torch.rand(batch, 3, generator=generator),
        "phases": torch.cat([turns, 20.0 + 40.0 * rates_hz], dim=1),
    }


def _built(form: str) -> Rival:
    torch.manual_seed(1)
    baseline = build_rival(**FORMS[form]).eval()
    if baseline.lines is not None:
        # Lines are zero until trained.
        torch.nn.init.normal_(baseline.lines.gains.layers[-1].bias, std=0.2)
    return baseline


def _one_condition(batch: int) -> tuple[Tensor, Tensor, Tensor]:
    """Embedding, motion and phases."""
    motion = torch.tensor([[0.06, 0.0, 1.0]]).expand(batch, -1)
    return torch.full((batch, EMBEDDING_SIZE), 0.3), motion, torch.zeros(batch, 6)


def _test_rival_networks_train(baseline: Rival, draw: Batch, steps: int, rate: float) -> list[float]:
    """Losses of every step on batches of (previous, segment) from `draw`, all of one condition."""
    optimiser = torch.optim.Adam(baseline.parameters(), lr=rate)
    generator, losses = torch.Generator().manual_seed(0), []
    for step in range(steps):
        previous, segment = draw(step)
        loss = baseline.loss(segment, previous, *_one_condition(len(segment)), generator).mean()
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
        losses.append(loss.item())
    return losses


@pytest.mark.parametrize("form", FORMS)
def test_a_rival_s_loss_is_one_number_for_every_row(form: str) -> None:
    inputs = _inputs(3)
    segment, generator = inputs.pop("noisy"), torch.Generator().manual_seed(0)
    baseline = _built(form)
    loss = baseline.loss(segment, **inputs, generator=generator)
    row = {name: value[1:2] for name, value in inputs.items()}
    alone = baseline.loss(segment[1:2], **row, generator=generator)
    assert loss.shape == (3,)
    if "noisy" not in baseline.inputs or baseline.lines is None:
        torch.testing.assert_close(loss[1:2], alone, rtol=1e-4, atol=1e-5)


@pytest.mark.parametrize("form", FORMS)
def test_exactly_the_named_inputs_affect_a_rival_s_output(form: str) -> None:
    baseline, inputs = _built(form), _inputs(2)
    before = baseline(**inputs)
    for name in INPUTS:
        after = baseline(**dict(inputs, **{name: inputs[name] + 0.1}))
        assert torch.equal(before, after) == (name not in baseline.inputs), name


def test_deterministic_rivals_ignore_the_noise_and_sampled_ones_read_it() -> None:
    assert sorted(DETERMINISTIC + RANDOM) == sorted(ARCHITECTURES)
    assert all("noisy" not in _built(architecture).inputs for architecture in DETERMINISTIC)
    assert all("noisy" in _built(architecture).inputs for architecture in RANDOM)


def test_spsi_learns_a_spectrum_and_renders_at_the_stated_level() -> None:
    frequencies = torch.linspace(0.0, 1.0, 101)
    shape = (-((frequencies - 0.3) / 0.1).square()).exp() + 0.05

    def draw(step: int) -> tuple[Tensor, Tensor]:
        noise = torch.randn(32, 1, 200, generator=torch.Generator().manual_seed(step))
        return torch.zeros_like(noise), torch.fft.irfft(torch.fft.rfft(noise) * shape)

    baseline = SpsiRival()
    losses = _test_rival_networks_train(baseline, draw, 80, 3e-3)
    with torch.no_grad():
        conditions = _one_condition(64)
        stated = baseline.log_magnitudes(*conditions[:2])[0]
        noise = torch.randn(64, 1, 200, generator=torch.Generator().manual_seed(2))
        made = baseline(noise, torch.zeros_like(noise), *conditions)
    # The geometric mean of a Gaussian texture's magnitudes lies a factor exp(-0.289) below their RMS.
    expected = (shape * math.sqrt(75.0)).log() - 0.289
    assert losses[-1] < 0.3 * losses[0]
    assert (stated - expected)[5:95].abs().mean() < 0.15
    power = (stated.exp().square() * 2.0).sum() / (200.0 * 75.0)
    assert made.square().mean().sqrt().item() == pytest.approx(power.sqrt().item(), rel=0.05)


@pytest.mark.long(because="a filter is trained; test_all_pole_filter.py holds its arithmetic and Burg's estimates")
def test_the_autoregressive_rival_learns_the_poles_and_level_of_a_process() -> None:
    radius, angle = 0.95, 2.0 * math.pi * 0.08
    truth = np.array([1.0, -2.0 * radius * math.cos(angle), radius**2])
    gain = 0.2
    source = np.random.default_rng(4)

    def draw(_step: int) -> tuple[Tensor, Tensor]:
        wave = scipy.signal.lfilter([gain], truth, source.standard_normal((16, 800)))[:, 400:]
        both = torch.from_numpy(wave).float().unsqueeze(1)
        return both[:, :, :200], both[:, :, 200:]

    torch.manual_seed(0)
    baseline = AutoregressiveRival()
    losses = _test_rival_networks_train(baseline, draw, 150, 3e-3)
    with torch.no_grad():
        coefficients, log_gain = baseline.process(*_one_condition(1)[:2])
    learned = np.concatenate([[1.0], coefficients[0].double().numpy()])
    least = math.log(gain) + 0.5
    assert losses[-1] - least < 0.1 < losses[0] - least
    assert math.exp(log_gain.item()) == pytest.approx(gain, rel=0.1)
    response = [np.abs(scipy.signal.freqz([1.0], a, worN=128)[1]) for a in (truth, learned)]
    assert np.abs(20.0 * np.log10(response[1] / response[0])).mean() < 1.5
    assert abs(int(response[1].argmax()) - int(response[0].argmax())) <= 1


def _exported(baseline: Rival, batch: int) -> onnx.ModelProto:
    given = {name: _inputs(batch)[name] for name in baseline.inputs}
    buffer = io.BytesIO()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        trace_graph(SegmentNetworkGraph(baseline), tuple(given.values()), buffer, list(given), ["segment"])
    return onnx.load_from_string(buffer.getvalue())


@pytest.mark.parametrize(
    "form",
    [pytest.param(form, marks=[_LARGE] if form in ("transformer, sampled with ribs", "dstn, sampled with ribs") else [])
     for form in FORMS],
)  # fmt: skip
def test_a_rival_exports_as_one_graph_for_every_batch_size(form: str) -> None:
    baseline = _built(form)
    model = _exported(baseline, 2)
    onnx.checker.check_model(model, full_check=True)
    assert [value.name for value in model.graph.input] == list(baseline.inputs)
    for value in (*model.graph.input, *model.graph.output):
        assert value.type.tensor_type.shape.dim[0].dim_param == "batch"
    assert not {"Loop", "Scan", "If"} & {node.op_type for node in model.graph.node}
    # Differs if tracing has made the batch size a constant.
    assert model.graph.SerializeToString() == _exported(baseline, 3).graph.SerializeToString()
