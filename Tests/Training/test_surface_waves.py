"""Waves fixed to the surface: harmonics of ribs and of stick-slip from their phases and rates."""

from __future__ import annotations

import math

import pytest
import torch

from haptoflow_training.models.surface_waves import (
    RATE_FEATURES,
    SurfaceWaves,
    advanced,
    rate_features,
    with_path,
)


def _phases(turns: tuple[float, float, float], rates_hz: tuple[float, float, float]) -> torch.Tensor:
    return torch.tensor([[*turns, *rates_hz]])


def test_every_family_has_the_cosines_and_sines_of_its_harmonics_from_half_a_sample_on() -> None:
    cosines, sines = SurfaceWaves(5, 700.0)(_phases((0.1, 0.45, 0.8), (30.0, 77.0, 12.5)))
    assert cosines.shape == sines.shape == (1, 3, 5, 200)
    time = (torch.arange(200) + 0.5) / 2000.0
    for family, (turns, rate) in enumerate(((0.1, 30.0), (0.45, 77.0), (0.8, 12.5))):
        for order in (1, 2, 5):
            angle = 2.0 * math.pi * order * (turns + rate * time)
            torch.testing.assert_close(cosines[0, family, order - 1], angle.cos(), rtol=0.0, atol=2e-4)
            torch.testing.assert_close(sines[0, family, order - 1], angle.sin(), rtol=0.0, atol=2e-4)


def test_the_phase_is_counted_in_the_direction_of_motion_so_that_the_way_back_meets_the_same_ribs_backwards() -> None:
    waves = SurfaceWaves(3, 700.0)
    there = waves(_phases((0.2, 0.0, 0.0), (40.0, 0.0, 0.0)))
    # The way back begins at the place where the way there ends; ribs lie the other way round, so sines change sign.
    end = 0.2 + 40.0 * 200.0 / 2000.0
    back = waves(_phases((end % 1.0, 0.0, 0.0), (-40.0, 0.0, 0.0)))
    torch.testing.assert_close(back[0][0, 0], torch.flip(there[0][0, 0], [1]), rtol=0.0, atol=1e-3)
    torch.testing.assert_close(back[1][0, 0], -torch.flip(there[1][0, 0], [1]), rtol=0.0, atol=1e-3)
    assert there[1][0, 0].abs().max() > 0.9


def test_the_place_at_every_sample_replaces_that_at_a_steady_rate() -> None:
    waves, phases = SurfaceWaves(4, 960.0), _phases((0.15, 0.6, 0.9), (35.0, -60.0, 20.0))
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
    waves, phases = SurfaceWaves(4, 960.0), _phases((0.15, 0.6, 0.9), (35.0, -60.0, 20.0))
    bent = phases[:, :3, None] + torch.linspace(0.0, 3.0, 200).square()
    first, later = with_path(phases, bent), advanced(with_path(phases, bent), samples)
    assert torch.equal(later[:, :6], advanced(phases, samples))
    for one, other in zip(waves(first), waves(later), strict=True):
        torch.testing.assert_close(other[..., : 200 - samples], one[..., samples:], rtol=0.0, atol=1e-5)
        # Beyond the segment, at the rate.
        assert (other[..., -1] - other[..., -2]).abs().max() < 14 * 2.0 * math.pi * 60.0 / 2000.0


def test_rate_features_are_zero_at_rest_and_tell_how_fast_and_which_way() -> None:
    assert rate_features(_phases((0.1, 0.2, 0.3), (0.0, 0.0, 0.0))).abs().max() == 0.0
    there, back = (rate_features(_phases((0.1, 0.2, 0.3), (sign * 5.0, 40.0, -sign * 300.0))) for sign in (1.0, -1.0))
    assert there.shape == (1, RATE_FEATURES)
    sizes, directions = there.chunk(2, dim=1)
    torch.testing.assert_close(back, torch.cat([sizes, directions * torch.tensor([-1.0, 1.0, -1.0])], dim=1))
    assert (sizes[0].diff() > 0.0).all() and (directions[0] * torch.tensor([1.0, 1.0, -1.0]) > 0.0).all()
    assert there.abs().max() < 2.0
    assert torch.equal(there, rate_features(_phases((0.7, 0.0, 0.0), (5.0, 40.0, -300.0)))), "no place"


@pytest.mark.parametrize("samples", [1, 27, 150])
def test_advanced_phases_are_those_of_a_segment_that_begins_later(samples: int) -> None:
    waves, phases = SurfaceWaves(5, 700.0), _phases((0.15, 0.6, 0.9), (35.0, -60.0, 20.0))
    later = advanced(phases, samples)
    assert torch.equal(later[:, 3:], phases[:, 3:])
    assert ((later[:, :3] >= 0.0) & (later[:, :3] <= 1.0)).all()
    for first, second in zip(waves(phases), waves(later), strict=True):
        torch.testing.assert_close(second[..., : 200 - samples], first[..., samples:], rtol=0.0, atol=1e-3)
        assert (second[..., samples:] - first[..., samples:]).abs().max() > 0.01
