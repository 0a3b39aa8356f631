"""Waves fixed to the surface: harmonics of ribs and of stick-slip from their phases and rates."""

from __future__ import annotations

import math

import pytest
import torch

from haptoflow_training.models.surface_waves import SurfaceWaves, advanced


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


@pytest.mark.parametrize("rate_hz", [0.0, 0.49, -0.49])
def test_a_family_below_half_a_hertz_is_silent(rate_hz: float) -> None:
    cosines, sines = SurfaceWaves(5, 700.0)(_phases((0.3, 0.3, 0.3), (rate_hz, 0.6, -0.6)))
    assert cosines[0, 0].abs().max() == sines[0, 0].abs().max() == 0.0
    assert (cosines[0, 1:].abs().amax(dim=2) > 0.0).all()


def test_harmonics_at_or_above_the_band_are_silent_and_those_below_it_are_not() -> None:
    cosines, sines = SurfaceWaves(5, 700.0)(_phases((0.0, 0.0, 0.0), (175.0, -349.0, 701.0)))
    alive = (cosines.abs().amax(dim=3) + sines.abs().amax(dim=3))[0] > 0.0
    assert alive.sum(dim=1).tolist() == [3, 2, 0]


def test_samples_before_the_segment_belong_to_the_same_waves() -> None:
    phases = _phases((0.15, 0.6, 0.9), (35.0, -60.0, 20.0))
    alone, before = SurfaceWaves(4, 960.0)(phases), SurfaceWaves(4, 960.0, first_sample=-24)(phases)
    for short, long in zip(alone, before, strict=True):
        assert long.shape[-1] == 224
        torch.testing.assert_close(long[..., 24:], short)


@pytest.mark.parametrize("samples", [1, 27, 150])
def test_advanced_phases_are_those_of_a_segment_that_begins_later(samples: int) -> None:
    waves, phases = SurfaceWaves(5, 700.0), _phases((0.15, 0.6, 0.9), (35.0, -60.0, 20.0))
    later = advanced(phases, samples)
    assert torch.equal(later[:, 3:], phases[:, 3:])
    assert ((later[:, :3] >= 0.0) & (later[:, :3] <= 1.0)).all()
    for first, second in zip(waves(phases), waves(later), strict=True):
        torch.testing.assert_close(second[..., : 200 - samples], first[..., samples:], rtol=0.0, atol=1e-3)
        assert (second[..., samples:] - first[..., samples:]).abs().max() > 0.01


def test_phases_have_no_gradient_because_the_place_of_ribs_is_not_learnt() -> None:
    phases = _phases((0.1, 0.2, 0.3), (20.0, 30.0, 40.0)).requires_grad_()
    assert not any(wave.requires_grad for wave in SurfaceWaves(2, 700.0)(phases))
