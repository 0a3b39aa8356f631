"""A small convolutional codec of our own at 2 kHz: 200 samples to 25 latent positions and back."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from pathlib import Path

import torch
from torch import Tensor, nn

from haptoflow_paper.codec.checkpoint_file import load_state, read_tensors
from haptoflow_paper.codec.latent_normaliser import LatentNormaliser
from haptoflow_training.errors import InputError
from haptoflow_training.waveform import SEGMENT_SAMPLES


_STAGES = 3
_FILE_KIND = "haptoflow small codec 1"


@dataclass(frozen=True)
class SmallCodecShape:
    """latent_channels: values per latent position (8 samples). width: channels at 2 kHz, doubled a stage."""

    latent_channels: int = 16
    width: int = 16

    @property
    def latent_positions(self) -> int:
        return SEGMENT_SAMPLES // 2**_STAGES


class _ResidualBlock(nn.Module):
    def __init__(self, channels: int) -> None:
        super().__init__()
        self.first = nn.Conv1d(channels, channels, 3, padding=1)
        self.second = nn.Conv1d(channels, channels, 3, padding=1)

    def forward(self, signal: Tensor) -> Tensor:
        return signal + self.second(nn.functional.silu(self.first(nn.functional.silu(signal))))


def _encoder(shape: SmallCodecShape) -> nn.Sequential:
    channels = shape.width
    layers: list[nn.Module] = [nn.Conv1d(1, channels, 7, padding=3)]
    for _ in range(_STAGES):
        layers += [_ResidualBlock(channels), nn.Conv1d(channels, 2 * channels, 4, stride=2, padding=1)]
        channels *= 2
    layers += [_ResidualBlock(channels), nn.Conv1d(channels, shape.latent_channels, 3, padding=1)]
    return nn.Sequential(*layers)


def _decoder(shape: SmallCodecShape) -> nn.Sequential:
    channels = shape.width * 2**_STAGES
    layers: list[nn.Module] = [nn.Conv1d(shape.latent_channels, channels, 3, padding=1)]
    layers += [_ResidualBlock(channels)]
    for _ in range(_STAGES):
        layers += [
            nn.ConvTranspose1d(channels, channels // 2, 4, stride=2, padding=1),
            _ResidualBlock(channels // 2),
        ]
        channels //= 2
    return nn.Sequential(*layers, nn.Conv1d(channels, 1, 7, padding=3))


class SmallCodec(nn.Module):
    """Three stages of stride 2 each way, residual blocks, zero padding; not causal, because segments are processed
    whole.

    Waveforms are in unit scale at 2 kHz. The latent is un-normalised during training, and of unit variance in each
    channel once `normaliser` is fitted.
    """

    def __init__(self, shape: SmallCodecShape = SmallCodecShape()) -> None:
        super().__init__()
        self.shape = shape
        self.encoder = _encoder(shape)
        self.decoder = _decoder(shape)
        self.normaliser = LatentNormaliser(shape.latent_channels)

    @property
    def latent_shape(self) -> tuple[int, int]:
        """Channels and positions of the latent of one segment."""
        return self.shape.latent_channels, self.shape.latent_positions

    def encode(self, waveform: Tensor) -> Tensor:
        """[B, 1, 200] to the normalised latent [B, C, 25]."""
        return self.normaliser(self.encoder(waveform))

    def decode(self, latent: Tensor) -> Tensor:
        """[B, C, 25] normalised to [B, 1, 200]."""
        return self.decoder(self.normaliser.inverse(latent))

    def save(self, path: Path | str) -> None:
        """Write shape, weights and latent statistics into one file."""
        torch.save({"kind": _FILE_KIND, "shape": asdict(self.shape), "state": self.state_dict()}, path)

    @classmethod
    def load(cls, path: Path | str, sha256: str | None = None) -> SmallCodec:
        """Read what `save` wrote; InputError names the file and what does not fit."""
        path = Path(path)
        content = read_tensors(path, sha256)
        if content.get("kind") != _FILE_KIND:
            raise InputError(
                f"{path}: not a small codec, expected kind '{_FILE_KIND}'; train one with codec-small.toml"
            )
        try:
            shape = SmallCodecShape(**content["shape"])
            codec = cls(shape)
            state = dict(content["state"])
        except (KeyError, TypeError, ValueError, RuntimeError) as error:
            raise InputError(f"{path}: damaged, expected 'shape' and 'state' of a small codec") from error
        load_state(codec, state, path)
        return codec
