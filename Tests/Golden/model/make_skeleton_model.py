"""Writes skeleton.haptoflow, a small model with an untrained skeleton and an untrained refinement, and
skeleton.parity.json: what PyTorch makes of it, step by step, which native code must reproduce.

    PYTHONPATH=Training /usr/bin/python3 Tests/Golden/model/make_skeleton_model.py
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import torch
from torch import Tensor

from haptoflow_training.export.model_file import ModelFile, write_model_file
from haptoflow_training.export.skeleton_tensors import skeleton_header, skeleton_tensors
from haptoflow_training.export.trained_tier import TrainedTier
from haptoflow_training.models.level_model import LevelModel, scaled_previous
from haptoflow_training.models.refiner import Refiner
from haptoflow_training.models.skeleton import ORDER, OUTPUTS, Skeleton
from haptoflow_training.models.haptoflow_model import SkeletonModel
from haptoflow_training.training.config import TrainingConfig
from haptoflow_training.training.run_log import write_json

FOLDER = Path(__file__).resolve().parent
HIDDEN, WIDTH, SPECIMENS = 24, 16, 8
LABELS = ("smooth", "ruled")
WAVE_VECTORS: tuple[tuple[tuple[float, float], ...], ...] = ((), ((0.8, 0.0), (0.0, 0.5)))


def build() -> tuple[SkeletonModel, SkeletonModel]:
    """The sketch and its refinement over the same embedding, level and skeleton. Weights are large enough for every
    part to be heard."""
    torch.manual_seed(30)
    sketch = SkeletonModel(
        wave_vectors=WAVE_VECTORS, level=LevelModel(hidden=HIDDEN), skeleton=Skeleton(HIDDEN), specimens=SPECIMENS
    )
    last = sketch.skeleton.perceptron.layers[-1]
    with torch.no_grad():
        filtering, rest = slice(0, ORDER + 1), slice(ORDER + 1, sum(OUTPUTS))
        last.weight[filtering] *= 3.0
        last.weight[rest] = 0.3 * torch.randn(last.weight[rest].shape)
        last.bias[rest] = 0.2 * torch.randn(last.bias[rest].shape)
        sketch.embedding.pieces.normal_()
    refined = SkeletonModel(
        wave_vectors=WAVE_VECTORS, level=sketch.level, skeleton=sketch.skeleton,
        refiner=Refiner(width=WIDTH, previous_width=8), specimens=SPECIMENS,
    )  # fmt: skip
    refined.embedding = sketch.embedding
    with torch.no_grad():
        for parameter in (refined.refiner.leave.weight, refined.refiner.leave.bias):
            parameter.normal_(std=0.2)
    return sketch.eval().requires_grad_(False), refined.eval().requires_grad_(False)


def header(tiers: list[TrainedTier], skeleton: Skeleton) -> dict[str, Any]:
    label = {
        "category": "golden", "level_exponents": {"speed": 0.9, "force": 0.2}, "frequency_exponent": 0.5,
        "stiffness_newtons_per_metre": 1000.0, "friction_coefficient": 0.4,
    }  # fmt: skip
    slip = {"stick_slip": {"length_metres": 0.0011, "wander": 0.25, "wander_metres": 0.004}}
    ruled = {
        "periodic": True, "wavelength_metres": 0.00125,
        "rib_wander": [{"turns": 0.12, "wavelength_metres": 0.00875}, {"turns": 0.0, "wavelength_metres": 0.014}],
    }  # fmt: skip
    return {
        "format": "haptoflow", "name": "golden skeleton", "description": "Untrained. For tests only.",
        "provenance": {
            "statement": "untrained", "recordings": "none", "licence": "MIT", "seed": 30, "commit": "",
            "configuration": {}, "created": "",
        },
        "sample_rate_hz": 2000, "segment_samples": 200,
        "normalisation": {"unit": "m/s^2", "peak_mps2": 1.0},
        "range": {
            "speed_mps": [0.0, 1.0], "force_newtons": [0.0, 3.0],
            "speed_percentiles_mps": [0.01, 0.05, 0.1, 0.2, 0.4],
            "force_percentiles_newtons": [0.2, 0.5, 1.0, 1.5, 2.0],
        },
        "embedding_size": 64,
        "labels": [
            {"name": LABELS[0], "embedding_row": 0, **label, "periodic": False, "wavelength_metres": None, **slip},
            {"name": LABELS[1], "embedding_row": 1, **label, **ruled},
        ],
        "tiers": [tier.header_entry() for tier in tiers],
        "default_tier": "standard",
        "skeleton": skeleton_header(skeleton),
    }  # fmt: skip


CASES = (
    # label, motion, rates of both rib families and of stick-slip in Hz, size of the past in m/s^2
    (0, (0.1, 0.0, 1.0), (0.0, 0.0, 0.0), 0.5),
    (0, (0.03, -0.02, 0.4), (0.0, 0.0, 42.0), 0.1),
    (0, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), 0.0),
    (1, (0.12, 0.05, 1.5), (96.0, 25.0, 0.0), 1.0),
    (1, (-0.2, 0.3, 2.5), (-160.0, 150.0, 0.0), 3.0),
    (1, (0.0004, 0.0, 0.2), (0.32, 0.0, 0.0), 100.0),
    (1, (0.9, 0.0, 3.0), (720.0, 0.0, 300.0), 2.0),
)


def golden_case(sketch: SkeletonModel, refined: SkeletonModel, number: int) -> dict[str, Any]:
    label, motion_values, rates, size = CASES[number]
    generator = torch.Generator().manual_seed(300 + number)
    embedding, motion = sketch.embedding(torch.tensor([label])), torch.tensor([motion_values])
    phases = torch.cat([torch.rand(1, 3, generator=generator), torch.tensor([rates])], dim=1)
    previous = size * torch.randn(1, 1, 200, generator=generator)
    noise = torch.randn(1, 1, 200, generator=generator)
    motion, phases, previous, noise = (each.double() for each in (motion, phases, previous, noise))
    log_level = sketch.level(embedding, motion)
    scaled = scaled_previous(previous, log_level)
    gains = sketch.skeleton.gains(embedding, motion, phases)
    parts = sketch.skeleton.parts(noise, scaled, gains, phases)
    gain = torch.exp(log_level).unsqueeze(-1)
    refiner = refined.refiner
    assert refiner is not None
    values: dict[str, Tensor] = {
        "embedding": embedding, "motion": motion, "phases": phases, "previous": previous, "noise": noise,
        "log_level": log_level, "coefficients": gains.coefficients, "log_gain": gains.log_gain,
        "struck": parts.impulses, "begun": parts.segment, "film": refiner.film(embedding, motion, phases),
        "entering": refiner.entering(parts),
        "sketch_segment": parts.segment * gain,
        "standard_segment": refined.one_step(noise, scaled, embedding, motion, phases) * gain,
    }  # fmt: skip
    return {"label": label, **{name: value.flatten().tolist() for name, value in values.items()}}


def exact(sketch: SkeletonModel, refined: SkeletonModel) -> tuple[SkeletonModel, SkeletonModel]:
    """The same weights in double precision. In single precision, angles of many turns and the constants of the modules
    lose more than native code may differ."""
    torch.set_default_dtype(torch.float64)
    models = build()
    torch.set_default_dtype(torch.float32)
    for model, single in zip(models, (sketch, refined)):
        model.load_state_dict(single.state_dict())
    return models


def main() -> None:
    sketch, refined = build()
    tiers = [
        TrainedTier(TrainingConfig(tier=name), list(LABELS), model)
        for name, model in (("sketch", sketch), ("standard", refined))
    ]
    file = ModelFile(
        header=header(tiers, sketch.skeleton),
        tensors={
            "embedding": sketch.embedding.weight.numpy().copy(), "pieces": sketch.embedding.offsets.numpy().copy(),
            **skeleton_tensors(sketch.level, sketch.skeleton), **tiers[1].tensors(),
        },
        graphs=tiers[1].graphs(),
    )  # fmt: skip
    checksum = write_model_file(FOLDER / "skeleton.haptoflow", file)
    cases = [golden_case(*exact(sketch, refined), number) for number in range(len(CASES))]
    write_json(FOLDER / "skeleton.parity.json", {"model_crc32": f"{checksum:08x}", "cases": cases})


if __name__ == "__main__":
    main()
