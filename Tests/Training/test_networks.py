"""Shapes, conditioning and scale of velocity field and level model."""

from __future__ import annotations

import dataclasses
import re
from pathlib import Path

import onnx
import pytest
import torch
from torch import nn

from haptoflow_paper.codec.representation import CodecRepresentation, build_representation
from haptoflow_paper.codec.small_codec import SmallCodec, SmallCodecShape
from haptoflow_paper.rivals import ARCHITECTURES
from haptoflow_paper.runs.tier import export_level_model, network_graph
from haptoflow_paper.runs.velocity_field import IMPULSE_GAINS as GAINS, BandLimit, ContinuousImpulses, VelocityField
from haptoflow_training.export.trained_tier import tier_of
from haptoflow_training.models.conditioning import EMBEDDING_SIZE, MotionFeatures
from haptoflow_training.models.level_model import LevelModel, level_loss
from haptoflow_training.models.skeleton import ATOMS, NOISE_BEFORE, TAIL_THRESHOLDS, TAPS, THRESHOLDS, TailImpulses
from haptoflow_training.training.config import TrainingConfig, load_config
from haptoflow_training.training.trainer import build_model
from paper_samples import evaluated
from places import ROOT

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


@pytest.mark.parametrize("levels", [1, 2])
def test_every_input_affects_the_velocity_field_s_output(levels: int) -> None:
    field = _trained_like(VelocityField(width=32, levels=levels))
    inputs = _inputs(2)
    before = field(**inputs)
    for name in inputs:
        changed = dict(inputs, **{name: inputs[name] + 0.3})
        assert not torch.allclose(field(**changed), before, atol=1e-5), name


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


def test_the_level_model_learns_a_power_law_of_speed_and_force() -> None:
    torch.manual_seed(0)
    model = LevelModel()
    embedding = torch.randn(1, EMBEDDING_SIZE)
    optimiser = torch.optim.Adam(model.parameters(), lr=3e-3)
    for _ in range(400):
        speed, force = 0.02 * 30.0 ** torch.rand(64), 0.3 * 10.0 ** torch.rand(64)
        motion = torch.stack([speed, torch.zeros(64), force], dim=1)
        target = (2.0 * speed * force**0.3).unsqueeze(1)
        loss = level_loss(model(embedding.expand(64, -1), motion), target.square()).mean()
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


CONFIGS = ROOT / "Training" / "configs"
NO_RIBS: list[list[tuple[float, float]]] = [[], []]


def _allowed_operators() -> set[str]:
    text = (ROOT / "Documentation~" / "model-format.md").read_text(encoding="utf-8")
    block = re.search(r"### Operators\n+```\n(.*?)```", text, re.DOTALL)
    assert block is not None
    return set(block[1].split())


def _check(graph: bytes) -> None:
    model = onnx.load_from_string(graph)
    assert [(entry.domain, entry.version) for entry in model.opset_import] == [("", 16)]
    assert not model.functions
    used = {node.op_type for node in model.graph.node}
    assert used
    assert used <= _allowed_operators()


@pytest.mark.parametrize("kind", ["flow", "average-velocity", "direct"])
def test_every_kind_of_field_uses_only_listed_operators(kind: str) -> None:
    base = load_config(ROOT / "Training" / "haptoflow_paper" / "configs" / "field.toml")
    for levels in (1, 2):
        config = dataclasses.replace(base, model=dataclasses.replace(base.model, levels=levels))
        if kind == "average-velocity":
            config = evaluated(config, recipe={"objective": kind, "energy_steps": 0})
        model = build_model(config, NO_RIBS)
        _check(network_graph(model, kind))
    _check(export_level_model(model.level))


@pytest.mark.parametrize("size", ["draft", "standard"])
def test_the_refinements_in_shipped_sizes_use_only_listed_operators(size: str) -> None:
    config = load_config(CONFIGS / "default" / f"{size}.toml")
    (graph,) = tier_of(config, ["a", "b"], build_model(config, NO_RIBS)).graphs().values()
    _check(graph)


@pytest.mark.parametrize("architecture", ARCHITECTURES)
def test_every_rival_uses_only_listed_operators(architecture: str) -> None:
    base = load_config(ROOT / "Training" / "haptoflow_paper" / "configs" / "plain.toml")
    config: TrainingConfig = dataclasses.replace(base, model=dataclasses.replace(base.model, architecture=architecture))
    _check(network_graph(build_model(config, NO_RIBS), "direct"))


def test_every_codec_uses_only_listed_operators(tmp_path: Path) -> None:
    codec = SmallCodec(SmallCodecShape(latent_channels=12, width=8))
    codec.normaliser.fit(codec.encoder(torch.randn(64, 1, 200)).detach())
    codec.save(tmp_path / "small.pt")
    for settings in (
        {"kind": "small-codec", "checkpoint": str(tmp_path / "small.pt")}, {"kind": "encodec", "random_weights": True}
    ):
        representation = build_representation(settings)
        assert isinstance(representation, CodecRepresentation)
        representation.export_encoder(tmp_path / "encoder.onnx")
        representation.export_decoder(tmp_path / "decoder.onnx")
        for name in ("encoder.onnx", "decoder.onnx"):
            _check((tmp_path / name).read_bytes())


def _tail_gains(seed: int) -> torch.Tensor:
    return torch.randn(1, 2, len(TAIL_THRESHOLDS), ATOMS, generator=torch.Generator().manual_seed(seed))


@pytest.mark.parametrize(("excess", "tail"), [(4.5, 0), (-4.5, 1)])
def test_each_tail_rings_with_its_own_kernels(excess: float, tail: int) -> None:
    impulses, gains = TailImpulses(), _tail_gains(3)
    noise = torch.zeros(1, 1, NOISE_BEFORE + 200)
    noise[0, 0, NOISE_BEFORE + 60] = excess
    size = (abs(excess) - torch.tensor(TAIL_THRESHOLDS)) * impulses.scales.flatten()[: len(TAIL_THRESHOLDS)]
    ring = (size.unsqueeze(1) * (gains[0, tail] @ impulses.atoms)).sum(dim=0) * (1.0 if excess > 0.0 else -1.0)
    expected = torch.zeros(200)
    expected[60 : 60 + TAPS] = ring
    torch.testing.assert_close(impulses(noise, gains.reshape(1, -1))[0, 0], expected, rtol=1e-4, atol=1e-4)
    other = gains.clone()
    other[0, 1 - tail] = 0.0
    assert torch.equal(impulses(noise, gains.reshape(1, -1)), impulses(noise, other.reshape(1, -1)))


class _SameRungs(TailImpulses):
    thresholds = THRESHOLDS


def test_tails_with_equal_kernels_are_the_impulses_of_a_network() -> None:
    noise = 1.6 * torch.randn(4, 1, 200, generator=torch.Generator().manual_seed(5))
    same = torch.randn(1, GAINS, generator=torch.Generator().manual_seed(6))
    network = ContinuousImpulses()(noise, same.expand(4, -1))
    both = _SameRungs()(nn.functional.pad(noise, (NOISE_BEFORE, 0)), same.repeat(4, 2))
    torch.testing.assert_close(both, network, rtol=1e-4, atol=1e-4)
    assert network.square().mean() > 0.1
