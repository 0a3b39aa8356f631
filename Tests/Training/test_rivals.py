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
from paper_samples import evaluated
from test_export import PROVENANCE
from test_graph_operators import _check
from test_trainer import ALONE
from torch import Tensor
from training_fixtures import make_store

from haptoflow_paper.rivals import build_rival
from haptoflow_paper.rivals.autoregressive import AutoregressiveRival
from haptoflow_paper.rivals.rival import Rival
from haptoflow_paper.rivals.spsi import SpsiRival
from haptoflow_paper.rows.row_plan import PlannedRow, load_plan
from haptoflow_paper.runs.losses import EvaluatedLosses
from haptoflow_paper.runs.networks import EvaluatedModel
from haptoflow_paper.runs.trainer import EvaluatedTrainer
from haptoflow_training.commands import train
from haptoflow_training.errors import InputError
from haptoflow_training.export.exporter import export_run
from haptoflow_training.export.label_info import LabelInfo
from haptoflow_training.export.level_table import MeasuredLevels
from haptoflow_training.export.model_file import read_model_file
from haptoflow_training.models.label_embedding import surface_phases
from haptoflow_training.training.batches import SegmentBatch, SegmentBatches
from haptoflow_training.training.config import BatchConfig, TrainingConfig, load_config
from haptoflow_training.training.recordings_source import Source
from haptoflow_training.training.trainer import build_model, planned_steps

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


@pytest.mark.parametrize("row", [row for row in load_plan(CONFIGS / "rows.toml") if row.block == "as-published"])
def test_a_rival_as_published_has_neither_ribs_nor_impulses(row: PlannedRow) -> None:
    model = load_config(CONFIGS / f"{row.model}.toml").model
    assert not model.ribs and not model.impulses


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


@pytest.mark.parametrize("name", ["transformer", "dstn", "spsi"])
def test_a_regressing_rival_cannot_be_trained_by_the_energy_distance(name: str, tmp_path: Path) -> None:
    text = f'[model]\nnetwork = "field"\narchitecture = "{name}"\n[recipe]\nenergy_steps = 5\n'
    (tmp_path / "run.toml").write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match="energy_steps.*model.sampled"):
        load_config(tmp_path / "run.toml")


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


def test_a_rival_without_ribs_has_no_lines_and_untrained_rib_lines_are_zero() -> None:
    torch.manual_seed(2)
    with_ribs = build_rival("autoregressive", ribs=True)
    assert build_rival("autoregressive").comb is None and with_ribs.comb is not None
    assert with_ribs.lines is not None
    past = torch.randn(4, 1, 200)
    lines, rest = with_ribs.lines(past, *_condition(4, speed_mps=0.4))
    assert lines.abs().max().item() == 0.0
    assert torch.equal(rest, past)


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


def _learn(baseline: Rival, steps: int) -> None:
    optimiser, generator = torch.optim.Adam(baseline.parameters(), lr=5e-3), torch.Generator().manual_seed(1)
    for step in range(steps):
        previous, segment, condition = _ribbed_texture(24, step)
        loss = baseline.loss(segment, previous, *condition, generator).mean()
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()


def _line_of(wave: Tensor, phase: Tensor) -> Tensor:
    """[B]: amplitude of the ribs' line in segments [B, 1, 200], in the surface's phase."""
    turns = 100.0 * torch.arange(200) / 2000.0 + phase[:, :1]
    return 2.0 * (wave[:, 0] * torch.cos(2.0 * math.pi * turns)).mean(dim=1)


def _learned_autoregressive(seed: int) -> AutoregressiveRival:
    """Autoregressive filters with ribs that have learned the ribbed texture."""
    torch.manual_seed(seed)
    baseline = AutoregressiveRival(ribs=True)
    _learn(baseline, 250)
    return baseline


def test_autoregressive_noise_models_the_rest_beside_the_rib_lines() -> None:
    baseline = _learned_autoregressive(seed=3)
    previous, _, condition = _ribbed_texture(256, 10_000)
    with torch.no_grad():
        made = baseline(torch.randn(256, 1, 200), previous, *condition)
        coefficients, log_gain = baseline.process(*condition[:2])
    assert _line_of(made, condition[2]).mean().item() == pytest.approx(_LINE, rel=0.1)
    # Without the lines, the prediction error would include their unpredictable part.
    assert log_gain.exp().mean().item() == pytest.approx(_DRIVE, rel=0.15)
    learned = np.concatenate([[1.0], coefficients[0].double().numpy()])
    response = [np.abs(scipy.signal.freqz([1.0], a, worN=128)[1]) for a in (_RINGING, learned)]
    assert np.abs(20.0 * np.log10(response[1] / response[0])).mean() < 1.5


