"""EnCodec's 24 kHz encoder and decoder (Defossez et al. 2022) around the latent before quantisation.

Structure and parameter names are the published model's, so that its checkpoint loads as it is. No weights
come with HaptoFlow.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from torch import Tensor, nn

from haptoflow_paper.codec.causal_layers import (
    CausalConvolution,
    CausalResidualBlock,
    CausalTransposedConvolution,
    ResidualLstm,
)
from haptoflow_paper.codec.checkpoint_file import load_state, read_tensors
from haptoflow_training.errors import InputError

ENCODEC_RATE_HZ = 24_000
FRAME_SAMPLES = 320
LATENT_CHANNELS = 128
FIRST_CHANNELS = 32

_STRIDES = (2, 4, 5, 8)
_END_KERNEL = 7
_WRAPPERS = ("best_state", "model")
_QUANTIZER = "quantizer."


def read_published_state(path: Path, sha256: str | None = None) -> dict[str, Any]:
    """EnCodec's state dict from a .th or .pt file that holds it itself or under `best_state` or `model`; InputError if
    the file is absent, damaged, has another digest or holds no dict."""
    content = read_tensors(path, sha256)
    for wrapper in _WRAPPERS:
        inner = content.get(wrapper)
        if isinstance(inner, dict):
            content = inner
    return content


class EnCodecEncoder(nn.Module):
    """[B, 1, N] at 24 kHz to [B, L, ceil(N / 320)]; N above 1,920."""

    def __init__(self, first_channels: int = FIRST_CHANNELS, latent_channels: int = LATENT_CHANNELS) -> None:
        super().__init__()
        channels = first_channels
        layers: list[nn.Module] = [CausalConvolution(1, channels, _END_KERNEL)]
        for stride in _STRIDES:
            layers += [
                CausalResidualBlock(channels),
                nn.ELU(),
                CausalConvolution(channels, 2 * channels, 2 * stride, stride),
            ]
            channels *= 2
        last = CausalConvolution(channels, latent_channels, _END_KERNEL)
        layers += [ResidualLstm(channels), nn.ELU(), last]
        self.model = nn.Sequential(*layers)

    def forward(self, waveform: Tensor) -> Tensor:
        return self.model(waveform)


class EnCodecDecoder(nn.Module):
    """[B, L, P] to [B, 1, 320 P] at 24 kHz; P above 6."""

    def __init__(self, first_channels: int = FIRST_CHANNELS, latent_channels: int = LATENT_CHANNELS) -> None:
        super().__init__()
        channels = first_channels * 2 ** len(_STRIDES)
        layers: list[nn.Module] = [
            CausalConvolution(latent_channels, channels, _END_KERNEL),
            ResidualLstm(channels),
        ]
        for stride in reversed(_STRIDES):
            layers += [
                nn.ELU(),
                CausalTransposedConvolution(channels, channels // 2, stride),
                CausalResidualBlock(channels // 2),
            ]
            channels //= 2
        layers += [nn.ELU(), CausalConvolution(channels, 1, _END_KERNEL)]
        self.model = nn.Sequential(*layers)

    def forward(self, latent: Tensor) -> Tensor:
        return self.model(latent)


class EnCodec(nn.Module):
    """Encoder and decoder; waveforms in +-1 at 24 kHz, one channel, 75 latent frames a second. The defaults are the
    published sizes; first_channels: those after the first layer, which every stride doubles."""

    def __init__(self, first_channels: int = FIRST_CHANNELS, latent_channels: int = LATENT_CHANNELS) -> None:
        super().__init__()
        self.encoder = EnCodecEncoder(first_channels, latent_channels)
        self.decoder = EnCodecDecoder(first_channels, latent_channels)

    def encode(self, waveform: Tensor) -> Tensor:
        """[B, 1, N] to the continuous latent [B, 128, ceil(N / 320)]."""
        return self.encoder(waveform)

    def decode(self, latent: Tensor, samples: int) -> Tensor:
        """[B, 128, P] to the first `samples` (at most 320 P) of the waveform, [B, 1, samples]."""
        return self.decoder(latent)[..., :samples]

    def load_checkpoint(self, path: Path | str, sha256: str | None = None) -> None:
        """Load the published checkpoint, or a state dict with its names; the quantizer's part is ignored.

        path: a .th or .pt file holding a state dict, itself or under `best_state` or `model`. sha256: 64
        hexadecimal digits or at least the first 8, verified before anything is read. Raises InputError naming
        the file and what does not fit; the weights are then unchanged.
        """
        path = Path(path)
        content = read_published_state(path, sha256)
        state = {name: value for name, value in content.items() if not name.startswith(_QUANTIZER)}
        if not state:
            raise InputError(f"{path}: holds no encoder or decoder, expected EnCodec's 24 kHz state dict")
        load_state(self, state, path)
