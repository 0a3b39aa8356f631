"""Rare events from Gaussian noise: rate, strength, ringing, and whether a field can learn them."""

from __future__ import annotations

import pytest
import torch

from haptoflow_training.models.rung_impulses import ATOMS, GAINS, RUNGS, TAPS, RungImpulses
from haptoflow_training.models.velocity_field import VelocityField


def _only(rung: int, atom: int) -> torch.Tensor:
    gains = torch.zeros(1, len(RUNGS), ATOMS)
    gains[0, rung, atom] = 1.0
    return gains.reshape(1, GAINS)


@pytest.mark.parametrize("rung", range(len(RUNGS)))
def test_a_rung_passes_only_the_tails_of_the_noise_with_power_one(rung: int) -> None:
    noise = torch.randn(16000, 1, 200, generator=torch.Generator().manual_seed(rung))
    struck = RungImpulses()(noise, _only(rung, 0).expand(len(noise), GAINS))
    assert ((struck != 0.0) == (noise.abs() > RUNGS[rung])).all()
    assert struck.square().mean().item() == pytest.approx(1.0, rel=0.15)
    assert struck.mean().item() == pytest.approx(0.0, abs=0.01)


def test_each_event_rings_with_its_kernel_and_only_after_its_start() -> None:
    impulses = RungImpulses()
    for place in (0, 24, 25, 130, 199):
        noise = torch.zeros(1, 1, 200)
        noise[0, 0, place] = -4.0
        gains = torch.randn(1, GAINS, generator=torch.Generator().manual_seed(place))
        kernels = gains.reshape(len(RUNGS), ATOMS) @ impulses.atoms
        size = -(4.0 - impulses.rungs.flatten()) * impulses.scales.flatten()
        ring = (size.unsqueeze(1) * kernels).sum(dim=0)
        expected = torch.zeros(200)
        expected[place : place + TAPS] = ring[: 200 - place]
        torch.testing.assert_close(impulses(noise, gains)[0, 0], expected, rtol=1e-4, atol=1e-4)


def test_rows_have_their_own_impulse_gains_and_zero_gains_give_zero() -> None:
    noise = torch.randn(3, 1, 200, generator=torch.Generator().manual_seed(1))
    gains = torch.cat([_only(0, 3), torch.zeros(1, GAINS), _only(1, 5)])
    together = RungImpulses()(noise, gains)
    assert together[1].abs().max().item() == 0.0
    alone = RungImpulses()(noise[2:], gains[2:])
    torch.testing.assert_close(together[2:], alone)


def test_a_field_starts_without_impulses_and_learns_those_of_its_condition() -> None:
    field = VelocityField(width=16, previous_width=8, impulses=True)
    noise = torch.randn(1, 1, 200, generator=torch.Generator().manual_seed(2))
    arguments = (noise, torch.zeros(1, 1), torch.zeros(1, 1, 200), torch.zeros(1, 64), torch.zeros(1, 3))
    assert field(*arguments).abs().max().item() == 0.0
    assert field.impulse_gains is not None
    with torch.no_grad():
        field.impulse_gains.bias[0] = 0.5
    made = field(*arguments)[0, 0]
    assert (made != 0.0).sum().item() == (noise.abs() > RUNGS[0]).sum().item()
