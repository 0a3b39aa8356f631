"""Burg's method against filters that are known."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.signal
import torch

from haptoflow_training.models.all_pole_filter import PredictedFilter, burg_distance, burg_reflection, step_up

REFLECTION = torch.tensor([[-0.85, 0.7, -0.3, 0.2, 0.4]])


def _noise_through(reflection: torch.Tensor, rows: int, samples: int) -> torch.Tensor:
    """[rows, samples] of unit RMS."""
    coefficients = np.concatenate([[1.0], step_up(reflection)[0].numpy()])
    noise = np.random.default_rng(5).standard_normal((rows, samples + 2000))
    wave = scipy.signal.lfilter([1.0], coefficients, noise)[:, 2000:]
    return torch.from_numpy(wave / wave.std()).float()


def test_the_reflection_coefficients_of_a_known_filter_are_found_with_the_sign_of_step_up() -> None:
    found = burg_reflection(_noise_through(REFLECTION, 1, 100_000), 8)
    torch.testing.assert_close(found[:, :5], REFLECTION, rtol=0.0, atol=0.015)
    assert found[:, 5:].abs().max() < 0.02, "orders beyond the filter's have nothing to add"


@pytest.mark.parametrize("frequency_hz", [20.0, 150.0, 900.0])
def test_a_pure_tone_gives_a_stable_filter_and_silence_none(frequency_hz: float) -> None:
    tone = torch.sin(2.0 * torch.pi * frequency_hz * torch.arange(200.0) / 2000.0)
    found = burg_reflection(torch.stack([tone, torch.zeros(200)]), 24)
    assert torch.isfinite(found).all() and found.abs().max() <= 1.0 + 1e-5
    assert found[0].abs().max() > 0.9 and found[1].abs().max() == 0.0
    distance = burg_distance(torch.zeros(2, 25), torch.stack([tone, torch.zeros(200)]))
    assert torch.isfinite(distance).all() and distance[1] == 0.0


def test_what_is_at_no_distance_predicts_the_filter_and_its_level() -> None:
    wave = _noise_through(REFLECTION, 1, 50_000)
    raw = torch.cat([torch.atanh(burg_reflection(wave, 5)), torch.zeros(1, 1)], dim=1)
    assert burg_distance(raw, wave).item() == pytest.approx(0.0, abs=1e-8)
    assert burg_distance(raw + 0.1, wave).item() == pytest.approx(6 * 0.01, rel=1e-3)
    coefficients, log_gain = PredictedFilter(5, 1.0)(raw)
    torch.testing.assert_close(coefficients, step_up(REFLECTION), rtol=0.0, atol=0.05)
    made = scipy.signal.lfilter([log_gain.exp().item()], np.concatenate([[1.0], coefficients[0]]),
                                np.random.default_rng(6).standard_normal(50_000))  # fmt: skip
    assert made.std() == pytest.approx(1.0, rel=0.05)
