"""Training of a skeleton and of its refinement: losses, phases, resuming, the files that they become."""

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
from paper_samples import field_config
from test_trainer import ALONE, _config, ask_to_stop_after
from training_fixtures import FakeStore, make_store, travelled_mm

from haptoflow_paper.runs.trainer import EvaluatedTrainer
from haptoflow_training.training.level_calibration import TierSource
from haptoflow_training.training.closed_loop import SurfaceStatistics, run_closed_loop
from haptoflow_training.errors import InputError
from haptoflow_training.export.exporter import export_run
from haptoflow_training.recordings.landing import LabelInfo, RibWander, StickSlip
from haptoflow_training.export.model_file import ModelFile, read_model_file
from haptoflow_training.export.trained_tier import load_tiers
from haptoflow_training.models.haptoflow_model import SkeletonModel
from haptoflow_training.models.label_embedding import path_of
from haptoflow_training.models.skeleton import NOISE_BEFORE, SkeletonGains
from haptoflow_training.training import losses as skeleton_losses
from haptoflow_training.training.batches import SegmentBatch, SegmentBatches
from haptoflow_training.training.config import BatchConfig, ModelConfig, RecipeConfig, TrainingConfig
from haptoflow_training.training.recordings_source import Source
from haptoflow_training.training.losses import SkeletonLosses
from haptoflow_training.training.trainer import Trainer, TrainingStopped, build_model, load_trained

WAVE_VECTORS = [[(0.5, 0.0)], []]
WANDERING = [
    LabelInfo("tone", "metal", 900.0, 0.3, 0.002, ((0.5, 0.0),), rib_wander=(RibWander(0.1, 0.014),)),
    LabelInfo("noise", "stone", 1500.0, 0.6, stick_slip=StickSlip(0.0011, 0.25, 0.004)),
]


def _store() -> FakeStore:
    """Recordings of three specimens of each label."""
    store = make_store(seconds=6.0, recordings_per_split=4)
    told = [dataclasses.replace(each, specimen=number % 3) for number, each in enumerate(store.recordings)]
    return dataclasses.replace(store, recordings=told)


def _sketch(steps: int = 6) -> TrainingConfig:
    recipe = RecipeConfig(filter_steps=3, energy_steps=4, energy_batch_size=6, self_forcing_steps=2)
    return dataclasses.replace(
        _config(steps=steps), tier="sketch", model=ModelConfig(network="skeleton", hidden=(16, 16)), recipe=recipe
    )


def _refinement(tier: str = "standard", levels: int = 2) -> TrainingConfig:
    config = _sketch(steps=0)
    return dataclasses.replace(
        config,
        tier=tier,
        model=ModelConfig(network="refinement", hidden=(16, 16), width=16, previous_width=8, levels=levels),
        recipe=dataclasses.replace(config.recipe, filter_steps=0, shares_base=True),
    )


@pytest.fixture(scope="module")
def store() -> FakeStore:
    return _store()


@pytest.fixture(scope="module")
def runs(tmp_path_factory: pytest.TempPathFactory, store: FakeStore) -> Path:
    """A folder with runs of a sketch, a draft and a standard tier."""
    folder = tmp_path_factory.mktemp("runs")
    Trainer(_sketch(), store, folder / "sketch", ALONE, wave_vectors=WAVE_VECTORS).run()
    for tier, levels in (("draft", 1), ("standard", 2)):
        config = _refinement(tier, levels)
        Trainer(config, store, folder / tier, ALONE, folder / "sketch", WAVE_VECTORS).run()
    return folder


@pytest.fixture(scope="module")
def exported(runs: Path, store: FakeStore) -> ModelFile:
    source = Source(store, WANDERING, PROVENANCE)  # type: ignore[arg-type]
    further = [runs / "sketch", runs / "draft"]
    export_run(runs / "standard", source, runs / "m.haptoflow", runs / "parity.json", further)
    return read_model_file(runs / "m.haptoflow")


