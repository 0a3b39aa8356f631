from __future__ import annotations

from pathlib import Path
from typing import Any

import onnx
import pytest
import torch

from haptoflow_paper.codec.encodec import EnCodec, ResampledEnCodec
from haptoflow_paper.codec.representation import CodecRepresentation, Representation, build_representation
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
