"""Shapes, conditioning and scale of velocity field and level model."""

from __future__ import annotations

import math

import pytest
import torch

from haptoflow_paper.runs.velocity_field import BandLimit, VelocityField
from haptoflow_training.models.conditioning import EMBEDDING_SIZE, MotionFeatures
from haptoflow_training.models.level_model import LevelModel, level_loss


def _inputs(batch: int, channels: int = 1, positions: int = 200) -> dict[str, torch.Tensor]:
    generator = torch.Generator().manual_seed(5)
    return {
        "noisy": torch.randn(batch, channels, positions, generator=generator),
        "time": torch.rand(batch, 1, generator=generator),
        "previous": torch.randn(batch, channels, positions, generator=generator),
        "embedding": torch.randn(batch, EMBEDDING_SIZE, generator=generator),
        "motion": torch.rand(batch, 3, generator=generator),
    }


def _trained_like(field: VelocityField) -> VelocityField:
    """Gives weights to layers that start at zero, so that every input can affect the output."""
    torch.manual_seed(1)
    for module in field.modules():
        if isinstance(module, torch.nn.Conv2d | torch.nn.ConvTranspose2d):
            torch.nn.init.normal_(module.weight, std=0.1)
    return field.eval()


@pytest.mark.parametrize(
    ("channels", "positions", "patch"), [(1, 200, 8), (1, 200, 4), (16, 25, 1), (128, 8, 1)], ids=str
)
def test_the_field_returns_the_shape_of_its_noisy_input(channels: int, positions: int, patch: int) -> None:
    field = VelocityField(channels=channels, positions=positions, patch=patch, width=32)
    inputs = _inputs(3, channels, positions)
    assert field(**inputs).shape == inputs["noisy"].shape


@pytest.mark.parametrize("levels", [1, 2])
def test_every_input_affects_the_velocity_field_s_output(levels: int) -> None:
    field = _trained_like(VelocityField(width=32, levels=levels))
    inputs = _inputs(2)
    before = field(**inputs)
    for name in inputs:
        changed = dict(inputs, **{name: inputs[name] + 0.3})
        assert not torch.allclose(field(**changed), before, atol=1e-5), name


@pytest.mark.parametrize("levels", [1, 2])
def test_the_last_previous_sample_affects_the_whole_segment(levels: int) -> None:
    field = _trained_like(VelocityField(width=32, levels=levels))
    inputs = _inputs(1)
    moved = inputs["previous"].clone()
    moved[0, 0, -1] += 5.0
    change = (field(**dict(inputs, previous=moved)) - field(**inputs)).abs()[0, 0]
    assert (change.reshape(25, 8).amax(dim=1) > 1e-6).all()


def test_rows_of_a_batch_are_independent() -> None:
    field = _trained_like(VelocityField(width=32))
    inputs = _inputs(4)
    alone = field(**{name: value[2:3] for name, value in inputs.items()})
    torch.testing.assert_close(field(**inputs)[2:3], alone, rtol=1e-4, atol=1e-5)


def test_motion_features_are_finite_from_rest_to_twenty_metres_a_second() -> None:
    motion = torch.tensor([[0.0, 0.0, 0.0], [20.0, 0.0, 1000.0], [-1e-9, 1e-9, -3.0]])
    module = MotionFeatures()
    features = module(motion)
    assert features.shape == (3, module.size)
    assert torch.isfinite(features).all()


def test_the_level_loss_is_minimal_at_the_true_level() -> None:
    mean_square = torch.full((1, 1), 4.0)
    at_truth = level_loss(torch.full((1, 1), math.log(2.0)), mean_square)
    for offset in (-0.2, 0.2):
        assert level_loss(torch.full((1, 1), math.log(2.0) + offset), mean_square) > at_truth


def test_the_level_model_learns_a_power_law_of_speed_and_force() -> None:
    torch.manual_seed(0)
    model = LevelModel()
    embedding = torch.randn(1, EMBEDDING_SIZE)
    optimiser = torch.optim.Adam(model.parameters(), lr=3e-3)
    for _ in range(400):
        speed, force = 0.02 * 30.0 ** torch.rand(64), 0.3 * 10.0 ** torch.rand(64)
        motion = torch.stack([speed, torch.zeros(64), force], dim=1)
        target = (2.0 * speed * force**0.3).unsqueeze(1)
        loss = level_loss(model(embedding.expand(64, -1), motion), target.square())
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
    motion = torch.tensor([[0.05, 0.0, 1.0], [0.3, 0.0, 0.5], [0.5, 0.0, 2.5]])
    expected = torch.log(2.0 * motion[:, 0] * motion[:, 2] ** 0.3)
    error_decibels = 8.686 * (model(embedding.expand(3, -1), motion)[:, 0] - expected).abs()
    assert error_decibels.max() < 0.7, error_decibels


def test_the_band_limit_is_the_convolution_of_past_segment_and_mirrored_segment_with_its_taps() -> None:
    band_limit = BandLimit()
    with torch.no_grad():
        band_limit.weight.copy_(torch.randn(1, 1, 129))
    past, segment = torch.randn(2, 3, 1, 200).unbind()
    whole = torch.cat([past[:, :, -64:], segment, torch.flip(segment[:, :, -64:], [2])], dim=2)
    torch.testing.assert_close(
        band_limit(past, segment), torch.nn.functional.conv1d(whole, band_limit.weight), rtol=1e-4, atol=1e-4
    )