def test_training_moves_the_skeleton_and_its_specimens_and_a_refinement_leaves_both_as_they_are(runs: Path) -> None:
    sketch, standard = (load_trained(runs / name)[2] for name in ("sketch", "standard"))
    assert isinstance(sketch, SkeletonModel) and isinstance(standard, SkeletonModel)
    assert sketch.embedding.pieces is not None and sketch.embedding.pieces.abs().max() > 0.0
    assert sketch.skeleton.perceptron.layers[-1].weight[60:].abs().max() > 0.0, "lines and impulses began at zero"
    assert sketch.skeleton.perceptron.layers[-1].weight[24, 16:].abs().max() > 0.0, "so did the second one's share of the gain"
    for part in ("embedding", "level", "skeleton"):
        own, base = (getattr(model, part).state_dict() for model in (standard, sketch))
        assert all(torch.equal(own[name], base[name]) for name in base), part
    assert standard.refiner is not None and standard.refiner.leave.weight.abs().max() > 0.0


@pytest.mark.parametrize("tier", ["sketch", "standard"])
def test_a_resumed_run_ends_with_the_weights_of_an_uninterrupted_one(
    tier: str, runs: Path, store: FakeStore, tmp_path: Path
) -> None:
    config, base = (_sketch(), None) if tier == "sketch" else (_refinement(), runs / "sketch")

    def trainer() -> Trainer:
        return Trainer(config, store, tmp_path, ALONE, base, WAVE_VECTORS)

    interrupted = trainer()
    ask_to_stop_after(interrupted, 29 if tier == "sketch" else 3)
    with pytest.raises(TrainingStopped):
        interrupted.run()
    trainer().run()
    whole, halves = (load_trained(folder)[2].state_dict() for folder in (runs / tier, tmp_path))
    for name, weights in whole.items():
        torch.testing.assert_close(halves[name], weights, msg=name)


def test_a_base_without_a_skeleton_is_refused_for_a_refinement_with_the_remedy(
    tmp_path: Path, store: FakeStore
) -> None:
    EvaluatedTrainer(field_config(steps=2), store, tmp_path / "field", ALONE).run()
    with pytest.raises(InputError, match="field: has no skeleton; name a run whose model.network is 'skeleton'"):
        Trainer(_refinement(), store, tmp_path / "run", ALONE, tmp_path / "field")


def test_tiers_with_and_without_a_skeleton_do_not_share_a_file(runs: Path, tmp_path: Path, store: FakeStore) -> None:
    config = dataclasses.replace(field_config(steps=2), tier="draft")
    EvaluatedTrainer(config, store, tmp_path / "field", ALONE, wave_vectors=WAVE_VECTORS).run()
    with pytest.raises(InputError, match="with a skeleton and tiers without do not share a file"):
        load_tiers([runs / "sketch", tmp_path / "field"])


def test_the_sketch_comes_first_and_tiers_state_their_kinds(exported: ModelFile) -> None:
    tiers = exported.header["tiers"]
    assert [(tier["name"], tier["kind"]) for tier in tiers] == [
        ("sketch", "skeleton"), ("draft", "refine"), ("standard", "refine"),
    ]  # fmt: skip
    assert set(tiers[0]) == {"name", "kind", "parameters", "accuracy", "cost"}
    assert tiers[1]["field"] == "draft.field" and "level" not in tiers[1] and "solver" not in tiers[1]
    assert exported.header["default_tier"] == "standard"
    assert exported.header["skeleton"]["parameters"] == tiers[0]["parameters"]


def test_the_file_of_a_skeleton_has_its_tensors_and_no_level_graph(exported: ModelFile) -> None:
    layers = [f"{layer}.{kind}" for layer in (0, 2, 4) for kind in ("weight", "bias")]
    perceptrons = ("level.correction", "skeleton", "draft.condition", "standard.condition")
    assert set(exported.tensors) == {
        "embedding", "pieces", "level.law.weight", "level.law.bias",
        *(f"{name}.{layer}" for name in perceptrons for layer in layers),
    }  # fmt: skip
    assert "seed_bank" not in exported.header
    assert exported.tensors["pieces"].shape == (2, 3, 60)
    assert set(exported.graphs) == {"draft.field", "standard.field"}
    graph = onnx.load_from_string(exported.graphs["draft.field"])
    shapes = {
        value.name: [size.dim_value for size in value.type.tensor_type.shape.dim][1:] for value in graph.graph.input
    }
    assert {name: shape for name, shape in shapes.items() if name != "film"} == {
        "entering": [12, 1, 200], "past": [1, 1, 200], "own": [1, 1, 200],
    }  # fmt: skip
    assert list(shapes) == ["entering", "past", "own", "film"]
    assert [value.name for value in graph.graph.output] == ["correction"]