def test_an_autoregressive_segment_continues_its_past_with_and_without_lines() -> None:
    baseline = _learned_autoregressive(seed=4)
    previous, segment, condition = _ribbed_texture(512, 20_000)
    with torch.no_grad():
        made = baseline(torch.randn(512, 1, 200), previous, *condition)
    jumps = [(wave[:, 0, 0] - previous[:, 0, -1]).square().mean().sqrt().item() for wave in (segment, made)]
    assert jumps[1] == pytest.approx(jumps[0], rel=0.15)


def test_the_energy_distance_trains_the_lines_and_only_the_likelihood_trains_the_filter() -> None:
    torch.manual_seed(7)
    baseline = AutoregressiveRival(ribs=True)
    previous, segment, condition = _ribbed_texture(4, 1)
    made = baseline(torch.randn(4, 1, 200), previous, *condition)
    (made - segment).square().mean().backward()
    assert baseline.lines is not None
    assert baseline.lines.gains.layers[-1].weight.grad is not None
    assert all(parameter.grad is None for parameter in baseline.perceptron.parameters())


def test_sampled_spsi_predicts_the_mean_power_and_not_the_geometric_mean() -> None:
    torch.manual_seed(5)
    baseline, generator = SpsiRival(sampled=True), torch.Generator().manual_seed(1)
    optimiser = torch.optim.Adam(baseline.parameters(), lr=3e-3)
    condition = _condition(64, 0.2)
    for step in range(120):
        noise = torch.randn(64, 1, 200, generator=torch.Generator().manual_seed(step))
        loss = baseline.loss(2.0 * noise, torch.zeros_like(noise), *condition, generator).mean()
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
    with torch.no_grad():
        made = baseline(torch.randn(64, 1, 200), torch.zeros(64, 1, 200), *condition)
    # The published form would stay 2.5 dB below.
    assert 20.0 * math.log10(made.square().mean().sqrt().item() / 2.0) == pytest.approx(0.0, abs=0.4)


@pytest.mark.parametrize("architecture", ["transformer", "dstn"])
def test_a_sampled_rival_draws_another_segment_for_other_noise(architecture: str) -> None:
    torch.manual_seed(6)
    baseline, condition = build_rival(architecture, sampled=True), _condition(2, 0.2)
    previous = torch.randn(1, 1, 200).expand(2, -1, -1)
    same = tuple(part[:1].expand(2, -1) for part in condition)
    made = baseline(torch.randn(2, 1, 200), previous, *same)
    assert (made[0] - made[1]).abs().max().item() > 1e-3


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


