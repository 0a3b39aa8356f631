"""Whether the file computes what the checkpoint in a folder computes: stage by stage, then a chain of segments in the
engine with given noise."""

from __future__ import annotations

import importlib
import json
import subprocess
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any, Protocol

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor

from haptoflow_benchmark.engine_library import EngineLibrary
from haptoflow_paper.published.check_lines import Line, inapplicable, judged
from haptoflow_paper.published.checkpoint import read_checkpoint
from haptoflow_paper.published.published_file import BEST_TIER
from haptoflow_paper.published.published_model import PublishedModel
from haptoflow_paper.rows.engine_generator import EngineGenerator
from haptoflow_training.errors import InputError
from haptoflow_training.export.model_file import ModelFile
from haptoflow_training.model_stamp import sha256_of
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


# Of the largest error, as a share of the array's RMS.
LIMIT = 1e-4
_TIMES = (1.0, 0.5, 0.125)
_SEGMENTS = 3
_PART = "parity"
_WHOLE, _AUTHORS = "the file against the checkpoint", "the authors' code is the reference"
_CODES = "codes of the quantiser"
_RUN_GRAPHS = Path(__file__).with_name("run_graphs.mjs")
_REMEDY = (
    "import the folder again with this version (haptoflow-paper import-published); if it still fails, send this report"
)
_AUTHORS_REMEDY = (
    "to compare with the authors' code: clone github.com/tamago117/HaptoFlow, install its dependencies and put its "
    "folder on PYTHONPATH"
)


def is_published(file: ModelFile) -> bool:
    """Whether import-published wrote the file."""
    return any(tier["name"] == BEST_TIER and tier.get("representation") == "latent" for tier in file.header["tiers"])


def parity_lines(
    file: ModelFile,
    path: Path,
    folder: Path | None,
    encodec: Path | None,
    engine: EngineLibrary,
    root: Path,
    advance: Callable[[str], None] = lambda stage: None,
) -> tuple[list[Line], str]:
    """The lines, and the reference's name ("" if there is none)."""
    if not is_published(file):
        why = "the file is not an import of the published weights"
        return [inapplicable(_PART, _WHOLE, why, "nothing to do: its training has its own parity test")], ""
    if folder is None:
        return [inapplicable(_PART, _WHOLE, "no checkpoint named", "name the download with --folder")], ""
    advance("reading the checkpoint")
    checkpoint = read_checkpoint(folder, encodec)
    model = checkpoint.model
    reference, why_not = reference_of(folder, model)
    lines = [_same_weights(file, (checkpoint.weights, checkpoint.codec)), _reference_line(reference, why_not)]
    stages = _Stages(reference, model)
    advance("stages")
    own = OwnModules(model)
    if not why_not:
        lines += stages.importer_lines(own)
    else:
        why = "there are only our own; the line `graph: waveform of a latent` covers them"
        lines.append(inapplicable(_PART, _CODES, why, _AUTHORS_REMEDY))
    advance("graphs")
    lines += stages.graph_lines(file, root)
    advance("the engine")
    lines.append(stages.engine_line(file, path, engine))
    return lines, reference.name


def _same_weights(file: ModelFile, files: tuple[Path, ...]) -> Line:
    stated = file.header["provenance"]["configuration"].get("sha256", {})
    found = {each.name: sha256_of(each) for each in files}
    others = [name for name, value in found.items() if stated.get(name) != value]
    return judged(
        _PART,
        "the file was imported from this folder",
        not others,
        "SHA-256 equal" if not others else f"SHA-256 of {', '.join(others)} differs from the one in the file",
        "SHA-256 of weights and codec as the file states them",
        "name the folder that the file was imported from, or import this folder",
        sha256=found,
    )


def _reference_line(reference: Reference, why_not: str) -> Line:
    if why_not:
        return inapplicable(_PART, _AUTHORS, f"{why_not}; compared with {reference.name}", _AUTHORS_REMEDY)
    return judged(_PART, _AUTHORS, True, reference.name, "imported", _AUTHORS_REMEDY)