@pytest.mark.parametrize(("hidden", "fits"), [((16, 16), True), ((32,), True), ((8, 24), False)])
def test_a_file_s_perceptron_is_read_as_the_two_that_it_was_or_as_one(
    hidden: tuple[int, ...], fits: bool, exported: ModelFile, runs: Path, store: FakeStore, tmp_path: Path
) -> None:
    assert exported.header["skeleton"]["hidden"] == 32
    config = dataclasses.replace(_sketch(), model=ModelConfig(network="skeleton", hidden=hidden))
    given = (config, store, tmp_path, ALONE)
    if not fits:
        with pytest.raises(InputError, match="'skeleton.perceptron.layers.2.weight' does not fit; begin with its"):
            Trainer(*given, wave_vectors=WAVE_VECTORS, start=runs / "m.haptoflow")
        return
    begun = Trainer(*given, wave_vectors=WAVE_VECTORS, start=runs / "m.haptoflow").model
    trained = load_trained(runs / "sketch")[2]
    assert isinstance(begun, SkeletonModel) and isinstance(trained, SkeletonModel)
    for name, weights in trained.skeleton.state_dict().items():
        torch.testing.assert_close(begun.skeleton.state_dict()[name], weights, msg=name)


def test_labels_state_how_their_ribs_wander_and_how_they_slip(exported: ModelFile) -> None:
    ruled, slipping = exported.header["labels"]
    assert ruled["rib_wander"] == [{"turns": 0.1, "wavelength_metres": 0.014}] and "stick_slip" not in ruled
    assert slipping["stick_slip"] == {"length_metres": 0.0011, "wander": 0.25, "wander_metres": 0.004}
    assert "rib_wander" not in slipping
    of_file = SurfaceStatistics.of_entries(exported.header["labels"])
    of_labels = SurfaceStatistics.of_labels(WANDERING)
    for one, other in zip(dataclasses.astuple(of_file), dataclasses.astuple(of_labels), strict=True):
        np.testing.assert_allclose(one, other)


@pytest.mark.parametrize("name", ["sketch", "standard"])
def test_a_skeleton_and_a_refinement_sound_in_closed_loop(name: str, runs: Path) -> None:
    source = TierSource(load_tiers([runs / name])[0])
    motions = np.tile(np.array([0.1, 0.0, 1.0], dtype=np.float32), (2, 1000, 1))
    labels, statistics = np.arange(2), SurfaceStatistics.of_labels(WANDERING)
    run = run_closed_loop(source, source.embeddings, motions, labels, statistics, update_rate_hz=72.0, seed=1)
    assert np.isfinite(run.waves).all() and (run.waves.std(axis=1) > 0.0).all()
    often = run_closed_loop(source, source.embeddings, motions, labels, statistics, update_rate_hz=200.0, seed=1)
    # At a constant motion a skeleton alone is one stream, however often it is handed over; phases round differently.
    apart = np.abs(often.waves - run.waves).max(axis=1) / run.waves.std(axis=1)
    assert name != "sketch" or apart.max() < 0.02


def test_in_a_chain_the_skeleton_continues_itself_whatever_the_network_adds(store: FakeStore) -> None:
    torch.manual_seed(4)
    refined = build_model(_refinement(), WAVE_VECTORS)
    assert isinstance(refined, SkeletonModel) and refined.refiner is not None
    torch.nn.init.normal_(refined.refiner.leave.weight, std=0.2)
    torch.nn.init.normal_(refined.skeleton.perceptron.layers[-1].bias[139:], std=0.3)
    three = BatchConfig(chain_hops=(3, 3))
    chain = SegmentBatches(store, "train", three, 4).draw_chains(4).chain  # type: ignore[arg-type]
    assert chain is not None
    embedding = refined.embedding(torch.tensor([0, 1, 0, 1])).detach()

    def rendered() -> tuple[torch.Tensor, torch.Tensor]:
        generator = torch.Generator().manual_seed(1)
        return SkeletonLosses(refined).render_chain(chain, embedding, "energy", generator)

    (played, own), noise = rendered()[0].unbind(dim=1), rendered()[1]
    torch.nn.init.zeros_(refined.refiner.leave.weight)
    alone, same_noise = rendered()
    assert torch.equal(own, alone[:, 1]) and torch.equal(alone[:, 0], alone[:, 1])
    rendered_samples = 3 * chain.hop_samples
    assert (played - own)[:, -min(200, rendered_samples) :].abs().max() > 0.01 * own.std()
    assert noise.shape == (4, 1, NOISE_BEFORE) and torch.equal(noise, same_noise)


