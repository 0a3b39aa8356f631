"""Writes a model file with the paper's architecture in its published size and random weights, to measure its time.

The sizes are those of Training/haptoflow_paper/configs/paper-codec-size.toml: EnCodec at 24 kHz and a U-Net of 128 and 256
channels. The values of weights do not affect the time, so nothing is trained and no recording is read.

PYTHONPATH=Training python3 Training/haptoflow_paper/rows/paper_model.py CONFIG.toml OUT.haptoflow
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
import torch

from haptoflow_paper.codec.representation import CodecRepresentation
from haptoflow_training.errors import InputError
from haptoflow_training.export.model_file import ModelFile, write_model_file
from haptoflow_paper.runs.tier import export_level_model, export_network
from haptoflow_training.models.conditioning import EMBEDDING_SIZE
from haptoflow_training.models.haptoflow_model import HaptoFlowModel, parameter_count
from haptoflow_training.training.config import TrainingConfig, load_config
from haptoflow_training.training.trainer import build_model

_SEED_SAMPLES = 400


def _graphs(model: HaptoFlowModel, codec: CodecRepresentation) -> dict[str, bytes]:
    graphs = {"field": export_network(model, "flow"), "level": export_level_model(model.level)}
    with tempfile.TemporaryDirectory() as folder:
        for name, export in (("encoder", codec.export_encoder), ("decoder", codec.export_decoder)):
            path = Path(folder) / f"{name}.onnx"
            export(path)
            graphs[name] = path.read_bytes()
    return graphs


def _header(config: TrainingConfig, model: HaptoFlowModel, codec: CodecRepresentation) -> dict[str, Any]:
    percentiles = [0.05, 0.1, 0.2, 0.3, 0.4]
    tier = {
        "name": "standard",
        "kind": "flow",
        "field": "field",
        "level": "level",
        "encoder": "encoder",
        "decoder": "decoder",
        "solver": config.solver.kind,
        "steps": config.solver.steps,
        "parameters": parameter_count(model.field),
        "representation": "latent",
        "latent_shape": list(codec.shape),
        "accuracy": {},
        "cost": {},
    }
    label = {
        "name": "nothing",
        "embedding_row": 0,
        "category": "none",
        "level_exponents": {"speed": 0.0, "force": 0.0},
        "frequency_exponent": 0.0,
        "periodic": False,
        "wavelength_metres": None,
        "stiffness_newtons_per_metre": 500.0,
        "friction_coefficient": 0.3,
    }
    return {
        "format": "haptoflow",
        "name": config.name,
        "description": "The paper's architecture in its own size, with random weights: for its time alone.",
        "provenance": {
            "statement": "not trained: random weights",
            "recordings": "none",
            "licence": config.licence,
            "seed": config.seed,
            "commit": "",
            "configuration": config.to_dict(),
            "created": "",
        },
        "sample_rate_hz": 2000,
        "segment_samples": 200,
        "normalisation": {"unit": "m/s^2", "peak_mps2": 10.0},
        "range": {
            "speed_mps": [0.0, 0.5],
            "force_newtons": [0.0, 5.0],
            "speed_percentiles_mps": percentiles,
            "force_percentiles_newtons": percentiles,
        },
        "embedding_size": EMBEDDING_SIZE,
        "labels": [label],
        "tiers": [tier],
        "default_tier": "standard",
        "seed_bank": {
            "samples": _SEED_SAMPLES,
            "tensor": "seeds",
            "entries": [{"label": "nothing", "velocity_mps": [0.1, 0.0], "force_newtons": 1.0}],
        },
    }


def make_paper_model(config_path: Path, out: Path) -> int:
    """Write the model file; returns its CRC-32. InputError if the configuration is not a latent U-Net."""
    config = load_config(config_path)
    torch.manual_seed(config.seed)
    model = build_model(config, [()]).eval()
    codec = model.representation
    if not isinstance(codec, CodecRepresentation):
        raise InputError(f"{config_path}: model.representation is raw, expected a codec: the paper works on latents")
    seeds = np.random.default_rng(config.seed).standard_normal((1, _SEED_SAMPLES))
    seeds /= np.sqrt(np.square(seeds).mean())
    file = ModelFile(
        header=_header(config, model, codec),
        tensors={"embedding": model.embedding.weight.detach().numpy().copy(), "seeds": seeds.astype(np.float32)},
        graphs=_graphs(model, codec),
    )
    return write_model_file(out, file)


def main(words: list[str]) -> int:
    if len(words) != 2:
        print(f"usage: {Path(__file__).name} CONFIG.toml OUT.haptoflow", file=sys.stderr)
        return 2
    try:
        checksum = make_paper_model(Path(words[0]), Path(words[1]))
    except InputError as error:
        print(f"{Path(__file__).name}: {error}", file=sys.stderr)
        return 3
    print(f"{words[1]}: CRC-32 {checksum:08x}")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
