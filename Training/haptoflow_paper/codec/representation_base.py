"""What the velocity field works on: the samples of a segment, or the latent of a frozen codec."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from torch import Tensor, nn

from haptoflow_training.errors import InputError
from haptoflow_training.extensions import located
from haptoflow_training.waveform import SEGMENT_SAMPLES


class Representation(nn.Module):
    """The form of a segment that the velocity field works on. shape: (channels, positions). is_latent: the exported
    tier needs the graphs of an encoder and a decoder."""

    shape: tuple[int, int]
    is_latent: bool

    def encode(self, waveform: Tensor) -> Tensor:
        """[B, 1, 200] in unit scale to [B, *shape]."""
        raise NotImplementedError

    def decode(self, latent: Tensor) -> Tensor:
        """[B, *shape] to [B, 1, 200] in unit scale."""
        raise NotImplementedError

    def export_encoder(self, path: Path | str) -> None:
        """Write the ONNX graph of a latent representation's encoder: `waveform` [B, 1, 200] to `latent` [B, *shape]."""
        raise NotImplementedError

    def export_decoder(self, path: Path | str) -> None:
        """Write the ONNX graph of a latent representation's decoder: `latent` [B, *shape] to `waveform` [B, 1, 200]."""
        raise NotImplementedError


class RawRepresentation(Representation):
    """The samples themselves."""

    shape = (1, SEGMENT_SAMPLES)
    is_latent = False

    def encode(self, waveform: Tensor) -> Tensor:
        return waveform

    def decode(self, latent: Tensor) -> Tensor:
        return latent


def build_representation(config: Mapping[str, Any]) -> Representation:
    """From a configuration table: `kind` is "raw", "small-codec" or "encodec"; the codec reads the other keys. Raises InputError naming the key."""
    kind = config.get("kind")
    if kind == "raw":
        for key in sorted(config.keys() - {"kind"}):
            raise InputError(f"representation 'raw': {key} is unknown, expected no further key")
        return RawRepresentation()
    if kind not in ("small-codec", "encodec"):
        raise InputError(f"representation kind = {kind!r}, expected one of encodec, raw, small-codec")
    built: Representation = located("haptoflow_paper.codec.representation:build_codec_representation")(config)
    return built
