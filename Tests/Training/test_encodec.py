from __future__ import annotations

import hashlib
from pathlib import Path

import pytest
import torch

from haptoflow_paper.codec.encodec import CausalConvolution, EnCodec, fold_weight_norm
from haptoflow_training.errors import InputError

# A sample of the published checkpoint's names and shapes, written out by hand.
PUBLISHED = {
    "encoder.model.0.conv.conv.weight_g": (32, 1, 1),
    "encoder.model.0.conv.conv.weight_v": (32, 1, 7),
    "encoder.model.0.conv.conv.bias": (32,),
    "encoder.model.1.block.1.conv.conv.weight_v": (16, 32, 3),
    "encoder.model.1.block.3.conv.conv.weight_v": (32, 16, 1),
    "encoder.model.1.shortcut.conv.conv.weight_v": (32, 32, 1),
    "encoder.model.3.conv.conv.weight_v": (64, 32, 4),
    "encoder.model.6.conv.conv.weight_v": (128, 64, 8),
    "encoder.model.9.conv.conv.weight_v": (256, 128, 10),
    "encoder.model.12.conv.conv.weight_v": (512, 256, 16),
    "encoder.model.13.lstm.weight_ih_l0": (2048, 512),
    "encoder.model.13.lstm.bias_hh_l1": (2048,),
    "encoder.model.15.conv.conv.weight_v": (128, 512, 7),
    "decoder.model.0.conv.conv.weight_v": (512, 128, 7),
    "decoder.model.1.lstm.weight_hh_l1": (2048, 512),
    "decoder.model.3.convtr.convtr.weight_g": (512, 1, 1),
    "decoder.model.3.convtr.convtr.weight_v": (512, 256, 16),
    "decoder.model.3.convtr.convtr.bias": (256,),
    "decoder.model.4.block.1.conv.conv.weight_v": (128, 256, 3),
    "decoder.model.12.convtr.convtr.weight_v": (64, 32, 4),
    "decoder.model.13.shortcut.conv.conv.weight_v": (32, 32, 1),
    "decoder.model.15.conv.conv.weight_v": (1, 32, 7),
}


def _codec(seed: int) -> EnCodec:
    torch.manual_seed(seed)
    return EnCodec().eval()


@pytest.fixture(scope="module")
def codec() -> EnCodec:
    return _codec(1)


