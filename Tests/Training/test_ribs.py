"""Ruled surfaces: their wave vectors, the rib comb, and strokes that are steady enough to learn a pitch."""

from __future__ import annotations

import dataclasses
import math
from pathlib import Path

import numpy as np
import pytest
import torch
from test_trainer import ALONE, _config
from training_fixtures import make_store

from haptoflow_paper.runs.continuing_comb import GAINS, ContinuingComb, spread_gains
from haptoflow_training.models.label_embedding import LabelEmbedding, rib_frequencies_hz, surface_phases
from haptoflow_training.models.rib_comb import PARTIALS, RibComb
from haptoflow_training.recordings.synthetic.carriers import guided_ride
from haptoflow_training.recordings.synthetic.contact import SIMULATION_RATE_HZ
from haptoflow_training.training.config import ModelConfig, RecipeConfig
from haptoflow_training.training.energy_distance import energy_distance_loss, envelopes, spectra
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


def test_the_rib_frequency_is_the_speed_across_the_ribs_over_their_wavelength() -> None:
    angle = math.radians(60.0)
    motion = torch.tensor([[0.2 * math.cos(angle), 0.2 * math.sin(angle), 1.0]])
    mesh = EMBEDDING(torch.tensor([1]))
    expected = [800.0 * 0.2 * math.cos(angle), 800.0 * 0.2 * math.sin(angle)]
    torch.testing.assert_close(rib_frequencies_hz(mesh, motion).squeeze(2), torch.tensor([expected]))


def _phases(
    embedding: torch.Tensor, motion: torch.Tensor, turns: tuple[float, float] = (0.0, 0.0)
) -> torch.Tensor:
    """[B, 6]: the phases of even ribs that are `turns` along their wave vectors."""
    phases = surface_phases(embedding, motion, torch.zeros(len(embedding), 2), torch.zeros(len(embedding), 6))
    phases[:, :2] = torch.tensor(turns)
    return phases


def _comb(
    past: torch.Tensor,
    label: int,
    speed_mps: float,
    gains: torch.Tensor | None = None,
    turns: tuple[float, float] = (0.0, 0.0),
) -> torch.Tensor:
    """[B, 5, 200]: the past continued by both families of ribs, pulses of both, lines."""
    count = len(past)
    motion = torch.tensor([[speed_mps, 0.0, 1.0]] * count)
    embedding = EMBEDDING(torch.tensor([label] * count))
    phases = _phases(embedding, motion, turns)
    spread = (torch.zeros(1, GAINS) if gains is None else gains)[:, spread_gains()]
    return ContinuingComb()(torch.flip(past, [2]), phases, spread)


@pytest.mark.parametrize("speed_mps", [0.1, 0.237, 0.9])
def test_the_comb_continues_a_tone_and_its_overtone_with_their_phases(speed_mps: float) -> None:
    fundamental = 400.0 * speed_mps
    tones = [f for f in (fundamental, 2.0 * fundamental) if f < 960.0]
    combed = _comb(_wave(tones, -200, 0), 0, speed_mps)
    truth = _wave(tones, 0, 200)[0, 0]
    error = (combed[0, 0] - truth).square().mean().sqrt() / truth.square().mean().sqrt()
    assert error.item() < 0.25, "a ramp of 100 ms tells harmonics 20 Hz apart from their neighbours"
    assert combed[0, 1].abs().max().item() == 0.0, "a second family of ribs that is not there"


def test_a_segment_s_partials_relative_to_the_surface_do_not_depend_on_the_place() -> None:
    comb, embedding, motion = RibComb(), EMBEDDING(torch.tensor([0])), torch.tensor([[0.5, 0.0, 1.0]])
    for turns in (0.0, 0.21, 0.8):
        phase = 2.0 * math.pi * (turns + 200.0 * torch.arange(200) / 2000.0)
        segments = torch.stack([phase.cos(), phase.sin(), (2.0 * phase).cos()]).unsqueeze(0)
        seen, resolved = comb.profile(_phases(embedding, motion, (turns, 0.0)), segments)
        expected = torch.zeros(3, 2, PARTIALS)
        expected[0, 0, 0] = expected[1, 1, 0] = expected[2, 0, 1] = 1.0
        torch.testing.assert_close(seen[0], expected, rtol=0.0, atol=0.02)
        assert resolved[0].nonzero().flatten().tolist() == [0, 1, 2, 3]


def test_the_energy_distance_prefers_draws_with_the_recording_s_rib_phase() -> None:
    torch.manual_seed(1)
    past, recorded = (0.1 * torch.randn(2, 64, 200)).unbind()
    holds = torch.zeros(64, 2, PARTIALS)
    holds[:, 0, 0] = 1.0
    angle = 2.0 * math.pi * torch.rand(2, 64)
    turned = torch.zeros(2, 64, 2, PARTIALS)
    turned[:, :, 0, 0], turned[:, :, 1, 0] = angle.cos(), angle.sin()
    draws = (0.1 * torch.randn(64, 200), 0.1 * torch.randn(64, 200))

    heard = [spectra(past, wave) for wave in (recorded, *draws)]

    def loss(first: torch.Tensor, second: torch.Tensor, *, own_past: bool) -> float:
        waves = None if own_past else (recorded, *draws)
        lines = (holds, first, second)
        shapes = tuple(envelopes(past, wave) for wave in (recorded, *draws))
        return energy_distance_loss(
            heard[0], (heard[1], heard[2]), torch.ones(64), waves=waves, lines=lines, envelopes=shapes
        ).item()

    for own_past in (False, True):
        assert loss(turned[0], turned[1], own_past=own_past) > loss(holds, holds, own_past=own_past) + 0.5


def test_training_does_not_change_wave_vectors_and_a_saved_run_has_them(tmp_path: Path) -> None:
    config = dataclasses.replace(
        _config(steps=6), model=ModelConfig(hidden=8), recipe=RecipeConfig(energy_steps=3)
    )
    Trainer(config, make_store(), tmp_path, ALONE, wave_vectors=[((0.5, 0.0),), ()]).run()
    model = load_trained(tmp_path)[2]
    assert model.embedding.weight[:, -4:].tolist() == [[0.5, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0]]


def test_a_quarter_of_a_guided_stroke_is_so_steady_that_fast_ribs_keep_their_phase_and_half_of_that_is_along_a_scan(
    
) -> None:
    """0.6 mm ribs at up to 1.5 m/s: how far the position is, in the middle of a tenth, from a straight line's."""
    step = int(SIMULATION_RATE_HZ) // 10
    bends, turns = [], []
    for seed in range(6):
        ride = guided_ride(
            np.random.default_rng(seed), duration_seconds=8.0, median_speed_mmps=400.0, median_force_newtons=1.0
        )
        position = ride.path.position_mm[10 * step : 70 * step]
        tenths = position[: len(position) // step * step].reshape(-1, step, 2)
        bend = 0.5 * (tenths[:, step // 2 - 1] + tenths[:, step // 2] - tenths[:, 0] - tenths[:, -1])
        bends.append(2.0 * math.pi * np.abs(bend[:, 0]) / 0.6)
        eighths = np.arctan2(*(tenths[:, -1] - tenths[:, 0]).T) / (0.25 * math.pi)
        turns.append(np.abs(eighths - np.round(eighths)) * 45.0)
    steady, turned_degrees = np.concatenate(bends) < 0.05, np.concatenate(turns)
    assert np.mean(steady) > 0.25
    assert np.mean(turned_degrees[steady] < 5.0) > 0.4
