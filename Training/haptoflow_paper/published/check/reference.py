"""What a published checkpoint should compute: by the authors' own modules where they can be imported, else by ours.

Names of the authors' package (github.com/tamago117/HaptoFlow at cb77d421): it has no distribution, so its root is put on
PYTHONPATH; it needs their dependencies (torchaudio, encodec, omegaconf, safetensors, huggingface_hub, pandas).
"""

from __future__ import annotations

import importlib
from pathlib import Path
from typing import Any, Protocol

import torch
from torch import Tensor

from haptoflow_paper.published.published_model import PublishedModel
from haptoflow_training.errors import InputError
from haptoflow_training.waveform import SAMPLE_RATE_HZ, SEGMENT_SAMPLES

AUTHORS_MODULE = "src.inference.flow_matching.inference"
_AUTHORS_CLASS = "FlowMatchingInference"


class Reference(Protocol):
    """The stages on the processor, without gradients; shapes and units as PublishedModel's."""

    name: str

    def encode(self, waveform: Tensor) -> Tensor: ...
    def past_features(self, latent: Tensor) -> list[Tensor]: ...
    def condition(self, labels: Tensor, motion: Tensor) -> Tensor:
        """labels: ids of classes [B]."""

    def velocity(self, point: Tensor, time: float, condition: Tensor, past: list[Tensor]) -> Tensor: ...
    def generate(self, noise: Tensor, condition: Tensor, past: list[Tensor]) -> Tensor: ...
    def codes(self, latent: Tensor) -> Tensor: ...
    def decode(self, latent: Tensor) -> Tensor: ...


class OwnModules:
    """This repository's reading of the checkpoint in PyTorch."""

    name = "this project's own PyTorch modules"

    def __init__(self, model: PublishedModel) -> None:
        self._model = model

    def encode(self, waveform: Tensor) -> Tensor:
        return self._model.encode(waveform)

    def past_features(self, latent: Tensor) -> list[Tensor]:
        return self._model.past_features(latent)

    def condition(self, labels: Tensor, motion: Tensor) -> Tensor:
        return self._model.condition(self._model.network.label_embed(labels), motion)

    def velocity(self, point: Tensor, time: float, condition: Tensor, past: list[Tensor]) -> Tensor:
        moment = torch.full((len(point), 1), time)
        return self._model.velocity(point, moment, condition, past, self._model.meta.guidance)

    def generate(self, noise: Tensor, condition: Tensor, past: list[Tensor]) -> Tensor:
        return self._model.generate(noise, condition, past)

    def codes(self, latent: Tensor) -> Tensor:
        return self._model.quantiser.codes(latent)

    def decode(self, latent: Tensor) -> Tensor:
        return self._model.decode(latent)


class AuthorsModules:
    """The authors' own inference engine with the checkpoint of a folder."""

    name = "the authors' own modules"

    def __init__(self, engine: Any, steps: int) -> None:
        self._engine, self._steps = engine, steps

    def _there(self, value: Tensor) -> Tensor:
        return value.to(self._engine.device)

    def encode(self, waveform: Tensor) -> Tensor:
        found = self._engine.encodec_wrapper.encode_waveform(
            waveform, return_latent=True, return_codes=False, input_sample_rate=float(SAMPLE_RATE_HZ)
        )
        return _here(found["latent"])

    def past_features(self, latent: Tensor) -> list[Tensor]:
        return [_here(each) for each in self._engine.prev_segment_encoder(self._there(latent))]

    def condition(self, labels: Tensor, motion: Tensor) -> Tensor:
        controls = [self._engine._normalize_control_values(force, vx, vy) for vx, vy, force in motion.tolist()]
        rows = self._engine.label_embed(self._there(labels))
        scores = self._there(torch.tensor(controls, dtype=torch.float32))
        return _here(torch.cat([rows, self._engine.control_embedding(scores)], dim=-1))

    def velocity(self, point: Tensor, time: float, condition: Tensor, past: list[Tensor]) -> Tensor:
        there = [self._there(each) for each in past]
        return _here(self._engine.model._velocity(self._there(point), time, self._there(condition), there))

    def generate(self, noise: Tensor, condition: Tensor, past: list[Tensor]) -> Tensor:
        return _here(
            self._engine.model.generate(
                steps=self._steps,
                cond=self._there(condition),
                shape=noise.shape,
                encoder_feats=[self._there(each) for each in past],
                noise=self._there(noise),
            )
        )

    def codes(self, latent: Tensor) -> Tensor:
        # The authors' quantiser drops the batch of a single latent, so latents go in one by one and are stacked here.
        return torch.stack([_here(self._engine.encodec_wrapper.quantize_latent(each[None])[0]) for each in latent])

    def decode(self, latent: Tensor) -> Tensor:
        codes = self.codes(latent)
        wave = self._engine.encodec_wrapper.decode_from_codes(codes, target_sample_rate=float(SAMPLE_RATE_HZ))
        return _here(wave).reshape(len(latent), 1, -1)[..., :SEGMENT_SAMPLES]


def _here(value: Tensor) -> Tensor:
    return value.detach().cpu()


def reference_of(folder: Path, model: PublishedModel) -> tuple[Reference, str]:
    """The best reference there is, and why it is not the authors' (empty if it is). InputError if their modules are
    there and do not take the folder."""
    try:
        module = importlib.import_module(AUTHORS_MODULE)
    except ImportError as error:
        return OwnModules(model), f"the authors' modules cannot be imported ({error})"
    engine_class = getattr(module, _AUTHORS_CLASS, None)
    if engine_class is None:
        return OwnModules(model), f"a package `src` without {_AUTHORS_CLASS} is on the path; it is not the authors'"
    engine = engine_class()
    message, status = engine.init_from_model_dir(str(folder))
    if status != "ok":
        raise InputError(f"{folder}: the authors' modules refuse it ({message}); expected the folder as downloaded")
    return AuthorsModules(engine, model.meta.steps), ""