class _Stages:
    """Three segments, each the past of the next, computed by the reference."""

    def __init__(self, reference: Reference, model: PublishedModel) -> None:
        self.reference, self.model = reference, model
        numbers = np.random.default_rng(7)
        force = model.meta.controls["force"]
        classes = len(model.meta.classes)
        self.labels = torch.tensor([segment * (classes - 1) // 2 for segment in range(_SEGMENTS)])
        angles = numbers.uniform(0.0, 2.0 * np.pi, _SEGMENTS)
        speeds = np.linspace(0.02, 0.06, _SEGMENTS)
        forces = force.mean + force.deviation * np.linspace(-1.0, 1.0, _SEGMENTS)
        motion = np.stack([speeds * np.cos(angles), speeds * np.sin(angles), forces], axis=1)
        self.motion = torch.from_numpy(motion.astype(np.float32))
        self.noise = torch.from_numpy(numbers.standard_normal((_SEGMENTS, *model.latent_shape), dtype=np.float32))
        past = torch.zeros(1, 1, SEGMENT_SAMPLES)
        past[0, 0] = torch.from_numpy(0.3 * numbers.standard_normal(SEGMENT_SAMPLES).astype(np.float32))
        self.previous, self.latents, self.generated, self.waves = [], [], [], []
        self.conditions = reference.condition(self.labels, self.motion)
        for segment in range(_SEGMENTS):
            one = slice(segment, segment + 1)
            self.previous.append(past)
            self.latents.append(reference.encode(past))
            features = reference.past_features(self.latents[-1])
            self.generated.append(reference.generate(self.noise[one], self.conditions[one], features))
            past = reference.decode(self.generated[-1])
            self.waves.append(past)

    def _velocity(self, modules: Reference, time: float) -> Tensor:
        past = modules.past_features(torch.cat(self.latents))
        return modules.velocity(self.noise, time, modules.condition(self.labels, self.motion), past)

    def importer_lines(self, own: OwnModules) -> list[Line]:
        """Our reading of the checkpoint against the authors', from the same input at each stage."""
        latents, generated = torch.cat(self.latents), torch.cat(self.generated)
        theirs = self.reference
        pairs = {
            "latent of the past": (own.encode(torch.cat(self.previous)), latents),
            **{
                f"features of the past, level {level}": pair
                for level, pair in enumerate(
                    zip(own.past_features(latents), theirs.past_features(latents), strict=True)
                )
            },
            "condition": (own.condition(self.labels, self.motion), self.conditions),
            **{
                f"velocity at t = {time:g}": (self._velocity(own, time), self._velocity(theirs, time))
                for time in _TIMES
            },
            "waveform of a latent": (own.decode(generated), torch.cat(self.waves)),
        }
        lines = [_close(f"importer: {name}", found, expected, _REMEDY) for name, (found, expected) in pairs.items()]
        found, expected = own.codes(generated), theirs.codes(generated)
        different = int((found != expected).sum()) if found.shape == expected.shape else expected.numel()
        words = f"{different} of {expected.numel()} differ"
        return [*lines, judged(_PART, f"importer: {_CODES}", different == 0, words, "equal", _REMEDY)]

    def graph_lines(self, file: ModelFile, root: Path) -> list[Line]:
        """The graphs of the file, in ONNX Runtime for the web, against the reference."""
        is_heun = self.model.meta.solver == "heun"
        field = {
            "noisy": self.noise,
            "previous": torch.cat(self.latents),
            "embedding": torch.tensor(file.tensors["embedding"])[self.labels],
            "motion": self.motion,
        }
        best = next(tier for tier in file.header["tiers"] if tier["name"] == BEST_TIER)
        previous, generated = {"waveform": torch.cat(self.previous)}, {"latent": torch.cat(self.generated)}
        jobs: list[tuple[str, str, dict[str, Tensor], float, Tensor]] = [
            ("latent of the past", best["encoder"], previous, 1.0, torch.cat(self.latents))
        ]
        for time in _TIMES:
            turned = torch.full((_SEGMENTS, 1), 1.0 - time)
            # The tier of "euler" looks half an interval ahead.
            ahead = {"time": turned - 0.0625, "interval": torch.full_like(turned, 0.125)}
            moments = {"time": turned} if is_heun else ahead
            # The file's time and velocity run the other way.
            velocity = self._velocity(self.reference, time)
            jobs.append((f"velocity at t = {time:g}", best["field"], field | moments, -1.0, velocity))
        jobs.append(("waveform of a latent", best["decoder"], generated, 1.0, torch.cat(self.waves)))
        found = _run_graphs([(file.graphs[graph], inputs) for _, graph, inputs, _, _ in jobs], root)
        return [
            _close(f"graph: {name}", torch.from_numpy(sign * result), expected, _REMEDY)
            for (name, _, _, sign, expected), result in zip(jobs, found, strict=True)
        ]

    def engine_line(self, file: ModelFile, path: Path, engine: EngineLibrary) -> Line:
        """The chain through the C interface; the noise is given."""
        unit = np.float32(file.header["normalisation"]["peak_mps2"])
        with EngineGenerator(engine, path, BEST_TIER, maximum_batch=1) as generator:
            previous = self.previous[0].reshape(1, -1).numpy() * unit
            found = []
            for segment in range(_SEGMENTS):
                one = slice(segment, segment + 1)
                previous = generator.generate(
                    generator.embeddings[self.labels[one].numpy()],
                    self.motion[one].numpy(),
                    previous,
                    np.zeros((1, SEGMENT_SAMPLES), dtype=np.float32),
                    latent_noise=self.noise[one].reshape(1, -1).numpy(),
                )
                found.append(previous / unit)
        expected = torch.cat(self.waves).reshape(_SEGMENTS, -1)
        return _close("engine: a chain of three segments", torch.from_numpy(np.concatenate(found)), expected, _REMEDY)


def _close(name: str, found: Tensor, expected: Tensor, remedy: str) -> Line:
    """Passes if no number is off by more than LIMIT of the RMS."""
    if found.shape != expected.shape:
        shapes = f"{list(found.shape)} instead of {list(expected.shape)}"
        return judged(_PART, name, False, f"the shape {shapes}", "the same shape", remedy)
    rms = float(expected.double().square().mean().sqrt())
    error = float((found.double() - expected.double()).abs().max()) / max(rms, 1e-30)
    words = f"largest error {error:.2g} of the RMS"
    return judged(_PART, name, error <= LIMIT, words, f"at most {LIMIT:g}", remedy, error=error)


def _run_graphs(jobs: list[tuple[bytes, dict[str, Tensor]]], root: Path) -> list[NDArray[np.float64]]:
    with tempfile.TemporaryDirectory() as place:
        written: list[dict[str, Any]] = []
        for number, (graph, inputs) in enumerate(jobs):
            name = Path(place) / f"{number}.onnx"
            name.write_bytes(graph)
            feeds = {
                key: {"dims": list(value.shape), "data": value.flatten().tolist()} for key, value in inputs.items()
            }
            written.append({"graph": str(name), "inputs": feeds})
        description = Path(place) / "jobs.json"
        description.write_text(json.dumps(written), encoding="utf-8")
        try:
            command = ["node", str(_RUN_GRAPHS), str(description)]
            done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=root)
        except OSError as error:
            raise InputError(f"node cannot be started ({error.strerror}); run ./run build, which needs it too") from error
    if done.returncode != 0:
        raise InputError(f"{_RUN_GRAPHS.name}: {done.stderr.strip()[-400:]}; run `npm ci` in {root.name}")
    return [np.array(result["data"]).reshape(result["dims"]) for result in json.loads(done.stdout)]
