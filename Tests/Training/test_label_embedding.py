"""Labels and their specimens as embeddings, and the phases of a surface at a place."""

from __future__ import annotations

import dataclasses
import math
from pathlib import Path

import numpy as np
import pytest
import torch
from numpy.typing import NDArray

from haptoflow_paper.runs.continuing_comb import GAINS, ContinuingComb, spread_gains
from haptoflow_training.models.conditioning import EMBEDDING_SIZE
from haptoflow_training.models.haptoflow_model import SkeletonModel
from haptoflow_training.models.label_embedding import (
    FAMILIES, RATE_FEATURES, LabelEmbedding, SurfaceWaves, advanced, path_of, rate_features, rib_frequencies_hz,
    surface_phases, with_path
)
from haptoflow_training.models.level_model import LevelModel
from haptoflow_training.models.rib_comb import PARTIALS, RibComb
from haptoflow_training.models.skeleton import Skeleton
from haptoflow_training.training.found_wave_vectors import rib_phase_turns
from haptoflow_training.recordings.synthetic.carriers import guided_ride
from haptoflow_training.recordings.synthetic.contact import SIMULATION_RATE_HZ
from haptoflow_training.training.config import ModelConfig, RecipeConfig
from haptoflow_training.training.energy_distance import energy_distance_loss, envelopes, spectra
from haptoflow_training.training.losses import SkeletonLosses
from haptoflow_training.training.trainer import Trainer, load_trained
from test_trainer import ALONE, _config
from training_fixtures import make_store

RIBS = [((0.8, 0.0), (0.0, 0.5)), ()]


def _with_specimens() -> LabelEmbedding:
    torch.manual_seed(3)
    embedding = LabelEmbedding(64, RIBS, specimens=5)
    assert embedding.pieces is not None
    with torch.no_grad():
        embedding.pieces.normal_()
    return embedding


def test_the_offsets_of_a_label_s_specimens_add_up_to_zero_and_differ() -> None:
    embedding = _with_specimens()
    torch.testing.assert_close(embedding.offsets.sum(dim=1), torch.zeros(2, 60), rtol=0.0, atol=1e-5)
    of_specimens = torch.stack([embedding(torch.tensor([1]), torch.tensor([number]))[0] for number in range(5)])
    torch.testing.assert_close(of_specimens.mean(dim=0), embedding(torch.tensor([1]))[0])
    assert of_specimens.std(dim=0)[:60].min() > 1e-3


def test_an_unknown_specimen_gives_the_label_itself_and_a_known_one_keeps_the_wave_vectors() -> None:
    embedding = _with_specimens()
    label, specimen = torch.tensor([0, 0, 1]), torch.tensor([-1, 2, -1])
    made = embedding(label, specimen)
    torch.testing.assert_close(made[[0, 2]], embedding(label)[[0, 2]], rtol=0.0, atol=0.0)
    assert (made[1] - embedding(label)[1]).abs().max() > 0.01
    torch.testing.assert_close(made[:, -4:], embedding(label)[:, -4:], rtol=0.0, atol=0.0)
    torch.testing.assert_close(embedding(label), embedding.weight[label])


def _phases(position_mm: tuple[float, float], wander: tuple[float, ...] = (0.0,) * 6) -> list[float]:
    embedding = LabelEmbedding(64, RIBS)(torch.tensor([0]))
    motion = torch.tensor([[0.1, -0.2, 1.0]])
    return surface_phases(embedding, motion, torch.tensor([position_mm]), torch.tensor([wander]))[0].tolist()


def _same(one: list[float], other: list[float]) -> None:
    torch.testing.assert_close(torch.tensor(one), torch.tensor(other), rtol=0.0, atol=2e-3)


def test_phases_are_the_fraction_of_the_ribs_crossed_and_the_rates_k_times_v_with_their_sign() -> None:
    # 0.8 ribs a millimetre along x at 100 mm/s, 0.5 along y at -200 mm/s; stick-slip has no place.
    _same(_phases((1.5, 0.5)), [0.2, 0.25, 0.0, 80.0, -100.0, 0.0])


