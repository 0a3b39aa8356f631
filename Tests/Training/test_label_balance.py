"""The loss on mean spectra and moments by label and speed: its value, and what it trains."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable
from pathlib import Path

import pytest
import torch

from haptoflow_paper.runs.flow_matching import flow_matching_loss, solve
from haptoflow_paper.runs.trainer import EvaluatedTrainer
from haptoflow_training.errors import InputError
from haptoflow_training.export.trained_tier import load_tiers, tier_of
from haptoflow_training.models.rib_comb import PARTIALS
from haptoflow_training.training.batches import SegmentBatch, SegmentBatches
from haptoflow_training.training.config import BatchConfig, ModelConfig, RecipeConfig
from haptoflow_training.training.energy_distance import (
    FEATURES, LabelBalance, LabelFeatures, energy_distance_loss, envelopes, label_features, spectra
)
from haptoflow_training.training.losses import Losses
from haptoflow_training.training.trainer import Trainer, build_model, load_trained, planned_steps
from paper_samples import field_config
from test_trainer import ALONE, _config
from training_fixtures import make_store

ROWS = 32


def _features(wave: torch.Tensor, ribs_hz: tuple[float, float] = (0.0, 0.0)) -> LabelFeatures:
    """Features of waveforms [B, 400]."""
    nothing = torch.zeros(len(wave), 2, PARTIALS)
    ribs = torch.tensor([ribs_hz] * len(wave))
    heard = spectra(wave[:, :200], wave[:, 200:])
    return label_features(heard, ribs, nothing, nothing[:, 0], wave[:, 200:])


def test_moments_of_what_drives_a_filter_count_where_it_is_known_and_are_those_of_that_waveform() -> None:
    wave = torch.randn(3, 400, generator=torch.Generator().manual_seed(9))
    nothing = torch.zeros(3, 2, PARTIALS)
    heard = spectra(wave[:, :200], wave[:, 200:])
    known, unknown = (
        label_features(heard, nothing[:, 0, :2], nothing, nothing[:, 0], wave[:, 200:], driving)
        for driving in (3.0 * wave[:, 240:], None)
    )
    assert (known.counted[:, -4:] == 1.0).all() and (unknown.counted[:, -4:] == 0.0).all()
    assert torch.equal(known.values[:, :-4], unknown.values[:, :-4])
    torch.testing.assert_close(known.values[:, -4], 3.0 * wave[:, 240:].abs().mean(dim=1))
    torch.testing.assert_close(known.values[:, -3], 27.0 * wave[:, 240:].abs().pow(3.0).mean(dim=1))


def _noise(generator: torch.Generator, shape: torch.Tensor) -> torch.Tensor:
    """Rows of noise, [B, 400], with magnitudes [B, 201]."""
    return torch.fft.irfft(torch.fft.rfft(torch.randn(len(shape), 400, generator=generator)) * shape, 400)


def _heard(
    balance: LabelBalance, label: torch.Tensor, speed_mps: float, recorded: torch.Tensor, *drawn: torch.Tensor
) -> torch.Tensor:
    first, second = (_features(wave) for wave in drawn)
    speeds = torch.full(label.shape, speed_mps)
    return balance.loss(label, speeds, _features(recorded), (first, second), torch.ones(len(label)))


def test_the_balance_loss_is_half_the_squared_log_error_and_its_gradient_is_the_batch_s_share() -> None:
    balance, generator = LabelBalance(1), torch.Generator().manual_seed(2)
    label, flat = torch.zeros(ROWS, dtype=torch.long), torch.ones(ROWS, 201)
    gain = torch.tensor(1.25, requires_grad=True)
    loss = torch.zeros(())
    for _ in range(20):
        waves = [_noise(generator, flat) for _ in range(3)]
        loss = _heard(balance, label, 0.2, waves[0], gain * waves[1], gain * waves[2])
    # No lines, no ribs and no filter: two of five kinds of features apply; half of the moments grow with the gain, half
    # with its third power.
    assert loss.item() == pytest.approx(0.5 * math.log(1.25) ** 2 * (1.0 + 0.5 * (1.0 + 9.0)), rel=0.15)
    (slope,) = torch.autograd.grad(loss, gain)
    assert slope.item() == pytest.approx(math.log(1.25) / 1.25 * (1.0 + 0.5 * (1.0 + 9.0)), rel=0.15)


def test_rare_impulses_that_are_drawn_as_they_are_recorded_are_made_neither_weaker_nor_stronger() -> None:
    balance, generator = LabelBalance(1), torch.Generator().manual_seed(4)
    label, speed_mps, one = torch.zeros(4, dtype=torch.long), torch.full((4,), 0.02), torch.ones(4)
    gain = torch.tensor(1.0, requires_grad=True)

    def features(gain: torch.Tensor) -> LabelFeatures:
        """Features of four rows. One row in fifty has an impulse, which adds forty times what the others have."""
        struck = (torch.rand(4, 1, generator=generator) < 0.02).float()
        return LabelFeatures((1.0 + 40.0 * gain * struck).expand(-1, FEATURES), torch.ones(4, FEATURES))

    slopes = []
    for _ in range(6000):
        drawn = features(gain), features(gain)
        loss = balance.loss(label, speed_mps, features(torch.tensor(1.0)), drawn, one)
        slopes.append(torch.autograd.grad(loss, gain)[0].item() if loss.requires_grad else 0.0)
    # Averages remember twenty batches: a hundred are independent of the next hundred.
    blocks = torch.tensor(slopes).reshape(-1, 100).mean(dim=1)
    error = blocks.std().item() / math.sqrt(len(blocks))
    assert abs(blocks.mean().item()) < 3.5 * error, f"slope {blocks.mean():.4f}, standard error {error:.4f}"


def test_labels_and_speeds_are_averaged_separately_and_too_few_segments_give_no_loss() -> None:
    balance, generator = LabelBalance(2), torch.Generator().manual_seed(3)
    label, flat = torch.zeros(ROWS, dtype=torch.long), torch.ones(ROWS, 201)

    def loss(label: torch.Tensor, speed_mps: float, gain: float) -> float:
        rows = flat[: len(label)]
        waves = [_noise(generator, rows) for _ in range(3)]
        return _heard(balance, label, speed_mps, waves[0], gain * waves[1], gain * waves[2]).item()

    for own, speed_mps, gain in ((label, 0.05, 2.0), (label, 0.2, 1.0), (label + 1, 0.05, 1.0)):
        assert loss(own, speed_mps, gain) == 0.0, "nothing is known yet"
    for _ in range(10):
        assert loss(label, 0.05, 2.0) > 0.15
        assert loss(label, 0.2, 1.0) < 0.05
        assert loss(label + 1, 0.05, 1.0) < 0.05
    assert loss(label[:4], 0.9, 2.0) == 0.0


def test_the_loss_is_zero_for_the_true_velocity() -> None:
    target = torch.full((8, 1, 200), 2.0)

    def field(state: torch.Tensor, time: torch.Tensor) -> torch.Tensor:
        return (target - state) / (1.0 - time.unsqueeze(-1))

    assert flow_matching_loss(field, target, torch.Generator().manual_seed(0)).item() < 1e-6


@pytest.mark.parametrize(("kind", "order"), [("euler", 1), ("midpoint", 2), ("heun", 2)])
def test_a_solver_converges_with_its_order(kind: str, order: int) -> None:
    def field(state: torch.Tensor, time: torch.Tensor) -> torch.Tensor:
        return -1.5 * state + time.unsqueeze(-1)

    start = torch.full((1, 1, 1), 0.7, dtype=torch.float64)
    # x' = -1.5 x + t, so x(1) = (x0 + 1/2.25) exp(-1.5) + 1/1.5 - 1/2.25.
    exact = (0.7 + 1 / 2.25) * math.exp(-1.5) + 1 / 1.5 - 1 / 2.25
    coarse = abs(solve(field, start, kind, 8).item() - exact)
    fine = abs(solve(field, start, kind, 16).item() - exact)
    assert math.log2(coarse / fine) == pytest.approx(order, abs=0.2)


def _test_recipes_noise(count: int, samples: int, seed: int) -> torch.Tensor:
    return torch.randn(count, samples, generator=torch.Generator().manual_seed(seed))


def _loss(recorded: torch.Tensor, past: torch.Tensor, drawn: tuple[torch.Tensor, torch.Tensor], *, own: bool) -> float:
    heard = [spectra(past, segment) for segment in (recorded, *drawn)]
    nothing = torch.zeros(len(past), 2, PARTIALS)
    return energy_distance_loss(
        heard[0],
        (heard[1], heard[2]),
        torch.ones(len(past)),
        waves=None if own else (recorded, *drawn),
        lines=(nothing, nothing, nothing),
        envelopes=tuple(envelopes(past, segment) for segment in (recorded, *drawn)),
    ).item()


def _energy(draw: Callable[[int], torch.Tensor]) -> float:
    return _loss(_test_recipes_noise(256, 200, 1), _test_recipes_noise(256, 200, 2), (draw(3), draw(4)), own=False)


def test_the_energy_distance_prefers_the_true_process_to_its_mean_to_a_copy_of_one_draw_and_to_a_wrong_level() -> None:
    true = _energy(lambda seed: _test_recipes_noise(256, 200, seed))
    assert true < _energy(lambda seed: torch.zeros(256, 200)) - 0.1, "the conditional mean"
    assert true < _energy(lambda seed: _test_recipes_noise(256, 200, 3)) - 0.1, "no variety"
    for gain in (0.8, 1.25):
        assert true < _energy(lambda seed: gain * _test_recipes_noise(256, 200, seed)) - 0.005, f"level times {gain}"


def test_the_energy_distance_prefers_a_continued_tone_to_a_restarted_one() -> None:
    phase = 2.0 * math.pi * torch.rand(64, 1, generator=torch.Generator().manual_seed(1))
    time = torch.arange(400)
    tone = math.sqrt(2.0) * torch.sin(2.0 * math.pi * 0.07 * time + phase)
    past, going_on = tone[:, :200], tone[:, 200:]
    anew = going_on.roll(7, dims=0)
    losses = [_loss(going_on, past, (made, made), own=own) for own in (False, True) for made in (going_on, anew)]
    assert losses[0] < losses[1] - 0.3
    assert losses[2] < losses[3] - 0.1, "own past: by spectra alone"


def _blows(seed: int, rate: float) -> torch.Tensor:
    """[256, 200] of noise power 1: even for rate 1, in a share `rate` of the samples for less."""
    generator = torch.Generator().manual_seed(seed)
    noise = torch.randn(256, 200, generator=generator)
    return noise * (torch.rand(256, 200, generator=generator) < rate) / rate**0.5


@pytest.mark.parametrize("rate", [0.01, 0.1, 0.4])
def test_the_energy_distance_prefers_impacts_at_the_recorded_rate(rate: float) -> None:
    recorded, past = _blows(1, rate), torch.zeros(256, 200)

    def loss(drawn_rate: float) -> float:
        return _loss(recorded, past, (_blows(2, drawn_rate), _blows(3, drawn_rate)), own=True)

    assert loss(rate) < loss(1.0) - 0.05
    assert loss(rate) < loss(0.3 * rate) - 0.02


def test_rendering_a_chain_appends_each_generated_hop() -> None:
    store = make_store()
    model = build_model(field_config(), [(), ()]).eval()
    losses = Losses(model)
    chain = SegmentBatches(store, "train", BatchConfig(chain_hops=(2, 2)), 4).draw_chains(3).chain
    assert chain is not None
    embedding = model.embedding(torch.tensor([0, 1, 0])).detach()
    lived, before = losses.render_chain(chain, embedding, "energy", torch.Generator().manual_seed(1))
    generator = torch.Generator().manual_seed(1)

    def hop(number: int, previous: torch.Tensor) -> torch.Tensor:
        where = chain.motion[:, number], chain.position_mm[:, number], chain.wander[:, number]
        noise = torch.randn(3, 1, 200, generator=generator)
        return losses.generate(previous, noise, embedding, *where, "energy")[:, :, : chain.hop_samples]

    first = hop(0, chain.start)
    kept = torch.cat([chain.start[:, :, chain.hop_samples :], first], dim=2)
    second = hop(1, kept)
    torch.testing.assert_close(lived, torch.cat([kept[:, :, chain.hop_samples :], second], dim=2))
    assert before.shape == (3, 1, 0)


RECIPES = {
    "flow and self-forcing": ({"self_forcing_steps": 4}, "flow"),
    "average velocity": ({"objective": "average-velocity", "self_forcing_steps": 4}, "average-velocity"),
    "reflow": ({"reflow_steps": 6, "reflow_pairs": 600}, "flow"),
    "energy and self-forcing": ({"energy_steps": 6, "energy_batch_size": 6, "self_forcing_steps": 4}, "direct"),
}


@pytest.mark.parametrize("name", RECIPES)
def test_a_recipe_runs_through_its_phases_and_states_its_tier_kind(name: str, tmp_path: Path) -> None:
    recipe, kind = RECIPES[name]
    config = field_config(steps=10, recipe=recipe)
    EvaluatedTrainer(config, make_store(), tmp_path, ALONE).run()
    rows = (tmp_path / "metrics.csv").read_text(encoding="utf-8").splitlines()
    assert len({row.split(",")[1] for row in rows[1:]}) == len(planned_steps(config))
    tier = tier_of(*load_trained(tmp_path))
    assert tier.kind == kind
    condition = torch.zeros(3, 1, 200), torch.randn(3, 64), torch.rand(3, 3), torch.rand(3, 6)
    made = tier.generate(torch.randn(3, 1, 200), condition, tier.solver, tier.steps)
    assert made.shape == (3, 1, 200) and torch.isfinite(made).all()


STORE = make_store()


@pytest.fixture(scope="module")
def first(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A finished run of five steps."""
    folder = tmp_path_factory.mktemp("first")
    Trainer(_config(steps=5), STORE, folder, ALONE).run()
    return folder