@pytest.mark.parametrize(("architecture", "alike"), [("autoregressive", True), ("transformer", False)])
def test_a_likelihood_counts_a_burst_like_any_other_segment_and_a_squared_error_does_not(
    architecture: str, alike: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    config = evaluated(TrainingConfig(), model={"network": "field", "architecture": architecture})
    model = build_model(config, WAVE_VECTORS)
    batch = SegmentBatches(make_store(), "train", BatchConfig(), 3).draw(6)
    batch.segment[0] *= 1e5
    with torch.no_grad():
        # All rows are heard.
        model.level.power_law.bias[0] = 3.0
    rows = torch.tensor([6.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    monkeypatch.setattr(model.field, "loss", lambda *_: rows)
    _, field = EvaluatedLosses(model, config.solver)(batch, "own", torch.Generator().manual_seed(1))
    assert (field.item() == pytest.approx(1.0, rel=1e-3)) == alike
    assert alike or field.item() < 0.01


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("autoregressive", ["level", "filter", "own", "level"]),
        ("ar-ribs", ["level", "filter", "own", "energy", "energy", "level"]),
    ],
)
def test_an_autoregressive_filter_begins_at_burg_s_estimates_as_the_product_s(name: str, expected: list[str]) -> None:
    assert [phase.objective for phase in EvaluatedTrainer.phases(load_config(CONFIGS / f"{name}.toml"))] == expected


@pytest.mark.parametrize("ribs", [False, True])
def test_an_autoregressive_likelihood_begins_within_the_segment(ribs: bool) -> None:
    baseline, (previous, segment, condition) = AutoregressiveRival(ribs=ribs), _ribbed_texture(4, 5)
    generator = torch.Generator()
    found = [
        baseline.loss(segment, past, *condition, generator) for past in (previous, torch.zeros_like(previous), 9.0 * previous)
    ]
    assert torch.equal(found[0], found[1]) and torch.equal(found[0], found[2])


def _autoregressive_losses(ribs: bool) -> tuple[EvaluatedModel, EvaluatedLosses]:
    """Over a level that falls to nothing at rest."""
    torch.manual_seed(8)
    config = evaluated(TrainingConfig(), model={"network": "field", "architecture": "autoregressive", "ribs": ribs})
    model = build_model(config, WAVE_VECTORS)
    assert isinstance(model, EvaluatedModel)
    with torch.no_grad():
        model.level.power_law.weight.zero_()
        model.level.power_law.bias.copy_(torch.tensor([3.0, 4.0, 0.0]))
    return model, EvaluatedLosses(model, config.solver)


def _half_at_rest() -> SegmentBatch:
    batch = SegmentBatches(make_store(), "train", BatchConfig(), 3).draw(8)
    moving = torch.tensor([0.0, 1.0] * 4)
    return dataclasses.replace(
        batch,
        motion=batch.motion * moving[:, None],
        motion_path=batch.motion_path * moving[:, None, None],
        segment=batch.segment * moving.clamp(min=1e-6)[:, None, None],
    )


def _field_loss(losses: EvaluatedLosses, batch: SegmentBatch, objective: str) -> float:
    return losses(batch, objective, torch.Generator().manual_seed(1))[1].item()


@pytest.mark.parametrize("objective", ["filter", "own"])
def test_silence_weighs_nothing_in_the_fit_of_an_autoregressive_filter(objective: str) -> None:
    _, losses = _autoregressive_losses(ribs=False)
    batch = _half_at_rest()
    found = [_field_loss(losses, batch, objective)]
    for rows in (slice(0, 8, 2), slice(1, 8, 2)):
        segment = batch.segment.clone()
        segment[rows] = 0.7 * segment[rows].roll(1, dims=2) + 0.3 * segment[rows]
        found.append(_field_loss(losses, dataclasses.replace(batch, segment=segment), objective))
    assert found[1] == pytest.approx(found[0], rel=1e-4) and found[2] != pytest.approx(found[0], rel=1e-3)


@pytest.mark.parametrize(("objective", "called"), [("own", "loss"), ("filter", "filter_distance")])
def test_an_autoregressive_filter_is_fitted_over_the_skeletons_noise_floor_and_for_the_motion_amid(
    objective: str, called: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    model, losses = _autoregressive_losses(ribs=False)
    batch = SegmentBatches(make_store(), "train", BatchConfig(), 3).draw(64)
    seen: list[tuple[Tensor, ...]] = []
    monkeypatch.setattr(model.field, called, lambda *given: seen.append(given) or torch.zeros(64))
    silent = dataclasses.replace(batch, segment=torch.zeros_like(batch.segment))
    _field_loss(losses, silent, objective)
    log_level = model.level(model.embedding(batch.label, batch.specimen), batch.motion)
    floor = (0.005 * torch.exp(-log_level)).clamp(max=10.0 ** (-45.0 / 20.0))
    assert (seen[0][0].std(dim=2) / floor).mean().item() == pytest.approx(1.0, abs=0.02)
    motion = seen[0][3 if called == "loss" else 2]
    torch.testing.assert_close(motion, batch.motion_path[:, 3 if called == "loss" else 5], rtol=0.0, atol=0.0)


@pytest.mark.parametrize("ribs", [False, True])
def test_burg_s_estimates_of_moving_ribs_count_for_a_rival_without_lines_only(ribs: bool) -> None:
    _, losses = _autoregressive_losses(ribs)
    batch = SegmentBatches(make_store(), "train", BatchConfig(), 3).draw(16)
    ribbed = (batch.label == 0)[:, None, None]
    assert ribbed.any() and not ribbed.all() and WAVE_VECTORS[0] and not WAVE_VECTORS[1]
    noise = torch.randn(batch.segment.shape, generator=torch.Generator().manual_seed(3))
    other = dataclasses.replace(batch, segment=torch.where(ribbed, noise, batch.segment))
    before, after = (_field_loss(losses, each, "filter") for each in (batch, other))
    assert (before == pytest.approx(after, rel=1e-6)) == ribs


def test_burg_s_estimates_move_an_autoregressive_filter_to_a_process() -> None:
    torch.manual_seed(9)
    baseline, condition = AutoregressiveRival(), _condition(24, 0.2)[:2]
    optimiser, truth = torch.optim.Adam(baseline.parameters(), lr=5e-3), [np.abs(scipy.signal.freqz([1.0], _RINGING, 128)[1])]
    source = np.random.default_rng(10)

    def error_db() -> float:
        with torch.no_grad():
            coefficients, log_gain = (part[0].double().numpy() for part in baseline.process(*condition))
        response = np.abs(scipy.signal.freqz([np.exp(log_gain[0])], np.concatenate([[1.0], coefficients]), 128)[1])
        level = np.sqrt(np.square(truth[0]).mean())
        return float(np.abs(20.0 * np.log10(response / truth[0] * level)).mean())

    untrained = error_db()
    for _ in range(150):
        wave = scipy.signal.lfilter([1.0], _RINGING, source.standard_normal((24, 700)))[:, 500:]
        segment = torch.from_numpy(wave / np.sqrt(np.square(truth[0]).mean())).float().unsqueeze(1)
        optimiser.zero_grad()
        baseline.filter_distance(segment, *condition).mean().backward()
        optimiser.step()
    assert error_db() < 1.5 < 3.0 < untrained


def test_the_energy_distance_compares_a_rival_s_rib_lines_as_our_network_s() -> None:
    model = build_model(_shortened("ar-ribs"), WAVE_VECTORS)
    assert model.field.comb is not None