def test_both_draws_after_a_chain_hear_its_impulses_ring_and_those_after_a_recording_do_not(store: FakeStore) -> None:
    _, losses, _ = _losses_and_batch(store)
    generator = torch.Generator().manual_seed(1)
    batches = SegmentBatches(store, "train", BatchConfig(), 4)  # type: ignore[arg-type]
    for batch in (batches.draw(6), batches.draw_chains(6)):
        given = losses._scaled(batch, "energy", generator)
        first, second = given.noise_before.chunk(2)
        assert torch.equal(first, second) == (batch.chain is not None)
        assert given.previous.shape == (6, 2, 200) and first.shape == (6, 1, NOISE_BEFORE)
        noise, *drawn = losses.two_draws(given, generator)
        assert torch.equal(noise[:, :, :NOISE_BEFORE], first) and not torch.equal(*drawn)


def test_the_energy_distance_moves_neither_the_filter_s_perceptron_nor_the_embedding(
    monkeypatch: pytest.MonkeyPatch, store: FakeStore
) -> None:
    model, losses, batch = _losses_and_batch(store)
    for likelihood in ("likelihood", "tail_likelihood"):
        monkeypatch.setattr(model.skeleton, likelihood, lambda segment, gains, phases: torch.zeros(len(segment)))
    losses(batch, "energy", torch.Generator().manual_seed(6))[1].backward()
    layers = [model.skeleton.perceptron.layers[layer].weight.grad for layer in (0, 2, 4)]
    assert all(layer is not None for layer in layers)
    assert not any((layers[0][:16].any(), layers[1][:16].any(), layers[2][:24].any(), layers[2][:, :16].any()))
    assert layers[2][24, 16:].any() and layers[2][139:, 16:].any(), "it moves the noise's gain and impulses"
    learnt = model.embedding.learnt.weight.grad
    assert learnt is None or not learnt.any()


def _shift_loss(monkeypatch: pytest.MonkeyPatch, store: FakeStore, *, trained: bool) -> float:
    """What the term for shifts adds to the loss of a refinement over a skeleton with swing and lines, without impulses."""
    torch.manual_seed(4)
    model = build_model(_refinement(), WAVE_VECTORS, specimens=3)
    assert isinstance(model, SkeletonModel) and model.refiner is not None
    torch.nn.init.normal_(model.skeleton.perceptron.layers[-1].bias[25:139], std=0.3)
    if trained:
        torch.nn.init.normal_(model.refiner.leave.weight, std=0.2)
    losses = SkeletonLosses(model, train_level=False)
    batch = SegmentBatches(store, "train", BatchConfig(), 5).draw(8)  # type: ignore[arg-type]
    found = []
    for weight in (0.0, 1.0):
        monkeypatch.setattr(skeleton_losses, "_SHIFT_WEIGHT", weight)
        found.append(losses(batch, "energy", torch.Generator().manual_seed(6))[1].item())
    return found[1] - found[0]


def test_the_term_for_shifts_is_zero_for_a_skeleton_alone_and_positive_for_a_network_of_patches(
    monkeypatch: pytest.MonkeyPatch, store: FakeStore
) -> None:
    assert _shift_loss(monkeypatch, store, trained=False) == pytest.approx(0.0, abs=5e-3)
    assert _shift_loss(monkeypatch, store, trained=True) > 0.05


# Two resonances, at 180 and 520 Hz.
RINGING = np.poly([0.9 * np.exp(0.18j * np.pi), 0.9 * np.exp(-0.18j * np.pi),
                   0.8 * np.exp(0.52j * np.pi), 0.8 * np.exp(-0.52j * np.pi)]).real  # fmt: skip


