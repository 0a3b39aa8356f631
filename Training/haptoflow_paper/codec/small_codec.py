"""A small convolutional codec of our own at 2 kHz: 200 samples to 25 latent positions and back."""

from __future__ import annotations

from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any, TypeVar

import torch
from torch import Tensor, nn

from haptoflow_paper.codec.checkpoint_file import load_state, read_tensors
from haptoflow_training.errors import InputError
from haptoflow_training.waveform import SEGMENT_SAMPLES
from haptoflow_training.whole_file import read_toml

# A channel that the codec does not use must not be amplified to unit variance: only its noise would remain.
_MINIMUM_RELATIVE_DEVIATION = 1e-3


class LatentNormaliser(nn.Module):
    """(latent - mean) / standard deviation per channel of [B, C, P]; the identity until `fit` or `load`."""

    mean: Tensor
    standard_deviation: Tensor

    def __init__(self, channels: int) -> None:
        super().__init__()
        self.register_buffer("mean", torch.zeros(1, channels, 1))
        self.register_buffer("standard_deviation", torch.ones(1, channels, 1))

    def forward(self, latent: Tensor) -> Tensor:
        return (latent - self.mean) / self.standard_deviation

    def inverse(self, normalised: Tensor) -> Tensor:
        return normalised * self.standard_deviation + self.mean

    @torch.no_grad()
    def fit(self, latents: Tensor) -> None:
        """Take mean and deviation over items and positions of latents [K, C, P] as they are; K P >= 2."""
        deviation = latents.std(dim=(0, 2), keepdim=True)
        floor = (deviation.max() * _MINIMUM_RELATIVE_DEVIATION).clamp(min=torch.finfo(deviation.dtype).tiny)
        self.mean.copy_(latents.mean(dim=(0, 2), keepdim=True))
        self.standard_deviation.copy_(deviation.clamp(min=floor))

    def save(self, path: Path | str) -> None:
        """Write the statistics as a PyTorch state dict."""
        torch.save(self.state_dict(), path)

    def load(self, path: Path | str) -> None:
        """Read what `save` wrote; InputError names what does not fit."""
        path = Path(path)
        load_state(self, read_tensors(path), path)


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


Table = TypeVar("Table")


@dataclass(frozen=True)
class SmallCodecConfig:
    """One training run of the small codec.

    output_folder: for checkpoint, log and result.
    steps: of `batch` segments each.
    learning_rate: falls by a cosine over the second half.
    spectral_weight: of the spectral loss beside the time loss.
    held_out_as: the configuration of a network whose held-out bands the codec excludes too; none if missing.
    validate_every_steps: also the interval of log and checkpoint.
    threads: of PyTorch.
    """

    output_folder: Path
    shape: SmallCodecShape = SmallCodecShape()
    seed: int = 1
    steps: int = 6000
    batch: int = 64
    learning_rate: float = 1e-3
    spectral_weight: float = 0.1
    validate_every_steps: int = 250
    validation_segments: int = 512
    threads: int = 2
    held_out_as: Path | None = None


_PATHS = {"Path": "folder", "Path | None": "file"}
_MINIMUM = {"seed": 0, "spectral_weight": 0.0, "learning_rate": 1e-8}


def _checked(table: type[Table], values: dict[str, Any], path: Path, section: str) -> dict[str, Any]:
    known = {field.name: field.type for field in fields(table)}
    for key, value in values.items():
        if known.get(key, "SmallCodecShape") == "SmallCodecShape":
            names = ", ".join(sorted(known.keys() - {"shape"}))
            raise InputError(f"{path}: [{section}] {key} is unknown, expected one of {names}")
        if known[key] in _PATHS:
            if not isinstance(value, str) or not value:
                raise InputError(f"{path}: [{section}] {key} = {value!r}, expected a {_PATHS[known[key]]} as text")
            continue
        whole = known[key] == "int"
        allowed = int if whole else (int, float)
        least = _MINIMUM.get(key, 1)
        if isinstance(value, bool) or not isinstance(value, allowed) or not least <= value < float("inf"):
            kind = "a whole number" if whole else "a number"
            raise InputError(f"{path}: [{section}] {key} = {value!r}, expected {kind} of at least {least}")
    return values


def read_small_codec_config(path: Path | str) -> SmallCodecConfig:
    """Read a TOML file with the tables [codec] and [training]; InputError names file, key and the expected value.

    A relative output_folder refers to the current folder, a relative held_out_as to the file's own.
    """
    path = Path(path)
    content = read_toml(path, "a codec's TOML file")
    unknown = sorted(content.keys() - {"codec", "training"})
    if unknown:
        raise InputError(f"{path}: '{unknown[0]}' is unknown, expected the tables [codec] and [training]")
    for section in ("codec", "training"):
        if not isinstance(content.get(section, {}), dict):
            raise InputError(f"{path}: '{section}' is a value, expected the table [{section}]")
    training = content.get("training", {})
    if "output_folder" not in training:
        raise InputError(f"{path}: [training] output_folder is missing, expected a folder for the results")
    shape = SmallCodecShape(**_checked(SmallCodecShape, content.get("codec", {}), path, "codec"))
    values = dict(_checked(SmallCodecConfig, training, path, "training"))
    values["output_folder"] = Path(values["output_folder"])
    if "held_out_as" in values:
        values["held_out_as"] = path.parent / values["held_out_as"]
    return SmallCodecConfig(shape=shape, **values)