def test_wander_displaces_the_ribs_and_is_all_there_is_of_stick_and_slip() -> None:
    _same(_phases((1.5, 0.5), (0.3, -0.5, 0.7, 4.0, -6.0, 42.0)), [0.5, 0.75, 0.7, 84.0, -106.0, 42.0])


def _test_surface_waves_phases(turns: tuple[float, float, float], rates_hz: tuple[float, float, float]) -> torch.Tensor:
    return torch.tensor([[*turns, *rates_hz]])


def test_every_family_has_the_cosines_and_sines_of_its_harmonics_from_half_a_sample_on() -> None:
    cosines, sines = SurfaceWaves(5, 700.0)(_test_surface_waves_phases((0.1, 0.45, 0.8), (30.0, 77.0, 12.5)))
    assert cosines.shape == sines.shape == (1, 3, 5, 200)
    time = (torch.arange(200) + 0.5) / 2000.0
    for family, (turns, rate) in enumerate(((0.1, 30.0), (0.45, 77.0), (0.8, 12.5))):
        for order in (1, 2, 5):
            angle = 2.0 * math.pi * order * (turns + rate * time)
            torch.testing.assert_close(cosines[0, family, order - 1], angle.cos(), rtol=0.0, atol=2e-4)
            torch.testing.assert_close(sines[0, family, order - 1], angle.sin(), rtol=0.0, atol=2e-4)


def test_the_phase_is_counted_in_the_direction_of_motion_so_that_the_way_back_meets_the_same_ribs_backwards() -> None:
    waves = SurfaceWaves(3, 700.0)
    there = waves(_test_surface_waves_phases((0.2, 0.0, 0.0), (40.0, 0.0, 0.0)))
    # The way back begins at the place where the way there ends; ribs lie the other way round, so sines change sign.
    end = 0.2 + 40.0 * 200.0 / 2000.0
    back = waves(_test_surface_waves_phases((end % 1.0, 0.0, 0.0), (-40.0, 0.0, 0.0)))
    torch.testing.assert_close(back[0][0, 0], torch.flip(there[0][0, 0], [1]), rtol=0.0, atol=1e-3)
    torch.testing.assert_close(back[1][0, 0], -torch.flip(there[1][0, 0], [1]), rtol=0.0, atol=1e-3)
    assert there[1][0, 0].abs().max() > 0.9


def test_the_place_at_every_sample_replaces_that_at_a_steady_rate() -> None:
    waves, phases = SurfaceWaves(4, 960.0), _test_surface_waves_phases((0.15, 0.6, 0.9), (35.0, -60.0, 20.0))
    seconds = (torch.arange(200) + 0.5) / 2000.0
    steady = phases[:, :3, None] + phases[:, 3:, None] * seconds
    for expected, found in zip(waves(phases), waves(with_path(phases, steady)), strict=True):
        torch.testing.assert_close(found, expected, rtol=0.0, atol=1e-4)
    slowing = steady - 30.0 * torch.tensor([1.0, -1.0, 1.0]).reshape(1, 3, 1) * seconds.square()
    cosines, sines = waves(with_path(phases, slowing))
    for family, sign in enumerate((1.0, -1.0, 1.0)):
        angle = 2.0 * math.pi * 2.0 * sign * slowing[0, family]
        torch.testing.assert_close(cosines[0, family, 1], angle.cos(), rtol=0.0, atol=1e-4)
        torch.testing.assert_close(sines[0, family, 1], angle.sin(), rtol=0.0, atol=1e-4)