def _ringing_store() -> FakeStore:
    """The label without ribs rings, at one speed and force; the other label, whose ribs move, is white noise."""
    store, generator = _store(), np.random.default_rng(11)
    waveform, motion = store.waveform.copy(), np.zeros_like(store.motion)
    motion[:] = (0.1, 0.0, 1.0)
    for each in store.recordings:
        noise = generator.standard_normal(each.length + 500)
        wave = noise[500:] if each.label_index == 0 else scipy.signal.lfilter([1.0], RINGING, noise)[500:]
        waveform[each.start : each.start + each.length] = wave / wave.std() / store.peak_mps2
    return dataclasses.replace(store, waveform=waveform, motion=motion, position_mm=travelled_mm(motion))


def _response_db(numerator: float, coefficients: np.ndarray) -> np.ndarray:
    return np.asarray(20.0 * np.log10(np.abs(scipy.signal.freqz([numerator], coefficients, 128)[1])))


def _spectrum_error_db(model: SkeletonModel) -> float:
    """Mean distance of the spectrum of the label without ribs from that of its recordings."""
    with torch.no_grad():
        given = model.embedding(torch.tensor([1])), torch.tensor([[0.1, 0.0, 1.0]]), torch.zeros(1, 6)
        gains = model.skeleton.gains(*given)
    coefficients = np.concatenate([[1.0], gains.coefficients[0].double().numpy()])
    made, true = _response_db(gains.log_gain.exp().item(), coefficients), _response_db(1.0, RINGING)
    level = 10.0 * np.log10(np.mean(10.0 ** (true / 10.0)))
    return float(np.abs(made - (true - level)).mean())


def test_the_phase_filter_moves_a_random_skeleton_to_the_spectrum_of_an_all_pole_recording(tmp_path: Path) -> None:
    config = _sketch(steps=0)
    config = dataclasses.replace(
        config,
        recipe=RecipeConfig(filter_steps=250),
        optimiser=dataclasses.replace(
            config.optimiser, level_steps=100, level_polish_steps=0, batch_size=16, learning_rate=5e-3
        ),
    )
    trainer = Trainer(config, _ringing_store(), tmp_path, ALONE, wave_vectors=WAVE_VECTORS)
    untrained = _spectrum_error_db(trainer.model)
    trainer.run()
    assert [phase.name for phase in trainer.phases(config)] == ["level", "filter"]
    # Means of estimates from 100 ms are flatter than the recording's spectrum.
    assert _spectrum_error_db(load_trained(tmp_path)[2]) < 1.5 < 3.0 < untrained


def _losses_and_batch(store: FakeStore) -> tuple[SkeletonModel, SkeletonLosses, SegmentBatch]:
    torch.manual_seed(4)
    model = build_model(_sketch(), WAVE_VECTORS, specimens=3)
    assert isinstance(model, SkeletonModel)
    batch = SegmentBatches(store, "train", BatchConfig(), 5).draw(16)  # type: ignore[arg-type]
    return model, SkeletonLosses(model), batch


def test_reversals_do_not_teach_the_level_that_slow_motion_is_loud(store: FakeStore) -> None:
    model, losses, batch = _losses_and_batch(store)
    path = torch.zeros(16, 11, 3)
    path[:, :, 0], path[:, :, 2] = 0.01, 1.0
    # Reversals: from -0.2 to 0.2 m/s within the level's window, and to 0.6 m/s at the segment's end.
    path[8:, :, 0] = torch.linspace(-0.2, 0.6, 11)
    slow = torch.tensor([[0.01, 0.0, 1.0]]).expand(16, 3)
    power = torch.full((16, 1), 0.01)
    power[8:] = 0.25
    mixed = dataclasses.replace(batch, motion_path=path, level_motion=slow, level_mean_square_mps2=power)
    optimiser = torch.optim.Adam(model.level.parameters(), lr=1e-2)
    for _ in range(300):
        optimiser.zero_grad()
        losses.level_loss(mixed).backward()
        optimiser.step()
    learnt = model.level(model.embedding(batch.label, batch.specimen), slow)[:8]
    assert (20.0 / math.log(10.0) * (learnt - math.log(0.1))).abs().max() < 0.3
    trembling = torch.full((1, 6, 3), 0.0)
    trembling[0, :, 0] = torch.tensor([0.009, 0.011, 0.01, 0.009, 0.011, 0.01])
    assert skeleton_losses.steady_speed(trembling) > 0.8


