"""Recordings encoded and decoded by a codec."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import torch
from torch import Tensor

from haptoflow_paper.codec.codec_reconstruction import codec_reconstruction
from haptoflow_paper.codec.small_codec import SmallCodec, SmallCodecShape
from haptoflow_training.errors import InputError


@pytest.fixture
def checkpoint(tmp_path: Path) -> Path:
    torch.manual_seed(1)
    codec = SmallCodec(SmallCodecShape(latent_channels=12, width=8))
    codec.normaliser.fit(codec.encoder(torch.randn(64, 1, 200)).detach())
    codec.save(tmp_path / "small.pt")
    return tmp_path / "small.pt"


def _noise(samples: int, level_mps2: float) -> np.ndarray:
    return (level_mps2 * np.random.default_rng(2).standard_normal(samples)).astype(np.float32)


@pytest.mark.parametrize("samples", [1000, 1013, 28, 7])
def test_every_hop_is_the_start_of_its_own_encoded_and_decoded_segment(checkpoint: Path, samples: int) -> None:
    wave = _noise(samples, 3.0)
    made = codec_reconstruction(checkpoint, [wave])[0]
    assert made.shape == wave.shape and made.dtype == np.float32
    codec = SmallCodec.load(checkpoint).eval()
    padded = np.concatenate([wave, np.zeros(200, dtype=np.float32)])
    for start in range(0, samples, 28):
        segment = padded[start : start + 200]
        level = np.sqrt(np.mean(np.square(segment)))
        with torch.no_grad():
            whole = codec.decode(codec.encode(torch.from_numpy(segment / level).reshape(1, 1, 200)))[0, 0].numpy()
        part = made[start : start + 28]
        np.testing.assert_allclose(part, whole[: len(part)] * level, rtol=1e-3, atol=1e-4)


def test_a_louder_recording_is_reconstructed_louder_by_the_same_factor(checkpoint: Path) -> None:
    quiet, loud = codec_reconstruction(checkpoint, [_noise(600, 0.5), _noise(600, 50.0)])
    np.testing.assert_allclose(loud, 100.0 * quiet, rtol=1e-3, atol=1e-2)


def test_silence_stays_below_the_threshold_of_feeling(checkpoint: Path) -> None:
    assert np.abs(codec_reconstruction(checkpoint, [np.zeros(500, dtype=np.float32)])[0]).max() < 0.05


def test_an_identity_codec_returns_the_recording(
    checkpoint: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def same(codec: SmallCodec, value: Tensor) -> Tensor:
        return value

    monkeypatch.setattr(SmallCodec, "encode", same)
    monkeypatch.setattr(SmallCodec, "decode", same)
    wave = _noise(1500, 2.0)
    np.testing.assert_allclose(codec_reconstruction(checkpoint, [wave], 200)[0], wave, rtol=1e-5)
    np.testing.assert_allclose(codec_reconstruction(checkpoint, [wave])[0], wave, rtol=1e-5)


def test_a_file_that_is_no_codec_is_refused(tmp_path: Path) -> None:
    torch.save({"weights": torch.zeros(3)}, tmp_path / "other.pt")
    with pytest.raises(InputError, match="other.pt"):
        codec_reconstruction(tmp_path / "other.pt", [_noise(400, 1.0)])