@pytest.mark.parametrize("samples", [1, 27, 150])
def test_advanced_places_at_every_sample_are_those_of_a_segment_that_begins_later(samples: int) -> None:
    waves, phases = SurfaceWaves(4, 960.0), _test_surface_waves_phases((0.15, 0.6, 0.9), (35.0, -60.0, 20.0))
    bent = phases[:, :3, None] + torch.linspace(0.0, 3.0, 200).square()
    first, later = with_path(phases, bent), advanced(with_path(phases, bent), samples)
    assert torch.equal(later[:, :6], advanced(phases, samples))
    for one, other in zip(waves(first), waves(later), strict=True):
        torch.testing.assert_close(other[..., : 200 - samples], one[..., samples:], rtol=0.0, atol=1e-5)
        # Beyond the segment, at the rate.
        assert (other[..., -1] - other[..., -2]).abs().max() < 14 * 2.0 * math.pi * 60.0 / 2000.0


def test_rate_features_are_zero_at_rest_and_tell_how_fast_and_which_way() -> None:
    assert rate_features(_test_surface_waves_phases((0.1, 0.2, 0.3), (0.0, 0.0, 0.0))).abs().max() == 0.0
    there, back = (rate_features(_test_surface_waves_phases((0.1, 0.2, 0.3), (sign * 5.0, 40.0, -sign * 300.0))) for sign in (1.0, -1.0))
    assert there.shape == (1, RATE_FEATURES)
    sizes, directions = there.chunk(2, dim=1)
    torch.testing.assert_close(back, torch.cat([sizes, directions * torch.tensor([-1.0, 1.0, -1.0])], dim=1))
    assert (sizes[0].diff() > 0.0).all() and (directions[0] * torch.tensor([1.0, 1.0, -1.0]) > 0.0).all()
    assert there.abs().max() < 2.0
    assert torch.equal(there, rate_features(_test_surface_waves_phases((0.7, 0.0, 0.0), (5.0, 40.0, -300.0)))), "no place"


EMBEDDING = LabelEmbedding(64, [((0.4, 0.0),), ((0.8, 0.0), (0.0, 0.8)), ()])


def _wave(frequencies_hz: list[float], start: int, stop: int) -> torch.Tensor:
    time = torch.arange(start, stop) / 2000.0
    return torch.stack([torch.sin(2.0 * math.pi * f * time + f) for f in frequencies_hz]).sum(dim=0).reshape(1, 1, -1)


def test_the_rib_frequency_is_the_speed_across_the_ribs_over_their_wavelength() -> None:
    angle = math.radians(60.0)
    motion = torch.tensor([[0.2 * math.cos(angle), 0.2 * math.sin(angle), 1.0]])
    mesh = EMBEDDING(torch.tensor([1]))
    expected = [800.0 * 0.2 * math.cos(angle), 800.0 * 0.2 * math.sin(angle)]
    torch.testing.assert_close(rib_frequencies_hz(mesh, motion).squeeze(2), torch.tensor([expected]))