def _loss(losses: SkeletonLosses, batch: SegmentBatch, objective: str) -> float:
    return losses(batch, objective, torch.Generator().manual_seed(6))[1].item()


def _with_noise(batch: SegmentBatch, rows: torch.Tensor) -> SegmentBatch:
    """The batch with noise of another spectrum in these rows, about as loud."""
    other = 0.7 * batch.segment.roll(1, dims=2) - 0.5 * batch.segment.roll(3, dims=2)
    return dataclasses.replace(batch, segment=torch.where(rows[:, None, None], other, batch.segment))


def test_the_phase_filter_leaves_out_rows_whose_ribs_move(store: FakeStore) -> None:
    _, losses, batch = _losses_and_batch(store)
    ribbed = batch.label == 0
    assert ribbed.any() and not ribbed.all()
    known = _loss(losses, batch, "filter")
    assert known > 0.0 and _loss(losses, _with_noise(batch, ribbed), "filter") == pytest.approx(known, rel=1e-6)
    assert _loss(losses, _with_noise(batch, ~ribbed), "filter") != pytest.approx(known, rel=1e-3)
    likelihood = _loss(losses, batch, "likelihood")
    assert _loss(losses, _with_noise(batch, ribbed), "likelihood") != pytest.approx(likelihood, rel=1e-5)


@pytest.mark.parametrize("objective", ["filter", "likelihood"])
def test_silence_has_no_weight_in_the_fit_of_a_filter(objective: str, store: FakeStore) -> None:
    model, losses, batch = _losses_and_batch(store)
    with torch.no_grad():
        # Nothing at rest.
        model.level.power_law.weight.zero_()
        model.level.power_law.bias.copy_(torch.tensor([3.0, 4.0, 0.0]))
    moving = torch.arange(16) % 4 != 0
    moving[torch.where(batch.label == 1)[0][0]] = False
    assert (moving & (batch.label == 1)).any()
    share = moving.to(batch.motion.dtype)
    still = dataclasses.replace(
        batch,
        motion=batch.motion * share[:, None],
        motion_path=batch.motion_path * share[:, None, None],
        segment=torch.where(moving[:, None, None], batch.segment, 1e-6 * batch.segment),
    )
    known = _loss(losses, still, objective)
    assert _loss(losses, _with_noise(still, ~moving), objective) == pytest.approx(known, rel=1e-4)
    assert _loss(losses, _with_noise(still, moving), objective) != pytest.approx(known, rel=1e-2)


def test_a_filter_is_fitted_for_the_motion_and_the_rates_amid_its_part_of_the_segment(store: FakeStore) -> None:
    model, losses, batch = _losses_and_batch(store)
    given = losses._scaled(batch, "energy", torch.Generator().manual_seed(2))
    embedding, motion, phases = losses._condition_at(given, 56)
    torch.testing.assert_close(motion, batch.motion_path[:, 3], rtol=0.0, atol=0.0)
    assert embedding is given.embedding and not torch.equal(motion, batch.motion)
    turns = path_of(phases)
    found = 1000.0 * (turns[:, :, 57] - turns[:, :, 55])
    torch.testing.assert_close(phases[:, 3:6], found, rtol=0.0, atol=0.02)
    torch.testing.assert_close(phases[:, :3], given.phases[:, :3], rtol=0.0, atol=0.0)
    with torch.no_grad():
        before = losses.field_loss(given, "likelihood", torch.Generator().manual_seed(3))
        moved = dataclasses.replace(batch, motion_path=batch.motion_path.roll(1, dims=0))
        other = losses.field_loss(dataclasses.replace(given, batch=moved), "likelihood", torch.Generator().manual_seed(3))
    assert before != other


