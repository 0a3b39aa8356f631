"""Ruled surfaces: their wave vectors, the comb that carries their pitch, and strokes steady enough to learn it from."""

from __future__ import annotations

import dataclasses
import math
from pathlib import Path

import numpy as np
import pytest
import torch
from test_trainer import ALONE, _config
from training_fixtures import make_store

from haptoflow_training.models.label_embedding import LabelEmbedding, rib_frequencies_hz
from haptoflow_training.models.rib_comb import RibComb
from haptoflow_training.models.velocity_field import VelocityField
from haptoflow_training.recordings.synthetic.carriers import FASTEST_MMPS, guided_ride
from haptoflow_training.recordings.synthetic.contact import SIMULATION_RATE_HZ
from haptoflow_training.training.config import ModelConfig, RecipeConfig
from haptoflow_training.training.trainer import Trainer, load_trained

EMBEDDING = LabelEmbedding(64, [((0.4, 0.0),), ((0.8, 0.0), (0.0, 0.8)), ()])


def _wave(frequencies_hz: list[float], start: int, stop: int) -> torch.Tensor:
    time = torch.arange(start, stop) / 2000.0
    return torch.stack([torch.sin(2.0 * math.pi * f * time + f) for f in frequencies_hz]).sum(dim=0).reshape(1, 1, -1)


def test_a_label_s_last_four_numbers_are_its_wave_vectors_and_zero_without_ribs() -> None:
    torch.testing.assert_close(
        EMBEDDING.weight[:, -4:],
        torch.tensor([[0.4, 0.0, 0.0, 0.0], [0.8, 0.0, 0.0, 0.8], [0.0, 0.0, 0.0, 0.0]]),
    )


def test_ribs_sound_at_speed_across_them_over_their_wavelength() -> None:
    angle = math.radians(60.0)
    motion = torch.tensor([[0.2 * math.cos(angle), 0.2 * math.sin(angle), 1.0]])
    mesh = EMBEDDING(torch.tensor([1]))
    expected = [800.0 * 0.2 * math.cos(angle), 800.0 * 0.2 * math.sin(angle)]
    torch.testing.assert_close(rib_frequencies_hz(mesh, motion), torch.tensor([expected]))


@pytest.mark.parametrize("speed_mps", [0.1, 0.237, 0.9])
def test_the_comb_carries_a_tone_and_its_overtone_on_with_their_phases(speed_mps: float) -> None:
    fundamental = 400.0 * speed_mps
    tones = [f for f in (fundamental, 2.0 * fundamental) if f < 960.0]
    motion = torch.tensor([[speed_mps, 0.0, 1.0]])
    combed, _ = RibComb()(torch.randn(1, 1, 200), _wave(tones, -200, 0), EMBEDDING(torch.tensor([0])), motion)
    truth = _wave(tones, 0, 200)[0, 0]
    error = (combed[0, 0] - truth).square().mean().sqrt() / truth.square().mean().sqrt()
    assert error.item() < 0.25, "a ramp of 100 ms tells harmonics 20 Hz apart from their neighbours"
    assert combed[0, 1].abs().max().item() == 0.0, "a second family of ribs that is not there"


def test_lines_are_the_comb_s_harmonics_one_by_one_and_the_noise_s_own_share() -> None:
    fundamental = 200.0
    motion = torch.tensor([[0.5, 0.0, 1.0]])
    noise = _wave([fundamental], 0, 200)
    past = _wave([fundamental, 2.0 * fundamental], -200, 0)
    channels, lines = RibComb()(noise, past, EMBEDDING(torch.tensor([0])), motion)
    carried, fresh, own = lines.reshape(3, 2, 8, 200)
    torch.testing.assert_close(carried.sum(dim=1), channels[0, 0:2])
    torch.testing.assert_close(fresh.sum(dim=1), channels[0, 2:4])
    torch.testing.assert_close(own[0, 0], noise[0, 0], rtol=0.0, atol=1e-3)
    assert own[0, 1:].abs().max().item() < 1e-3, "the noise has nothing at the overtones"
    assert own[1].abs().max().item() == 0.0, "a second family of ribs that is not there"


