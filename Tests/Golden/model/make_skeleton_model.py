"""Writes skeleton.haptoflow, a small model with an untrained skeleton and an untrained refinement;
skeleton.parity.json: what PyTorch makes of it, step by step, and skeleton.stream.json: a stream of it, which native
code must reproduce.

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
from haptoflow_training.models.skeleton import IMPULSE_GAINS, NOISE_BEFORE, ORDER, OUTPUTS, TAPS, Skeleton
from haptoflow_training.models.haptoflow_model import SkeletonModel
from haptoflow_training.models.label_embedding import advanced
from haptoflow_training.training.config import TrainingConfig
from haptoflow_training.whole_file import write_json

FOLDER = Path(__file__).resolve().parent
# Of the level's perceptron and of the skeleton's two, which the file holds as one.
HIDDEN, PERCEPTRONS, WIDTH, SPECIMENS = 24, (8, 16), 16, 8
LABELS = ("smooth", "ruled")
WAVE_VECTORS: tuple[tuple[tuple[float, float], ...], ...] = ((), ((0.8, 0.0), (0.0, 0.5)))


def build() -> tuple[SkeletonModel, SkeletonModel]:
    """The sketch and its refinement over the same embedding, level and skeleton. Weights are large enough for every
    part to be heard."""
    torch.manual_seed(30)
    sketch = SkeletonModel(
        wave_vectors=WAVE_VECTORS, level=LevelModel(hidden=HIDDEN), skeleton=Skeleton(PERCEPTRONS), specimens=SPECIMENS
    )
    last = sketch.skeleton.perceptron.layers[-1]
    with torch.no_grad():
        filtering, rest = slice(0, ORDER + 1), slice(ORDER + 1, sum(OUTPUTS))
        last.weight[filtering] *= 3.0
        last.weight[ORDER, PERCEPTRONS[0] :] = 0.3 * torch.randn(PERCEPTRONS[1])
        last.weight[rest, PERCEPTRONS[0] :] = 0.3 * torch.randn(last.weight[rest, PERCEPTRONS[0] :].shape)
        last.bias[rest] = 0.2 * torch.randn(last.bias[rest].shape)
        # Impulses strong enough to be heard.
        last.weight[-IMPULSE_GAINS:] /= sketch.skeleton.impulse_factors[:, None]
        last.bias[-IMPULSE_GAINS:] /= sketch.skeleton.impulse_factors
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
    # The skeleton's own share of what was played, without the network's corrections.
    own = size * torch.randn(1, 1, 200, generator=generator)
    motion, phases, previous, noise, own = (each.double() for each in (motion, phases, previous, noise, own))
    # Nothing rings on from before.
    after_silence = torch.nn.functional.pad(noise, (NOISE_BEFORE, 0))
    log_level = sketch.level(embedding, motion)
    scaled = scaled_previous(torch.cat([previous, own], dim=1), log_level)
    gains = sketch.skeleton.gains(embedding, motion, phases)
    parts = sketch.skeleton.parts(after_silence, scaled[:, 1:], gains, phases)
    gain = torch.exp(log_level).unsqueeze(-1)
    refiner = refined.refiner
    assert refiner is not None
    values: dict[str, Tensor] = {
        "embedding": embedding, "motion": motion, "phases": phases, "previous": previous, "own": own, "noise": noise,
        "log_level": log_level, "coefficients": gains.coefficients, "log_gain": gains.log_gain,
        "struck": parts.impulses, "begun": parts.segment, "film": refiner.film(embedding, motion, phases),
        "entering": refiner.entering(parts),
        "sketch_segment": parts.segment * gain,
        "standard_segment": refined.one_step(after_silence, scaled, embedding, motion, phases)[:, :1] * gain,
    }  # fmt: skip
    return {"label": label, **{name: value.flatten().tolist() for name, value in values.items()}}


# Contact states of a stream: label, motion, rates of the waves in Hz, and for how many samples it lasts.
STATES = (
    (1, (0.12, 0.05, 1.5), (96.0, 25.0, 0.0), 40),
    (1, (0.16, 0.02, 1.1), (128.0, 10.0, 0.0), 28),
    (0, (0.1, 0.0, 1.0), (0.0, 0.0, 42.0), 17),
    (0, (0.09, 0.0, 1.0), (0.0, 0.0, 40.0), 120),
)


def golden_stream(sketch: SkeletonModel) -> dict[str, Any]:
    """A stream through several states: the filter continues its own past, and impulses ring on as they were struck,
    relative to the noise of the state in which they sound."""
    skeleton, generator = sketch.skeleton, torch.Generator().manual_seed(400)
    # In single precision, so that numbers are the same whatever the precision of the model.
    own = torch.randn(1, 1, 200, generator=generator, dtype=torch.float32).double()
    turns = torch.rand(1, 3, generator=generator, dtype=torch.float32).double()
    ringing = torch.zeros(1, 1, 200).double()
    begun = own[0, 0, -ORDER:].tolist()
    states = []
    for label, motion_values, rates, count in STATES:
        embedding, motion = sketch.embedding(torch.tensor([label])), torch.tensor([motion_values]).double()
        phases = torch.cat([turns, torch.tensor([rates]).double()], dim=1)
        noise = torch.randn(1, 1, count, generator=generator, dtype=torch.float32).double()
        gains = skeleton.gains(embedding, motion, phases)
        whole = torch.nn.functional.pad(noise, (NOISE_BEFORE, 200 - count))
        silent = gains._replace(impulses=torch.zeros_like(gains.impulses))
        ringing = ringing + skeleton.impulses(whole, gains.impulses)
        # Impulses and all else add up before the filter, which is linear.
        gain = gains.log_gain.exp().unsqueeze(2)
        bare = skeleton.parts(whole, own, silent, phases).segment
        rung = skeleton.filter((gain * ringing)[:, 0], gains.coefficients, torch.zeros(1, ORDER).double())
        unit = bare[:, :, :count] + rung[:, None, :count]
        states.append({
            "label": label, "motion": motion.flatten().tolist(), "phases": phases.flatten().tolist(),
            "noise": noise.flatten().tolist(), "impulses": (gain * ringing)[0, 0, :count].tolist(),
            "unit": unit.flatten().tolist(),
        })  # fmt: skip
        own = torch.cat([own[:, :, count:], unit], dim=2)
        ringing = torch.nn.functional.pad(ringing[:, :, count:], (0, count))
        turns = advanced(phases, count)[:, :3]
    return {"begun": begun, "states": states, "past": own[0, 0, -ORDER:].tolist(), "ringing": ringing[0, 0, :TAPS].tolist()}


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
    crc32 = {"model_crc32": f"{checksum:08x}"}
    cases = [golden_case(*exact(sketch, refined), number) for number in range(len(CASES))]
    write_json(FOLDER / "skeleton.parity.json", crc32 | {"cases": cases})
    write_json(FOLDER / "skeleton.stream.json", crc32 | golden_stream(exact(sketch, refined)[0]))


if __name__ == "__main__":
    main()
