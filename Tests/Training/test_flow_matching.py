"""Flow matching and its solvers, compared with fields whose integral is known."""

from __future__ import annotations

import math

import pytest
import torch

from haptoflow_paper.runs.flow_matching import flow_matching_loss, solve


def test_the_loss_is_zero_for_the_true_velocity() -> None:
    target = torch.full((8, 1, 200), 2.0)

    def field(state: torch.Tensor, time: torch.Tensor) -> torch.Tensor:
        return (target - state) / (1.0 - time.unsqueeze(-1))

    assert flow_matching_loss(field, target, torch.Generator().manual_seed(0)).item() < 1e-6


def test_the_loss_of_a_zero_field_is_the_power_of_target_and_noise() -> None:
    target = torch.full((512, 1, 200), 3.0)
    loss = flow_matching_loss(lambda state, time: torch.zeros_like(state), target, torch.Generator().manual_seed(0))
    assert loss.item() == pytest.approx(10.0, rel=0.02)


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
