"""Rare events from Gaussian noise: rate, strength, ringing, and whether a field can learn them."""

from __future__ import annotations

import pytest
import torch

from haptoflow_training.models.rung_impulses import ATOMS, GAINS, RUNGS, TAIL_RUNGS, TAPS, RungImpulses, TailImpulses


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


def _tail_gains(seed: int) -> torch.Tensor:
    return torch.randn(1, 2, len(TAIL_RUNGS), ATOMS, generator=torch.Generator().manual_seed(seed))


@pytest.mark.parametrize(("excess", "tail"), [(4.5, 0), (-4.5, 1)])
def test_each_tail_rings_with_its_own_kernels(excess: float, tail: int) -> None:
    impulses, gains = TailImpulses(), _tail_gains(3)
    noise = torch.zeros(1, 1, 200)
    noise[0, 0, 60] = excess
    size = (abs(excess) - torch.tensor(TAIL_RUNGS)) * impulses.scales.flatten()[: len(TAIL_RUNGS)]
    ring = (size.unsqueeze(1) * (gains[0, tail] @ impulses.atoms)).sum(dim=0) * (1.0 if excess > 0.0 else -1.0)
    expected = torch.zeros(200)
    expected[60 : 60 + TAPS] = ring
    torch.testing.assert_close(impulses(noise, gains.reshape(1, -1))[0, 0], expected, rtol=1e-4, atol=1e-4)
    other = gains.clone()
    other[0, 1 - tail] = 0.0
    assert torch.equal(impulses(noise, gains.reshape(1, -1)), impulses(noise, other.reshape(1, -1)))


def test_tails_with_equal_kernels_are_the_impulses_of_a_network() -> None:
    noise = 1.6 * torch.randn(4, 1, 200, generator=torch.Generator().manual_seed(5))
    same = torch.randn(1, GAINS, generator=torch.Generator().manual_seed(6))
    network = RungImpulses()(noise, same.expand(4, -1))
    both = TailImpulses(rungs=RUNGS)(noise, same.repeat(4, 2))
    torch.testing.assert_close(both, network, rtol=1e-4, atol=1e-4)
    assert network.square().mean() > 0.1