def test_tiers_that_share_no_level_are_refused(first: Path, tmp_path: Path) -> None:
    Trainer(dataclasses.replace(_config(steps=5), tier="draft", seed=2), STORE, tmp_path, ALONE).run()
    with pytest.raises(InputError, match="--base"):
        load_tiers([first, tmp_path])


def test_a_further_round_begins_with_the_averaged_weights_of_the_run_it_goes_on_from(
    first: Path, tmp_path: Path
) -> None:
    begun = Trainer(_config(steps=5), STORE, tmp_path, ALONE, start=first)
    averaged = load_trained(first)[2].state_dict()
    for weights in (begun.model.state_dict(), begun.averaged_model.state_dict()):
        assert all(torch.equal(value, averaged[name]) for name, value in weights.items())


def test_a_layer_with_more_outputs_keeps_the_old_ones_and_initialises_the_new_ones(first: Path, tmp_path: Path) -> None:
    content = torch.load(first / "checkpoint.pt")
    weights, layer = content["average"]["module"], "skeleton.perceptron.layers.4"
    kept = weights[f"{layer}.bias"][:260].clone()
    weights |= {f"{layer}.bias": kept, f"{layer}.weight": weights[f"{layer}.weight"][:260]}
    torch.save(content, tmp_path / "checkpoint.pt")
    torch.manual_seed(1)
    built = build_model(_config(), [()] * 2).state_dict()[f"{layer}.bias"]
    begun = Trainer(_config(), STORE, tmp_path / "second", ALONE, start=tmp_path).model.state_dict()
    assert torch.equal(begun[f"{layer}.bias"][:260], kept)
    assert torch.equal(begun[f"{layer}.bias"][260:], built[260:])