@pytest.fixture(scope="module")
def published_file(codec: EnCodec, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("published") / "encodec.th"
    quantizer = {"quantizer.vq.layers.0._codebook.embed": torch.randn(1024, 128)}
    torch.save({**codec.state_dict(), **quantizer}, path)
    return path


def test_the_parameters_carry_the_published_names_and_shapes(codec: EnCodec) -> None:
    state = {name: tuple(value.shape) for name, value in codec.state_dict().items()}
    assert {name: state.get(name) for name in PUBLISHED} == PUBLISHED


@torch.no_grad()
def test_future_samples_do_not_change_earlier_frames_of_the_encoder(codec: EnCodec) -> None:
    waveform = torch.randn(1, 1, 20 * 320)
    changed = waveform.clone()
    changed[..., 12 * 320 :] += 1.0
    before, after = codec.encode(waveform), codec.encode(changed)
    torch.testing.assert_close(after[..., :12], before[..., :12], atol=1e-6, rtol=0.0)
    assert (after[..., 12] - before[..., 12]).abs().max() > 1e-4


@torch.no_grad()
def test_a_causal_convolution_mirrors_the_past_and_fills_the_last_stride() -> None:
    layer = CausalConvolution(1, 1, 4, stride=2)
    fold_weight_norm(layer)
    layer.conv["conv"].weight.copy_(torch.tensor([[[1000.0, 100.0, 10.0, 1.0]]]))
    layer.conv["conv"].bias.zero_()
    # Mirrored on the left to 3 2 | 1 2 3 4 5 and on the right by one sample to 4.
    assert layer(torch.tensor([[[1.0, 2.0, 3.0, 4.0, 5.0]]])).tolist() == [[[3212.0, 1234.0, 3454.0]]]


@torch.no_grad()
def test_folding_the_weight_norm_does_not_change_the_output() -> None:
    folded = _codec(3)
    waveform = torch.randn(1, 1, 2400)
    before = folded.decode(folded.encode(waveform), 2400)
    fold_weight_norm(folded)
    assert not any(name.endswith("weight_g") for name in folded.state_dict())
    torch.testing.assert_close(folded.decode(folded.encode(waveform), 2400), before, atol=1e-5, rtol=1e-4)


@torch.no_grad()
def test_a_published_checkpoint_loads_and_its_quantizer_is_ignored(
    codec: EnCodec, published_file: Path
) -> None:
    loaded = _codec(2)
    waveform = torch.randn(1, 1, 2400)
    assert not torch.equal(loaded.encode(waveform), codec.encode(waveform))
    loaded.load_checkpoint(published_file, hashlib.sha256(published_file.read_bytes()).hexdigest())
    assert torch.equal(loaded.encode(waveform), codec.encode(waveform))


@pytest.mark.parametrize("digest", ["0" * 64, "0" * 8])
def test_a_wrong_sha256_is_refused_and_both_digests_are_named(
    codec: EnCodec, published_file: Path, digest: str
) -> None:
    with pytest.raises(InputError, match=rf"encodec\.th: SHA-256 is [0-9a-f]{{64}}, expected {digest};"):
        codec.load_checkpoint(published_file, digest)


def test_missing_unexpected_and_misshapen_entries_are_named_and_nothing_is_loaded(
    codec: EnCodec, tmp_path: Path
) -> None:
    state = codec.state_dict()
    del state["encoder.model.0.conv.conv.bias"]
    state["encoder.model.99.weight"] = torch.zeros(1)
    state["decoder.model.15.conv.conv.bias"] = torch.zeros(2)
    torch.save(state, tmp_path / "other.th")
    loaded = _codec(2)
    untouched = {name: value.clone() for name, value in loaded.state_dict().items()}
    with pytest.raises(InputError) as raised:
        loaded.load_checkpoint(tmp_path / "other.th")
    message = str(raised.value)
    assert "other.th" in message
    assert "missing: encoder.model.0.conv.conv.bias" in message
    assert "unexpected: encoder.model.99.weight" in message
    assert "decoder.model.15.conv.conv.bias [2] instead of [1]" in message
    assert all(torch.equal(value, loaded.state_dict()[name]) for name, value in untouched.items())


def test_a_checkpoint_with_a_number_that_is_not_finite_is_refused(codec: EnCodec, tmp_path: Path) -> None:
    state = {name: value.clone() for name, value in codec.state_dict().items()}
    state["decoder.model.15.conv.conv.bias"][0] = float("nan")
    torch.save(state, tmp_path / "nan.th")
    with pytest.raises(InputError, match=r"nan\.th: not a finite number in decoder\.model\.15\.conv"):
        codec.load_checkpoint(tmp_path / "nan.th")


def test_a_file_that_is_no_checkpoint_is_refused(codec: EnCodec, tmp_path: Path) -> None:
    path = tmp_path / "noise.th"
    path.write_bytes(b"not a checkpoint")
    with pytest.raises(InputError, match=r"noise\.th: not a PyTorch checkpoint"):
        codec.load_checkpoint(path)


class _Malicious:
    def __reduce__(self) -> tuple[object, tuple[str]]:
        return print, ("ran code from a checkpoint",)


def test_a_checkpoint_cannot_run_code(
    codec: EnCodec, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    torch.save({"encoder": _Malicious()}, tmp_path / "malicious.th")
    with pytest.raises(InputError, match="not a PyTorch checkpoint of tensors, whole"):
        codec.load_checkpoint(tmp_path / "malicious.th")
    assert capsys.readouterr().out == ""
