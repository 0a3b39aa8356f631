"""The loss on mean spectra and moments by label and speed: its value, and what it trains."""

from __future__ import annotations

import math

import pytest
import torch

from haptoflow_training.models.rib_comb import PARTIALS
from haptoflow_training.training.energy_distance import spectra
from haptoflow_training.training.label_balance import LabelBalance, LabelFeatures, label_features

ROWS = 32
_MOMENTS = slice(101 + PARTIALS + 8, None)


def _features(wave: torch.Tensor, ribs_hz: tuple[float, float] = (0.0, 0.0)) -> LabelFeatures:
    """Features of waveforms [B, 400]."""
    nothing = torch.zeros(len(wave), 2, PARTIALS)
    ribs = torch.tensor([ribs_hz] * len(wave))
    heard = spectra(wave[:, :200], wave[:, 200:])
    return label_features(heard, ribs, nothing, nothing[:, 0], wave[:, 200:])


def _noise(generator: torch.Generator, shape: torch.Tensor) -> torch.Tensor:
    """Rows of noise, [B, 400], with magnitudes [B, 201]."""
    return torch.fft.irfft(torch.fft.rfft(torch.randn(len(shape), 400, generator=generator)) * shape, 400)


def _heard(
    balance: LabelBalance, label: torch.Tensor, speed_mps: float, recorded: torch.Tensor, *drawn: torch.Tensor
) -> torch.Tensor:
    first, second = (_features(wave) for wave in drawn)
    speeds = torch.full(label.shape, speed_mps)
    return balance.loss(label, speeds, _features(recorded), (first, second), torch.ones(len(label)))


def test_a_network_with_a_gain_for_each_label_and_frequency_learns_the_recordings_mean_spectra() -> None:
    generator = torch.Generator().manual_seed(1)
    balance = LabelBalance(2)
    frequency = torch.arange(201) / 200.0
    truth = torch.stack([1.0 + (-(((frequency - 0.3) / 0.05) ** 2)).exp(), 1.5 - frequency])
    gains = torch.zeros(2, 201, requires_grad=True)
    optimiser = torch.optim.Adam([gains], lr=0.02)
    label = torch.arange(ROWS) % 2
    for step in range(400):
        optimiser.param_groups[0]["lr"] = 0.02 if step < 250 else 0.004
        drawn = [_noise(generator, gains.exp()[label]) for _ in range(2)]
        optimiser.zero_grad()
        _heard(balance, label, 0.2, _noise(generator, truth[label]), *drawn).backward()
        optimiser.step()
    error_db = 20.0 / math.log(10.0) * (gains.detach() - truth.log())
    smooth = torch.nn.functional.avg_pool1d(error_db.unsqueeze(1), 9, stride=1)[:, 0, 4:-4]
    assert smooth.abs().mean().item() < 0.4
    assert smooth.abs().max().item() < 1.5


def test_the_balance_loss_is_half_the_squared_log_error_and_its_gradient_is_the_batch_s_share() -> None:
    balance, generator = LabelBalance(1), torch.Generator().manual_seed(2)
    label, flat = torch.zeros(ROWS, dtype=torch.long), torch.ones(ROWS, 201)
    gain = torch.tensor(1.25, requires_grad=True)
    loss = torch.zeros(())
    for _ in range(20):
        waves = [_noise(generator, flat) for _ in range(3)]
        loss = _heard(balance, label, 0.2, waves[0], gain * waves[1], gain * waves[2])
    # No lines and no ribs: two of four kinds of features apply; half of the moments grow with the gain, half with its
    # third power.
    assert loss.item() == pytest.approx(0.5 * math.log(1.25) ** 2 * (1.0 + 0.5 * (1.0 + 9.0)), rel=0.15)
    (slope,) = torch.autograd.grad(loss, gain)
    assert slope.item() == pytest.approx(math.log(1.25) / 1.25 * (1.0 + 0.5 * (1.0 + 9.0)), rel=0.15)


def test_labels_and_speeds_are_averaged_separately_and_too_few_segments_give_no_loss() -> None:
    balance, generator = LabelBalance(2), torch.Generator().manual_seed(3)
    label, flat = torch.zeros(ROWS, dtype=torch.long), torch.ones(ROWS, 201)

    def loss(label: torch.Tensor, speed_mps: float, gain: float) -> float:
        rows = flat[: len(label)]
        waves = [_noise(generator, rows) for _ in range(3)]
        return _heard(balance, label, speed_mps, waves[0], gain * waves[1], gain * waves[2]).item()

    for _ in range(10):
        assert loss(label, 0.05, 2.0) > 0.15
        assert loss(label, 0.2, 1.0) < 0.05
        assert loss(label + 1, 0.05, 1.0) < 0.05
    assert loss(label[:4], 0.9, 2.0) == 0.0


def test_rare_impacts_differ_from_noise_of_equal_power_in_their_moments_and_their_rate_can_be_learnt() -> None:
    generator = torch.Generator().manual_seed(5)

    def blows(share: torch.Tensor) -> torch.Tensor:
        """Even noise and rare impacts by share of power, [32, 400]."""
        rare = torch.randn(ROWS, 400, generator=generator)
        rare = rare * (torch.rand(ROWS, 400, generator=generator) < 0.02) / 0.02**0.5
        return share.sqrt() * rare + (1.0 - share).sqrt() * torch.randn(ROWS, 400, generator=generator)

    even, rare = (_features(blows(torch.tensor(share))).values[:, _MOMENTS].mean(dim=0) for share in (0.0, 0.6))
    assert (rare / even)[0].item() < 0.9 and (rare / even)[1].item() > 1.5

    balance, label = LabelBalance(1), torch.zeros(ROWS, dtype=torch.long)
    share = torch.tensor(0.1, requires_grad=True)
    optimiser = torch.optim.Adam([share], lr=0.02)
    for _ in range(250):
        optimiser.zero_grad()
        drawn = blows(share), blows(share)
        _heard(balance, label, 0.2, blows(torch.tensor(0.6)), *drawn).backward()
        optimiser.step()
    assert share.item() == pytest.approx(0.6, abs=0.12)
