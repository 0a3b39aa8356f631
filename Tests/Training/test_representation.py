from __future__ import annotations

from pathlib import Path
from typing import Any

import onnx
import pytest
import torch
from torch import nn

from haptoflow_paper.codec.encodec import EnCodec
from haptoflow_paper.codec.latent_normaliser import LatentNormaliser
from haptoflow_paper.codec.polyphase_resampler import PolyphaseResampler
from haptoflow_paper.codec.representation import CodecRepresentation
from haptoflow_paper.codec.representation_base import Representation, build_representation
from haptoflow_paper.codec.resampled_encodec import ResampledEnCodec
from haptoflow_paper.codec.small_codec import SmallCodec, SmallCodecShape
from haptoflow_training.errors import InputError


@pytest.fixture(scope="module")
def small_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    torch.manual_seed(4)
    codec = SmallCodec(SmallCodecShape(latent_channels=12, width=8))
    codec.normaliser.fit(codec.encoder(torch.randn(64, 1, 200)).detach())
    path = tmp_path_factory.mktemp("small") / "small-codec.pt"
    codec.save(path)
    return path


@pytest.fixture(scope="module")
def small(small_file: Path) -> CodecRepresentation:
    representation = build_representation({"kind": "small-codec", "checkpoint": str(small_file)})
    assert isinstance(representation, CodecRepresentation)
    return representation


@pytest.fixture(scope="module")
def encodec() -> CodecRepresentation:
    representation = build_representation({"kind": "encodec", "random_weights": True})
    assert isinstance(representation, CodecRepresentation)
    return representation


def _tones(frequencies_hz: tuple[float, ...]) -> torch.Tensor:
    time_seconds = torch.arange(200, dtype=torch.float64) / 2000.0
    tones = [torch.sin(2.0 * torch.pi * frequency_hz * time_seconds + 0.7) for frequency_hz in frequencies_hz]
    return torch.stack(tones).unsqueeze(1).float()


def test_the_raw_representation_is_the_waveform_itself() -> None:
    representation = build_representation({"kind": "raw"})
    waveform = torch.randn(3, 1, 200)
    assert representation.shape == (1, 200)
    assert not representation.is_latent
    assert torch.equal(representation.decode(representation.encode(waveform)), waveform)


@pytest.mark.parametrize(("name", "shape"), [("small", (12, 25)), ("encodec", (128, 8))])
@torch.no_grad()
def test_a_codec_turns_segments_into_its_shape_and_back(
    name: str, shape: tuple[int, int], request: pytest.FixtureRequest
) -> None:
    representation: Representation = request.getfixturevalue(name)
    assert representation.shape == shape
    assert representation.is_latent
    latent = representation.encode(torch.randn(3, 1, 200))
    assert latent.shape == (3, *shape)
    waveform = representation.decode(latent)
    assert waveform.shape == (3, 1, 200)
    assert torch.isfinite(waveform).all()


@pytest.mark.parametrize("name", ["small", "encodec"])
def test_a_codec_stays_frozen_inside_a_network_that_trains(name: str, request: pytest.FixtureRequest) -> None:
    representation: CodecRepresentation = request.getfixturevalue(name)
    network = nn.ModuleDict({"representation": representation, "field": nn.Linear(2, 2)})
    network.train()
    assert network["field"].training
    assert not any(module.training for module in representation.modules())
    assert not any(parameter.requires_grad for parameter in representation.parameters())
    # Weight normalisation would recompute every weight in each call.
    assert not any(name.endswith("weight_g") for name in representation.state_dict())


def test_gradients_pass_through_a_frozen_decoder_to_the_latent(small: CodecRepresentation) -> None:
    latent = torch.randn(2, *small.shape, requires_grad=True)
    small.decode(latent).square().mean().backward()
    assert latent.grad is not None
    assert latent.grad.abs().max() > 0.0


@pytest.mark.parametrize("name", ["small", "encodec"])
@pytest.mark.parametrize("direction", ["encoder", "decoder"])
def test_the_exported_graph_has_opset_16_a_free_batch_and_fixed_lengths(
    name: str, direction: str, request: pytest.FixtureRequest, tmp_path: Path
) -> None:
    representation: CodecRepresentation = request.getfixturevalue(name)
    path = tmp_path / f"{direction}.onnx"
    getattr(representation, f"export_{direction}")(path)
    model = onnx.load(str(path))
    onnx.checker.check_model(model, full_check=True)
    assert [entry.version for entry in model.opset_import if entry.domain == ""] == [16]

    def shape(value: Any) -> list[str | int]:
        return [dimension.dim_param or dimension.dim_value for dimension in value.type.tensor_type.shape.dim]

    ports = {"waveform": ["batch", 1, 200], "latent": ["batch", *representation.shape]}
    source, target = ("waveform", "latent") if direction == "encoder" else ("latent", "waveform")
    assert {value.name: shape(value) for value in model.graph.input} == {source: ports[source]}
    assert {value.name: shape(value) for value in model.graph.output} == {target: ports[target]}
    operations = [node.op_type for node in model.graph.node]
    assert all(node.domain == "" for node in model.graph.node)
    assert operations.count("LSTM") == (2 if name == "encodec" else 0)


@pytest.mark.parametrize("direction", ["encoder", "decoder"])
def test_an_exported_graph_holds_every_weight_of_its_half(
    direction: str, small: CodecRepresentation, tmp_path: Path
) -> None:
    path = tmp_path / "graph.onnx"
    getattr(small, f"export_{direction}")(path)
    exported = {tuple(entry.dims) for entry in onnx.load(str(path)).graph.initializer}
    weights = {tuple(value.shape) for value in getattr(small.codec, direction).parameters()}
    assert weights <= exported


