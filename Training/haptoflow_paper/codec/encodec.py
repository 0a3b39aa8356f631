"""EnCodec's 24 kHz encoder and decoder (Defossez et al. 2022) around the latent before quantisation.

Structure and parameter names are the published model's, so that its checkpoint loads as it is. No weights
come with HaptoFlow.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import torch
from scipy.signal import firwin
from torch import Tensor, nn
from torch.nn.utils import remove_weight_norm, weight_norm

from haptoflow_paper.codec.checkpoint_file import load_state, read_tensors
from haptoflow_paper.codec.small_codec import LatentNormaliser
from haptoflow_training.errors import InputError
from haptoflow_training.waveform import SEGMENT_SAMPLES

class CausalConvolution(nn.Module):
    """Convolution of [B, C, N] to [B, D, ceil(N / stride)] that reads no sample after its own stride.

    All padding is on the left, mirrored, except what the last stride needs to be full. Because of the mirroring, the
    first outputs depend on up to `kernel - stride` later samples; N must exceed that number, or ValueError is raised.
    """

    def __init__(self, inputs: int, outputs: int, kernel: int, stride: int = 1) -> None:
        super().__init__()
        self.stride = stride
        self.left = kernel - stride
        self.conv = nn.ModuleDict({"conv": weight_norm(nn.Conv1d(inputs, outputs, kernel, stride=stride))})

    def forward(self, signal: Tensor) -> Tensor:
        length = int(signal.shape[-1])
        if length <= self.left:
            raise ValueError(f"{length} positions are too few to mirror {self.left} of them; expected more")
        padded = nn.functional.pad(signal, (self.left, -length % self.stride), mode="reflect")
        return self.conv["conv"](padded)


class CausalTransposedConvolution(nn.Module):
    """Transposed convolution of [B, C, N] to [B, D, N stride], kernel twice the stride, cut on the right."""

    def __init__(self, inputs: int, outputs: int, stride: int) -> None:
        super().__init__()
        self.stride = stride
        layer = nn.ConvTranspose1d(inputs, outputs, 2 * stride, stride=stride)
        self.convtr = nn.ModuleDict({"convtr": weight_norm(layer)})

    def forward(self, signal: Tensor) -> Tensor:
        return self.convtr["convtr"](signal)[..., : -self.stride]


class CausalResidualBlock(nn.Module):
    """Bottleneck of half the channels (kernel 3, then 1) beside a shortcut of kernel 1; keeps [B, C, N]."""

    def __init__(self, channels: int) -> None:
        super().__init__()
        self.block = nn.Sequential(
            nn.ELU(),
            CausalConvolution(channels, channels // 2, 3),
            nn.ELU(),
            CausalConvolution(channels // 2, channels, 1),
        )
        self.shortcut = CausalConvolution(channels, channels, 1)

    def forward(self, signal: Tensor) -> Tensor:
        return self.shortcut(signal) + self.block(signal)


class ResidualLstm(nn.Module):
    """Two LSTM layers over positions, added to their input; keeps [B, C, N]."""

    def __init__(self, channels: int) -> None:
        super().__init__()
        self.lstm = nn.LSTM(channels, channels, num_layers=2)

    def forward(self, signal: Tensor) -> Tensor:
        sequence = signal.permute(2, 0, 1)
        recalled, _ = self.lstm(sequence)
        return (recalled + sequence).permute(1, 2, 0)


def fold_weight_norm(module: nn.Module) -> None:
    """Replace every weight-normalised layer by a plain one with the same output, in place; not for training.

    Weights are then computed once instead of in every call; the state dict loses its published names.
    """
    for layer in module.modules():
        if hasattr(layer, "weight_g"):
            remove_weight_norm(layer)


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


# 63 dB stop band; with 16 samples a side the pass band reaches 880 of 1,000 Hz.
_KAISER_BETA = 6.0
_HALF_WIDTH = 16


def _continued(waveform: Tensor, reach: int) -> Tensor:
    """Extended by point reflection about its ends, so that value and slope are continuous; [B, 1, N] to [B, 1, N + 2
    reach].

    A plain mirror image has a kink: band noise of 20-450 Hz was reconstructed with 42 dB instead of 58 dB.
    """
    before = 2.0 * waveform[..., :1] - waveform[..., 1 : reach + 1].flip(-1)
    after = 2.0 * waveform[..., -1:] - waveform[..., -reach - 1 : -1].flip(-1)
    return torch.cat([before, waveform, after], dim=-1)


class PolyphaseResampler(nn.Module):
    """Windowed sinc with its corner at the lower rate's Nyquist frequency, 16 lower-rate samples a side.

    Sample i of the lower rate is sample i * factor of the higher one: no delay. The lower-rate length must
    exceed 16.
    """

    taps: Tensor

    def __init__(self, factor: int) -> None:
        super().__init__()
        self.factor = factor
        taps = firwin(2 * _HALF_WIDTH * factor + 1, 1.0 / factor, window=("kaiser", _KAISER_BETA))
        kernel = torch.tensor(taps, dtype=torch.float32).reshape(1, 1, -1)
        self.register_buffer("taps", kernel, persistent=False)

    def upsample(self, waveform: Tensor) -> Tensor:
        """[B, 1, N] to [B, 1, N factor]; the samples themselves are kept to within 2e-4."""
        return nn.functional.conv_transpose1d(
            _continued(waveform, _HALF_WIDTH),
            self.taps * self.factor,
            stride=self.factor,
            padding=2 * _HALF_WIDTH * self.factor,
            output_padding=self.factor - 1,
        )

    def downsample(self, waveform: Tensor) -> Tensor:
        """[B, 1, N factor] to [B, 1, N], what lies above the lower rate's Nyquist frequency removed."""
        return nn.functional.conv1d(
            _continued(waveform, _HALF_WIDTH * self.factor), self.taps, stride=self.factor
        )


WAVEFORM_RATE_HZ = 2_000
# EnCodec was trained on sound within +-1; waveforms in unit scale have an RMS of 1 and peaks of several.
DEFAULT_WAVEFORM_SCALE = 0.1

_FACTOR = ENCODEC_RATE_HZ // WAVEFORM_RATE_HZ
_SAMPLES_24_KHZ = SEGMENT_SAMPLES * _FACTOR


class ResampledEnCodec(nn.Module):
    """Scale, upsample 12 times, encode, normalise; and the inverse. Input and output are in unit scale at 2 kHz."""

    latent_shape = (LATENT_CHANNELS, -(-_SAMPLES_24_KHZ // FRAME_SAMPLES))

    def __init__(self, codec: EnCodec, waveform_scale: float = DEFAULT_WAVEFORM_SCALE) -> None:
        super().__init__()
        self.codec = codec
        self.waveform_scale = waveform_scale
        self.resampler = PolyphaseResampler(_FACTOR)
        self.normaliser = LatentNormaliser(LATENT_CHANNELS)

    def encode_unnormalised(self, waveform: Tensor) -> Tensor:
        """[B, 1, 200] in unit scale to EnCodec's own latent [B, 128, 8]."""
        return self.codec.encode(self.resampler.upsample(waveform * self.waveform_scale))

    def encode(self, waveform: Tensor) -> Tensor:
        """[B, 1, 200] in unit scale to the normalised latent [B, 128, 8]."""
        return self.normaliser(self.encode_unnormalised(waveform))

    def decode(self, latent: Tensor) -> Tensor:
        """[B, 128, 8] normalised to [B, 1, 200] in unit scale."""
        decoded = self.codec.decode(self.normaliser.inverse(latent), _SAMPLES_24_KHZ)
        return self.resampler.downsample(decoded) / self.waveform_scale
