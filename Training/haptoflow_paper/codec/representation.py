"""Codecs as representations: the velocity field works on the latent of a frozen codec instead of samples."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, Protocol, cast

import onnx
import torch
from torch import Tensor, nn

from haptoflow_paper.codec.encodec import DEFAULT_WAVEFORM_SCALE, EnCodec, ResampledEnCodec, fold_weight_norm
from haptoflow_paper.codec.small_codec import SmallCodec
from haptoflow_training.errors import InputError
from haptoflow_training.export.trained_tier import trace_graph
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


_Port = tuple[str, tuple[int, int]]


class SegmentCodec(Protocol):
    """A codec of whole segments: [B, 1, 200] at 2 kHz to [B, *latent_shape] and back, both in unit scale."""

    @property
    def latent_shape(self) -> tuple[int, int]: ...
    def encode(self, waveform: Tensor) -> Tensor: ...
    def decode(self, latent: Tensor) -> Tensor: ...


class _Graph(nn.Module):
    def __init__(self, owner: nn.Module, function: Callable[[Tensor], Tensor]) -> None:
        super().__init__()
        self.owner = owner
        self._function = function

    def forward(self, value: Tensor) -> Tensor:
        return self._function(value)


class CodecRepresentation(Representation):
    """A frozen codec: no gradients to its weights, always in eval mode.

    Gradients still flow through it to its input, so that a loss on the decoded waveform can train the velocity field.
    The given codec is modified: weight normalisation is folded into its weights.
    """

    is_latent = True

    def __init__(self, codec: SegmentCodec) -> None:
        super().__init__()
        if not isinstance(codec, nn.Module):
            raise TypeError(f"{type(codec).__name__} is no torch.nn.Module")
        fold_weight_norm(codec)
        self.codec = codec.requires_grad_(False)
        self.shape = cast(SegmentCodec, codec).latent_shape
        self.train(False)

    def train(self, mode: bool = True) -> CodecRepresentation:
        super().train(False)
        return self

    def encode(self, waveform: Tensor) -> Tensor:
        return self.codec.encode(waveform)

    def decode(self, latent: Tensor) -> Tensor:
        return self.codec.decode(latent)

    def export_encoder(self, path: Path | str) -> None:
        """Write an ONNX graph of opset 16: `waveform` [B, 1, 200] to `latent` [B, *shape], B free."""
        waveform = (1, SEGMENT_SAMPLES)
        self._export(Path(path), self.encode, ("waveform", waveform), ("latent", self.shape))

    def export_decoder(self, path: Path | str) -> None:
        """Write an ONNX graph of opset 16: `latent` [B, *shape] to `waveform` [B, 1, 200], B free."""
        waveform = (1, SEGMENT_SAMPLES)
        self._export(Path(path), self.decode, ("latent", self.shape), ("waveform", waveform))

    def _export(self, path: Path, function: Callable[[Tensor], Tensor], source: _Port, target: _Port) -> None:
        example = torch.zeros(2, *source[1], device=next(self.codec.parameters()).device)
        with warnings.catch_warnings():
            # The exporter warns that lengths become constants, which is intended, and about the LSTM without initial
            # state, which works for any batch.
            warnings.simplefilter("ignore")
            trace_graph(_Graph(self.codec, function), (example,), str(path), [source[0]], [target[0]])
        model = onnx.load(str(path))
        # The exporter does not infer lengths after slices; store the output shape for readers of the graph.
        dimensions = model.graph.output[0].type.tensor_type.shape.dim[1:]
        for dimension, size in zip(dimensions, target[1], strict=True):
            dimension.dim_value = size
        onnx.checker.check_model(model, full_check=True)
        onnx.save(model, str(path))


_TEXT, _NUMBER = (str, Path), (int, float)
_KEYS: dict[str, dict[str, tuple[str, tuple[type, ...]]]] = {
    "small-codec": {"checkpoint": ("text", _TEXT), "sha256": ("text", _TEXT)},
    "encodec": {
        "checkpoint": ("text", _TEXT),
        "sha256": ("text", _TEXT),
        "random_weights": ("true or false", (bool,)),
        "waveform_scale": ("a number", _NUMBER),
        "latent_statistics": ("text", _TEXT),
    },
}


def _encodec(config: Mapping[str, Any]) -> ResampledEnCodec:
    random_weights = config.get("random_weights", False)
    if random_weights == ("checkpoint" in config):
        raise InputError(
            "representation 'encodec': expected either checkpoint, a file with the published 24 kHz weights, "
            "or random_weights = true to measure time only"
        )
    scale = config.get("waveform_scale", DEFAULT_WAVEFORM_SCALE)
    if not 0.0 < scale <= 1.0:
        raise InputError(f"representation 'encodec': waveform_scale = {scale}, expected above 0, at most 1")
    if random_weights:
        with torch.random.fork_rng(devices=[]):
            torch.manual_seed(0)
            codec = EnCodec()
    else:
        codec = EnCodec()
        codec.load_checkpoint(config["checkpoint"], config.get("sha256"))
    resampled = ResampledEnCodec(codec, float(scale))
    if "latent_statistics" in config:
        resampled.normaliser.load(config["latent_statistics"])
    return resampled


def build_codec_representation(config: Mapping[str, Any]) -> CodecRepresentation:
    """From a configuration table whose `kind` is "small-codec" or "encodec".

    small-codec: `checkpoint`, optionally `sha256`. encodec: `checkpoint` (optionally `sha256`) or
    `random_weights = true`; optionally `waveform_scale` (the amplitude that unit scale has in EnCodec's range of +-1,
    default 0.1) and `latent_statistics` (a file of LatentNormaliser.save; without it the latents keep EnCodec's scale).
    Raises InputError naming the key.
    """
    kind = config["kind"]
    known = _KEYS[kind]
    for key in sorted(config.keys() - {"kind"}):
        if key not in known:
            expected = ", ".join(sorted(known)) or "no further key"
            raise InputError(f"representation '{kind}': {key} is unknown, expected {expected}")
        name, types = known[key]
        value = config[key]
        if not isinstance(value, types) or (isinstance(value, bool) and bool not in types):
            raise InputError(f"representation '{kind}': {key} = {value!r}, expected {name}")
    if kind == "encodec":
        return CodecRepresentation(_encodec(config))
    if "checkpoint" not in config:
        raise InputError("representation 'small-codec': checkpoint is missing, expected a codec's file")
    return CodecRepresentation(SmallCodec.load(config["checkpoint"], config.get("sha256")))