def _test_ribs_phases(
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
    phases = _test_ribs_phases(embedding, motion, turns)
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
        seen, resolved = comb.profile(_test_ribs_phases(embedding, motion, (turns, 0.0)), segments)
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
    shape, recipe = ModelConfig(hidden=(8, 8)), RecipeConfig(energy_steps=3)
    config = dataclasses.replace(_config(steps=6), model=shape, recipe=recipe)
    Trainer(config, make_store(), tmp_path, ALONE, wave_vectors=[((0.5, 0.0),), ()]).run()
    model = load_trained(tmp_path)[2]
    assert model.embedding.weight[:, -4:].tolist() == [[0.5, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0]]


def test_a_quarter_of_a_guided_stroke_is_so_steady_that_fast_ribs_keep_their_phase_and_half_of_that_is_along_a_scan() -> None:
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


RATE_HZ = 2000
VECTOR = (0.5, 0.3)


def _stroke(seconds: float, speed_mps: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Back and forth along the first axis: motion [n, 3] and place in mm [n, 2]."""
    time = np.arange(round(seconds * RATE_HZ)) / RATE_HZ
    velocity = speed_mps * np.sin(2.0 * np.pi * 0.25 * time)
    motion = np.stack([velocity, 0.0 * time, 1.0 + 0.0 * time], axis=1)
    return motion, np.cumsum(motion[:, :2], axis=0) * 1000.0 / RATE_HZ


@pytest.mark.parametrize("offset", [-0.4, 0.0, 0.3])
def test_the_phase_of_ribs_is_found_wherever_a_recording_begins_and_while_it_drifts(offset: float) -> None:
    rng = np.random.default_rng(5)
    motion, place = _stroke(8.0, 0.2)
    true = offset + 0.1 * np.sin(2.0 * np.pi * 0.1 * np.arange(len(place)) / RATE_HZ)
    wave = np.cos(2.0 * np.pi * (place @ np.array(VECTOR) + true)) + 0.7 * rng.standard_normal(len(place))
    found = rib_phase_turns(wave, motion, place, VECTOR)
    moving = np.abs(motion[:, 0]) > 0.05
    missed = np.angle(np.exp(2j * np.pi * (found - true)))[moving] / (2.0 * np.pi)
    assert np.sqrt(np.mean(missed**2)) < 0.03


@pytest.mark.parametrize("rate_hz", [60.0, -60.0, 180.0])
def test_a_followed_phase_becomes_the_one_at_which_the_skeleton_s_fundamental_is_a_cosine_of_it(rate_hz: float) -> None:
    torch.manual_seed(3)
    skeleton = Skeleton((16, 16))
    with torch.no_grad():
        skeleton.perceptron.layers[-1].bias.normal_(0.0, 0.3)
    model = SkeletonModel(wave_vectors=[[VECTOR]], level=LevelModel(16), skeleton=skeleton)
    losses = SkeletonLosses(model, ribs_followed=True)
    # The first family alone, with the phase 0.2 turns at the first sample.
    plain = torch.zeros(1, 2 * FAMILIES)
    plain[0, 0], plain[0, FAMILIES] = 0.2, rate_hz
    samples = (torch.arange(200.0) + 0.5) / RATE_HZ
    path = torch.zeros(1, FAMILIES, 200)
    path[0, 0] = 0.2 + rate_hz * samples
    followed = with_path(plain, path)
    embedding, motion = torch.randn(1, EMBEDDING_SIZE), torch.tensor([[0.1, 0.0, 1.0]])
    aligned = losses._aligned(followed, embedding, motion)
    gains = skeleton.gains(embedding, motion, aligned)
    # The fundamental alone, driven for long: a filter's answer to a line, by the filter itself.
    angle = 2.0 * math.pi * path_of(aligned)[0, 0] * math.copysign(1.0, rate_hz)
    step = 2.0 * math.pi * abs(rate_hz) / RATE_HZ
    past = angle[0] + step * torch.arange(-3000.0, 0.0)
    drive = sum(
        gains.lines[0, 0, part, 0, 0] * turned(torch.cat([past, angle]).double())
        for part, turned in enumerate((torch.cos, torch.sin))
    )
    wave = np.zeros(len(drive) + 24)
    coefficients = gains.coefficients[0].detach().double().numpy()
    for n, value in enumerate(drive.detach().numpy()):
        wave[n + 24] = value - coefficients @ wave[n : n + 24][::-1]
    ended = wave[-200:]
    stated = math.copysign(1.0, rate_hz) * path_of(followed)[0, 0].double().numpy()
    line = np.mean(ended * np.exp(-2j * np.pi * stated))
    assert abs(np.angle(line)) < 0.05 and abs(line) > 1e-3


def test_what_the_recorder_states_is_left_as_it_is() -> None:
    model = SkeletonModel(wave_vectors=[[VECTOR]], level=LevelModel(16), skeleton=Skeleton((16, 16)))
    assert not SkeletonLosses(model).ribs_followed
