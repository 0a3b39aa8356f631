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

from haptoflow_training.models.label_embedding import LabelEmbedding, rib_frequencies_hz, surface_phases
from haptoflow_training.models.rib_comb import GAINS, PARTIALS, RibComb, spread_gains
from haptoflow_training.models.velocity_field import VelocityField
from haptoflow_training.recordings.synthetic.carriers import MAXIMUM_SPEED_MMPS, guided_ride
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
    return RibComb()(torch.flip(past, [2]), phases, spread)


@pytest.mark.parametrize("speed_mps", [0.1, 0.237, 0.9])
def test_the_comb_continues_a_tone_and_its_overtone_with_their_phases(speed_mps: float) -> None:
    fundamental = 400.0 * speed_mps
    tones = [f for f in (fundamental, 2.0 * fundamental) if f < 960.0]
    combed = _comb(_wave(tones, -200, 0), 0, speed_mps)
    truth = _wave(tones, 0, 200)[0, 0]
    error = (combed[0, 0] - truth).square().mean().sqrt() / truth.square().mean().sqrt()
    assert error.item() < 0.25, "a ramp of 100 ms tells harmonics 20 Hz apart from their neighbours"
    assert combed[0, 1].abs().max().item() == 0.0, "a second family of ribs that is not there"


def _only(kind: int, partial: int) -> torch.Tensor:
    gains = torch.zeros(1, GAINS)
    gains[0, kind * PARTIALS + partial] = 1.0
    return gains


def test_lines_are_the_gain_weighted_partials_of_past_and_surface() -> None:
    fundamental = 200.0
    past = _wave([fundamental, 2.0 * fundamental], -200, 0)
    time = torch.arange(200) / 2000.0

    def partial(order: int, turns: float, lag: float) -> torch.Tensor:
        """cos of what the rib phase has become, lag radians behind."""
        return torch.cos(2.0 * math.pi * order * (turns + fundamental * time) - lag).reshape(1, 1, -1)

    expected = {
        (0, 0): _wave([fundamental], 0, 200),
        (0, 1): _wave([2.0 * fundamental], 0, 200),
        (2, 0): partial(1, 0.3, 0.0),
        (2, 2): partial(3, 0.3, 0.0),
        (3, 1): partial(2, 0.3, 0.5 * math.pi),
    }
    for (kind, number), line in expected.items():
        made = _comb(past, 0, 0.5, _only(kind, number), (0.3, 0.0))[:, 4:]
        torch.testing.assert_close(made, line, rtol=0.0, atol=3e-2, msg=f"gain {kind} of partial {number}")
    every = _comb(past, 0, 0.5, torch.tensor([[1.0] * PARTIALS + [0.0] * (GAINS - PARTIALS)]))
    torch.testing.assert_close(every[:, 4], every[:, 0])


def test_a_reversed_stroke_meets_the_same_ribs_in_reverse() -> None:
    gains = torch.randn(1, GAINS, generator=torch.Generator().manual_seed(4))
    gains[:, : 2 * PARTIALS] = gains[:, 4 * PARTIALS :] = 0.0
    against = gains.clone()
    # Seen from the other side, a phase lag becomes a lead.
    against[:, 3 * PARTIALS : 4 * PARTIALS] *= -1.0
    silence = torch.zeros(1, 1, 200)
    position_mm = 7.31
    place = EMBEDDING(torch.tensor([0])), torch.zeros(1, 3), torch.tensor([[position_mm, 0.0]]), torch.zeros(1, 6)
    turn = surface_phases(*place)[0, 0].item()
    there = _comb(silence, 0, 0.2, gains, (turn, 0.0))[0, 4]
    # The way back starts where the way there ended with its last sample.
    end = (turn + 0.4 * 200.0 * 199.0 / 2000.0) % 1.0
    back = _comb(silence, 0, -0.2, against, (end, 0.0))[0, 4]
    torch.testing.assert_close(back, torch.flip(there, [0]), rtol=0.0, atol=2e-3)
    assert there.square().mean() > 0.5


@pytest.mark.parametrize("wandered_turns", [0.0, 0.12, -0.2])
def test_a_wandering_profile_continues_from_its_offset_in_the_past(
    wandered_turns: float,
) -> None:
    fundamental, turns = 40.0, 0.37
    gains = torch.zeros(1, GAINS)
    profile = gains[0, 4 * PARTIALS : 6 * PARTIALS].view(2, PARTIALS)
    profile[0, :4], profile[1, :4] = torch.tensor([0.5, -0.4, 0.3, 0.3]), torch.tensor([0.2, 0.3, -0.4, 0.2])
    # Sharp, because this test is about the offset.
    gains[0, 6 * PARTIALS : 6 * PARTIALS + 2] = 3.0

    def wave(start: int, stop: int) -> torch.Tensor:
        time = torch.arange(start, stop) / 2000.0
        angle = 2.0 * math.pi * (turns + wandered_turns + fundamental * time)
        partials = [
            profile[0, order - 1] * torch.cos(order * angle) + profile[1, order - 1] * torch.sin(order * angle)
            for order in range(1, 5)
        ]
        return torch.stack(partials).sum(dim=0).reshape(1, 1, -1)

    made = _comb(wave(-200, 0), 0, 0.1, gains, (turns, 0.0))[0, 4]
    truth = wave(0, 200)[0, 0]
    assert ((made - truth).square().mean() / truth.square().mean()).sqrt().item() < 0.2


