"""All-pole filters from predictions: exact, continuing a past, stable, of limited resonance whatever is predicted."""

from __future__ import annotations

import math

import numpy as np
import pytest
import scipy.signal
import torch

from haptoflow_training.models.all_pole_filter import (
    LOG_RESONANCE_LIMIT, AllPoleFilter, PredictedFilter, burg_distance, burg_reflection, prediction_errors, step_up
)

def _filters(rows: int, order: int, seed: int) -> torch.Tensor:
    """Coefficients [rows, order] of stable filters."""
    generator = torch.Generator().manual_seed(seed)
    return step_up(0.7 * torch.tanh(torch.randn(rows, order, generator=generator)))


def _sample_by_sample(drive: np.ndarray, coefficients: np.ndarray, past: np.ndarray) -> np.ndarray:
    """x_t = drive_t - sum a_i x_(t-i), of one row, in double precision."""
    wave = list(past)
    for now in drive:
        wave.append(now - sum(a * wave[-i] for i, a in enumerate(coefficients, start=1)))
    return np.array(wave[len(past) :])


@pytest.mark.parametrize("order", [1, 16, 24, 25])
def test_the_block_filter_is_a_loop_over_samples_that_continues_the_past(order: int) -> None:
    generator = torch.Generator().manual_seed(7)
    coefficients = _filters(4, order, 6)
    drive, past = torch.randn(4, 200, generator=generator), torch.randn(4, order, generator=generator)
    wave = AllPoleFilter(order)(drive, coefficients, past)
    for row in range(4):
        expected = _sample_by_sample(*(part[row].double().numpy() for part in (drive, coefficients, past)))
        assert np.abs(wave[row].numpy() - expected).max() < 1e-4 * max(1.0, np.abs(expected).max())
    assert (wave - AllPoleFilter(order)(drive, coefficients, torch.zeros_like(past)))[:, 0].abs().min() > 1e-4


def test_step_up_puts_every_pole_inside_the_unit_circle() -> None:
    generator = torch.Generator().manual_seed(8)
    reflection = torch.tanh(torch.randn(20, 24, generator=generator, dtype=torch.float64))
    for coefficients in step_up(reflection).numpy():
        assert np.abs(np.roots(np.concatenate([[1.0], coefficients]))).max() < 1.0


def test_step_up_is_levinson_s_recursion() -> None:
    # By hand: a1 = k1; then a1 + k2 a1, k2.
    torch.testing.assert_close(step_up(torch.tensor([[0.5, -0.2]])), torch.tensor([[0.4, -0.2]]))


def test_noise_and_waveform_differ_by_50_db_at_most_and_a_mild_filter_is_left_as_it_is() -> None:
    predicted = PredictedFilter(24)
    mild, wild = torch.zeros(1, 25), torch.full((1, 25), 30.0)
    mild[0, :2] = torch.tensor([0.8, -0.4])
    coefficients, log_gain = predicted(torch.cat([mild, wild]))
    decibels = 20.0 / math.log(10.0)
    over_the_noise_db = decibels * (2.0 * math.tanh(15.0) - log_gain[1].item())
    assert over_the_noise_db <= 50.0, "without a limit it would be 648 dB"
    assert LOG_RESONANCE_LIMIT * decibels == pytest.approx(50.0)
    reflection = torch.zeros(1, 24)
    reflection[0, :2] = torch.tanh(mild[0, :2])
    damped = step_up(reflection) * 0.998 ** torch.arange(1.0, 25.0)
    torch.testing.assert_close(coefficients[:1], damped)
    assert log_gain[0].item() == pytest.approx(-math.log(math.cosh(0.8) * math.cosh(0.4)), abs=1e-5)


@pytest.mark.parametrize("seed", range(4))
def test_the_last_prediction_is_the_level_of_the_waveform_which_damping_only_lowers(seed: int) -> None:
    generator = torch.Generator().manual_seed(seed)
    raw = 0.3 * torch.randn(1, 25, generator=generator)
    raw[0, 24] = 0.3
    predicted, all_pole = PredictedFilter(24), AllPoleFilter(24)
    coefficients, log_gain = predicted(raw)

    def rms(filtering: torch.Tensor) -> float:
        wave, power = torch.zeros(64, 200), []
        for _ in range(12):
            noise = torch.randn(64, 200, generator=generator)
            wave = all_pole(noise * log_gain.exp(), filtering.expand(64, -1), wave[:, -24:])
            power.append(wave.square().mean().item())
        return math.sqrt(np.mean(power[2:]))

    level = math.exp(2.0 * math.tanh(0.15))
    assert rms(coefficients / predicted.damping) == pytest.approx(level, rel=0.03)
    assert 0.7 * level < rms(coefficients) < level


def test_prediction_errors_are_the_drive_that_made_the_waveform() -> None:
    generator = torch.Generator().manual_seed(9)
    coefficients = _filters(3, 24, 5)
    drive, past = torch.randn(3, 200, generator=generator), torch.randn(3, 24, generator=generator)
    wave = AllPoleFilter(24)(drive, coefficients, past)
    errors = prediction_errors(torch.cat([past, wave], dim=1), coefficients)
    torch.testing.assert_close(errors, drive, rtol=0.0, atol=1e-3 * wave.abs().max().item())


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