@torch.no_grad()
def test_band_noise_survives_the_way_to_24_kilohertz_and_back() -> None:
    resampler = PolyphaseResampler(12)
    tones = _tones((20.0, 60.0, 137.0, 250.0, 450.0))
    restored = resampler.downsample(resampler.upsample(tones))
    noise = (restored - tones).square().mean(dim=(1, 2)) / tones.square().mean(dim=(1, 2))
    assert (10.0 * torch.log10(noise)).max() < -45.0


@torch.no_grad()
def test_upsampling_keeps_the_samples_and_adds_no_delay() -> None:
    resampler = PolyphaseResampler(12)
    tones = _tones((50.0, 437.0, 800.0))
    raised = resampler.upsample(tones)
    assert raised.shape == (3, 1, 2400)
    torch.testing.assert_close(raised[..., ::12], tones, atol=5e-4, rtol=0.0)
    # Between the samples the tone must continue as a tone.
    fine_seconds = torch.arange(2400, dtype=torch.float64) / 24000.0
    expected = torch.sin(2.0 * torch.pi * 437.0 * fine_seconds + 0.7).float()
    torch.testing.assert_close(raised[1, 0, 400:2000], expected[400:2000], atol=2e-3, rtol=0.0)


@torch.no_grad()
def test_downsampling_removes_what_would_alias() -> None:
    fine_seconds = torch.arange(2400, dtype=torch.float64) / 24000.0
    tone = torch.sin(2.0 * torch.pi * 3300.0 * fine_seconds).float().reshape(1, 1, -1)
    assert PolyphaseResampler(12).downsample(tone)[..., 20:-20].abs().max() < 2e-3


class _Recorder(nn.Module):
    """Replaces EnCodec: stores the 24 kHz waveform and returns it."""

    def encode(self, waveform: torch.Tensor) -> torch.Tensor:
        self.heard = waveform
        return torch.zeros(waveform.shape[0], 128, 8)

    def decode(self, latent: torch.Tensor, samples: int) -> torch.Tensor:
        return self.heard[..., :samples]


def test_the_input_scale_of_encodec_is_undone_in_its_output() -> None:
    recorder = _Recorder()
    codec = ResampledEnCodec(recorder, waveform_scale=0.2)  # type: ignore[arg-type]
    tone = _tones((100.0,))
    restored = codec.decode(codec.encode(tone))
    assert recorder.heard.abs().max() == pytest.approx(0.2, rel=0.01)
    torch.testing.assert_close(restored, tone, atol=0.02, rtol=0.0)


def test_encodec_needs_weights_or_an_explicit_request_for_random_ones() -> None:
    with pytest.raises(InputError, match="expected either checkpoint"):
        build_representation({"kind": "encodec"})
    with pytest.raises(InputError, match="expected either checkpoint"):
        build_representation({"kind": "encodec", "random_weights": True, "checkpoint": "a.th"})


@torch.no_grad()
def test_encodec_from_a_checkpoint_with_latent_statistics_equals_its_parts(tmp_path: Path) -> None:
    torch.manual_seed(6)
    codec = ResampledEnCodec(EnCodec().eval(), waveform_scale=0.2)
    waveforms = torch.randn(8, 1, 200)
    torch.save(codec.codec.state_dict(), tmp_path / "encodec.th")
    codec.fit_normaliser(waveforms)
    codec.normaliser.save(tmp_path / "latents.pt")
    built = build_representation(
        {
            "kind": "encodec",
            "checkpoint": str(tmp_path / "encodec.th"),
            "waveform_scale": 0.2,
            "latent_statistics": str(tmp_path / "latents.pt"),
        }
    )
    latent = built.encode(waveforms)
    torch.testing.assert_close(latent, codec.encode(waveforms), atol=1e-4, rtol=1e-4)
    torch.testing.assert_close(latent.std(dim=(0, 2)), torch.ones(128), atol=1e-3, rtol=0.0)
    torch.testing.assert_close(built.decode(latent), codec.decode(latent), atol=1e-4, rtol=1e-4)


def test_the_normaliser_and_its_inverse_cancel_and_an_unused_channel_is_not_amplified() -> None:
    latents = torch.randn(64, 3, 25) * torch.tensor([2.0, 0.5, 0.0]).reshape(1, 3, 1) + 4.0
    normaliser = LatentNormaliser(3)
    normaliser.fit(latents)
    normalised = normaliser(latents)
    torch.testing.assert_close(normaliser.inverse(normalised), latents)
    torch.testing.assert_close(normalised.std(dim=(0, 2)), torch.tensor([1.0, 1.0, 0.0]), atol=1e-4, rtol=0.0)
    assert torch.isfinite(normalised).all()


@pytest.mark.parametrize(
    ("config", "message"),
    [
        ({}, "kind = None, expected one of encodec, raw, small-codec"),
        ({"kind": "opus"}, "kind = 'opus'"),
        ({"kind": "raw", "checkpoint": "a.pt"}, "'raw': checkpoint is unknown"),
        ({"kind": "small-codec"}, "'small-codec': checkpoint is missing"),
        ({"kind": "small-codec", "checkpoint": 3}, "checkpoint = 3, expected text"),
        ({"kind": "small-codec", "checkpoint": "absent.pt"}, "absent.pt: no such file"),
        ({"kind": "encodec", "random_weights": 1}, "random_weights = 1, expected true or false"),
        ({"kind": "encodec", "random_weights": True, "waveform_scale": 0}, "waveform_scale = 0, expected"),
    ],
)
def test_a_wrong_representation_table_names_the_key(config: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        build_representation(config)