def test_in_training_ribs_are_where_they_are_at_every_sample(store: FakeStore) -> None:
    model, losses, batch = _losses_and_batch(store)
    phases = losses.phases(batch, model.embedding(batch.label))
    ribbed = torch.where(batch.label == 0)[0]
    middle = 0.5 * (batch.position_path_mm[:, 1:] + batch.position_path_mm[:, :-1])
    turns = 0.5 * middle[ribbed, :, 0].double()
    away = path_of(phases)[ribbed, 0].double() - turns
    assert (away - away.round()).abs().max() < 2e-3, "whole turns are left out"
    assert (away.round() == away.round()[:, :1]).all(), "at the beginning only"
    steady = phases[ribbed, :1] + phases[ribbed, 3:4] * (torch.arange(200) + 0.5) / 2000.0
    assert (path_of(phases)[ribbed, 0, 0] - steady[:, 0]).abs().max() < 0.02


def test_a_skeleton_keeps_its_likelihood_in_the_energy_phase(monkeypatch: pytest.MonkeyPatch, store: FakeStore) -> None:
    torch.manual_seed(4)
    model = build_model(_sketch(), WAVE_VECTORS, specimens=3)
    assert isinstance(model, SkeletonModel)
    losses = SkeletonLosses(model)
    batch = SegmentBatches(store, "train", BatchConfig(), 5).draw(8)  # type: ignore[arg-type]
    filtering = slice(0, 25)
    for objective in ("likelihood", "energy"):
        model.zero_grad()
        losses(batch, objective, torch.Generator().manual_seed(6))[1].backward()
        weight = model.skeleton.perceptron.layers[-1].weight
        assert weight.grad is not None and weight.grad[filtering].abs().max() > 0.0
        # The likelihood of tails moves them, if they are there.
        assert weight.grad[139:].abs().max() > 0.0


def test_impulses_as_strong_as_recorded_are_best_for_what_drives_a_resonating_filter(store: FakeStore) -> None:
    model, losses, batch = _losses_and_batch(store)
    skeleton, generator = model.skeleton, torch.Generator().manual_seed(8)
    raw = torch.zeros(1, 25)
    raw[0, :2] = torch.tensor([1.2, -1.4])
    coefficients, log_gain = skeleton.predicted(raw)
    still = skeleton.gains(torch.zeros(1, 64), torch.zeros(1, 3), torch.zeros(1, 6))
    kernels = torch.zeros(2, 5, 13)
    kernels[:, 1:3, 0] = 0.25

    def gains(strength: float) -> SkeletonGains:
        impulses = strength * kernels.reshape(1, -1)
        known = still._replace(coefficients=coefficients, log_gain=log_gain, log_drive=log_gain, impulses=impulses)
        return SkeletonGains(*(part.detach().expand(512, *part.shape[1:]) for part in known))

    def drawn(strength: float) -> torch.Tensor:
        noise = torch.randn(512, 1, NOISE_BEFORE + 200, generator=generator)
        return skeleton.parts(noise, torch.zeros(512, 1, 200), gains(strength), torch.zeros(512, 6)).segment

    given = losses._scaled(batch, "energy", generator)
    recorded = dataclasses.replace(
        given, segment=drawn(1.0), recorded_previous=torch.zeros(512, 1, 200), unsteadiness=torch.zeros(512)
    )
    found = [
        losses._driving_loss(
            recorded,
            [losses._driving(each, gains(1.0)) for each in (recorded.segment, drawn(strength), drawn(strength))],
        ).item()
        for strength in (0.0, 1.0, 2.0)
    ]
    assert found[1] < min(found[0], found[2]) - 0.02


SMALL_BASE = """
name = "small"
tier = "sketch"
threads = 1
[data]
source = "folders"
[model]
network = "skeleton"
hidden = [8, 8]
[optimiser]
batch_size = 4
level_steps = 2
steps = 2
level_polish_steps = 0
warm_up_steps = 1
[batch]
machine_share = 1.0
[recipe]
filter_steps = 2
energy_steps = 1
self_forcing_steps = 1
energy_batch_size = 2
"""
SMALL_STANDARD = """
extends = "base.toml"
tier = "standard"
[model]
network = "refinement"
width = 8
previous_width = 4
levels = 1
[optimiser]
steps = 0
[recipe]
filter_steps = 0
shares_base = true
"""