def test_a_further_round_refuses_runs_with_other_shapes_or_labels(first: Path, tmp_path: Path) -> None:
    wide = dataclasses.replace(_config(), model=ModelConfig(hidden=(16, 16)))
    with pytest.raises(InputError, match=r"--from .*'skeleton\..*does not fit"):
        Trainer(wide, STORE, tmp_path / "second", ALONE, start=first)
    torch.save({**torch.load(first / "checkpoint.pt"), "labels": ["tone", "hiss"]}, tmp_path / "checkpoint.pt")
    with pytest.raises(InputError, match="--from .*hiss"):
        Trainer(_config(), STORE, tmp_path / "second", ALONE, start=tmp_path)
    with pytest.raises(InputError, match="train first"):
        Trainer(_config(), STORE, tmp_path / "second", ALONE, start=tmp_path / "nowhere")


@pytest.mark.parametrize(("energy_steps", "chains"), [(4, 3), (0, 6)])
def test_self_forcing_uses_every_second_batch_after_the_energy_distance_and_every_batch_without(
    energy_steps: int, chains: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    drawn: list[int] = []
    draw_chains = SegmentBatches.draw_chains

    def counted(batches: SegmentBatches, count: int) -> SegmentBatch:
        drawn.append(count)
        return draw_chains(batches, count)

    monkeypatch.setattr(SegmentBatches, "draw_chains", counted)
    recipe = RecipeConfig(energy_steps=energy_steps, energy_batch_size=8, self_forcing_steps=6)
    Trainer(dataclasses.replace(_config(steps=2), recipe=recipe), make_store(), tmp_path, ALONE).run()
    assert drawn == [8] * chains