def test_a_network_taught_nothing_adds_no_lines_and_one_with_unit_gains_carries_the_past_on() -> None:
    field = VelocityField(width=16, previous_width=8, ribs=True)
    motion = torch.tensor([[0.5, 0.0, 1.0]])
    past = _wave([200.0], -200, 0)
    embedding = EMBEDDING(torch.tensor([0]))
    arguments = (torch.zeros(1, 1, 200), torch.zeros(1, 1), past, embedding, motion)
    assert field(*arguments).abs().max().item() == 0.0
    assert field.line_gains is not None
    with torch.no_grad():
        field.line_gains.bias[:16] = 1.0
    torch.testing.assert_close(field(*arguments), _wave([200.0], 0, 200), rtol=0.0, atol=0.05)


def test_a_line_that_has_grown_beyond_all_power_there_is_is_carried_on_no_larger_than_that() -> None:
    motion = torch.tensor([[0.5, 0.0, 1.0]])
    past = 5.0 * _wave([200.0], -200, 0)
    _, lines = RibComb()(torch.zeros(1, 1, 200), past, EMBEDDING(torch.tensor([0])), motion)
    assert lines[0, 0].abs().max().item() == pytest.approx(1.5, abs=0.02)


def test_fresh_harmonics_have_unit_size_and_a_phase_of_the_noise() -> None:
    motion = torch.tensor([[0.5, 0.0, 1.0]] * 2)
    combed, _ = RibComb()(torch.randn(2, 1, 200), torch.zeros(2, 1, 200), EMBEDDING(torch.tensor([0, 0])), motion)
    harmonics = 4
    power = combed[:, 2].square().mean(dim=1)
    torch.testing.assert_close(power, torch.full((2,), harmonics / 2.0), rtol=0.15, atol=0.0)
    assert (combed[0, 2] - combed[1, 2]).abs().max().item() > 0.5
    assert combed[:, 0].abs().max().item() == 0.0, "silence before leaves nothing to carry on"


@pytest.mark.parametrize(
    ("label", "speed_mps"), [(2, 0.5), (0, 0.0), (0, 0.03), (0, 20.0)], ids=["no ribs", "rest", "crawling", "too fast"]
)
def test_where_no_rib_can_sound_the_comb_is_silent_and_finite(label: int, speed_mps: float) -> None:
    motion = torch.tensor([[speed_mps, 0.0, 1.0]])
    combed, _ = RibComb()(torch.randn(1, 1, 200), torch.randn(1, 1, 200), EMBEDDING(torch.tensor([label])), motion)
    assert combed.abs().max().item() == 0.0


def test_training_leaves_wave_vectors_as_they_are_and_a_saved_run_has_them(tmp_path: Path) -> None:
    config = dataclasses.replace(
        _config(steps=6), model=ModelConfig(width=16, previous_width=8, ribs=True), recipe=RecipeConfig(energy_steps=3)
    )
    Trainer(config, make_store(), tmp_path, ALONE, wave_vectors=[((0.5, 0.0),), ()]).run()
    model = load_trained(tmp_path)[2]
    assert model.embedding.weight[:, -4:].tolist() == [[0.5, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0]]


def test_a_guided_stroke_holds_its_velocity_for_most_tenths_of_a_second_and_changes_it_between() -> None:
    ride = guided_ride(
        np.random.default_rng(3), duration_seconds=8.0, median_speed_mmps=300.0, median_force_newtons=1.0
    )
    rate = int(SIMULATION_RATE_HZ)
    step = rate // 10
    velocity = ride.path.velocity_mmps[rate : 7 * rate]
    tenths = velocity[: len(velocity) // step * step].reshape(-1, step, 2)
    spread = np.hypot(*np.ptp(tenths, axis=1).T) / np.hypot(*tenths.mean(axis=1).T)
    assert np.mean(spread < 0.03) > 0.7
    assert len(np.unique(np.round(np.log(np.hypot(*tenths.mean(axis=1).T)), 1))) >= 4
    assert np.hypot(*ride.path.velocity_mmps.T).max() <= FASTEST_MMPS + 1.0
    assert np.hypot(*ride.path.velocity_mmps[[0, -1]].T).max() < 1.0
    assert ride.force_newtons.min() > 0.0