def test_without_a_past_the_wandering_profile_stays_near_the_rib_phase() -> None:
    gains = torch.zeros(1, GAINS)
    gains[0, 4 * PARTIALS] = 1.0
    gains[0, 6 * PARTIALS + 2 :] = 3.0
    silence = torch.zeros(1, 1, 200)
    made = _comb(silence, 0, 0.5, gains, (0.3, 0.0))[0, 4]
    truth = torch.cos(2.0 * math.pi * (0.3 + 200.0 * torch.arange(200) / 2000.0))
    torch.testing.assert_close(made, truth, rtol=0.0, atol=0.1)


def test_a_rib_phase_counts_ribs_from_position_zero_after_metres_as_after_millimetres() -> None:
    mesh = EMBEDDING(torch.tensor([1, 1, 2]))
    places_mm = torch.tensor([[10.0, -1.0], [12000.25, 3.0], [4.0, 4.0]])
    found = surface_phases(mesh, torch.zeros(3, 3), places_mm, torch.zeros(3, 6))
    turns = torch.tensor([[0.0, 0.2], [0.2, 0.4], [0.0, 0.0]])
    torch.testing.assert_close(found[:, :2], turns, rtol=0.0, atol=2e-3)


def test_the_comb_s_waves_are_cosines_and_sines_of_every_harmonic_counted_from_the_seam() -> None:
    motion = torch.tensor([[0.11, 0.0, 1.0]])
    embedding = EMBEDDING(torch.tensor([0]))
    waves = RibComb().ribs(_phases(embedding, motion)).waves
    time = (torch.arange(200) + 0.5) / 2000.0
    for order in (1, 2, 7, 12):
        angle = 2.0 * math.pi * 44.0 * order * time
        both = torch.stack([angle.cos(), angle.sin()])
        torch.testing.assert_close(waves[0, 2 * order - 2 : 2 * order], both, rtol=0.0, atol=1e-4)


def test_an_untrained_network_adds_no_lines_and_unit_gains_continue_the_past() -> None:
    field = VelocityField(width=16, previous_width=8, ribs=True)
    motion = torch.tensor([[0.5, 0.0, 1.0]])
    past = _wave([200.0], -200, 0)
    embedding = EMBEDDING(torch.tensor([0]))
    arguments = (torch.zeros(1, 1, 200), torch.zeros(1, 1), past, embedding, motion, _phases(embedding, motion))
    assert field(*arguments).abs().max().item() == 0.0
    assert field.line_gains is not None
    with torch.no_grad():
        field.line_gains.bias[:PARTIALS] = 1.0
    torch.testing.assert_close(field(*arguments), _wave([200.0], 0, 200), rtol=0.0, atol=0.05)


def test_a_line_above_unit_power_is_continued_at_the_limit() -> None:
    lines = _comb(5.0 * _wave([200.0], -200, 0), 0, 0.5, _only(0, 0))[:, 4]
    assert lines.abs().max().item() == pytest.approx(1.5, abs=0.02)


@pytest.mark.parametrize("size", [0.05, 1.0, 3.0])
def test_a_unit_amplitude_line_continues_in_phase_whatever_the_past_s_level(size: float) -> None:
    lines = _comb(size * _wave([200.0], -200, 0), 0, 0.5, 0.4 * _only(1, 0))[:, 4]
    torch.testing.assert_close(lines, 0.4 * _wave([200.0], 0, 200)[:, 0], rtol=0.0, atol=0.02)


def test_pulses_occur_at_the_rib_rate_and_a_silent_past_gives_no_continuation() -> None:
    combed = _comb(torch.zeros(1, 1, 200), 0, 0.1, turns=(0.5, 0.0))
    peaks = [
        place
        for place in range(2, 198)
        if combed[0, 2, place] > 2.0 and combed[0, 2, place] == combed[0, 2, place - 2 : place + 3].max()
    ]
    # 0.4 ribs a millimetre at 100 mm/s: one every 50 samples, the first half a rib away.
    assert peaks == [25, 75, 125, 175]
    assert combed[:, 0].abs().max().item() == 0.0
    assert combed[:, 3].abs().max().item() == 0.0, "a second family of ribs that is not there"


@pytest.mark.parametrize(
    ("label", "speed_mps"), [(2, 0.5), (0, 0.0), (0, 20.0)], ids=["no ribs", "rest", "too fast"]
)
def test_without_audible_ribs_the_comb_is_zero_and_finite(label: int, speed_mps: float) -> None:
    combed = _comb(torch.randn(1, 1, 200), label, speed_mps, torch.ones(1, GAINS))
    assert combed.abs().max().item() == 0.0


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
        _config(steps=6), model=ModelConfig(network="field", width=16, previous_width=8, ribs=True), recipe=RecipeConfig(energy_steps=3)
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
    assert np.hypot(*ride.path.velocity_mmps.T).max() <= MAXIMUM_SPEED_MMPS + 1.0
    assert np.hypot(*ride.path.velocity_mmps[[0, -1]].T).max() < 1.0
    assert ride.force_newtons.min() > 0.0


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
