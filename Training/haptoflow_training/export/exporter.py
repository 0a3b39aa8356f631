"""A trained run becomes a `.haptoflow` file: header, embeddings, seed bank, graphs."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from haptoflow_training.errors import InputError
from haptoflow_training.export.exponents import fit_exponents
from haptoflow_training.export.label_info import LabelInfo
from haptoflow_training.export.model_file import ModelFile, write_model_file
from haptoflow_training.export.onnx_graphs import export_level_model, export_velocity_field
from haptoflow_training.export.parity import write_parity
from haptoflow_training.export.seed_bank import SEED_SAMPLES, build_seed_bank
from haptoflow_training.models.conditioning import EMBEDDING_SIZE
from haptoflow_training.models.haptoflow_model import HaptoFlowModel
from haptoflow_training.models.velocity_field import parameter_count
from haptoflow_training.training.batches import SEGMENT_SAMPLES, SegmentBatches, Store
from haptoflow_training.training.config import TrainingConfig
from haptoflow_training.training.run_log import source_commit
from haptoflow_training.training.trainer import load_trained

_TIER = "standard"
_PERCENTILES = (5, 25, 50, 75, 95)


@dataclass(frozen=True)
class Provenance:
    """Where the recordings come from, in words that stand in the file."""

    statement: str
    recordings: str
    licence: str
    created: str


def _range(store: Store) -> dict[str, Any]:
    rows = np.concatenate(
        [
            store.motion[recording.start : recording.start + recording.length]
            for recording in store.recordings
            if recording.split == "train"
        ]
    )
    speed, force = np.hypot(rows[:, 0], rows[:, 1]), rows[:, 2]
    # The last tenth of a per cent is a handful of samples: too few to have been learnt from.
    return {
        "speed_mps": [0.0, round(float(np.quantile(speed, 0.999)), 4)],
        "force_newtons": [0.0, round(float(np.quantile(force, 0.999)), 4)],
        "speed_percentiles_mps": [round(float(value), 5) for value in np.percentile(speed, _PERCENTILES)],
        "force_percentiles_newtons": [round(float(value), 4) for value in np.percentile(force, _PERCENTILES)],
    }


def _label_entry(store: Store, row: int, info: LabelInfo, seed: int) -> dict[str, Any]:
    exponents = fit_exponents(store, row, periodic=info.periodic, seed=seed)
    return {
        "name": info.name,
        "embedding_row": row,
        "category": info.category,
        "level_exponents": {"speed": round(exponents.level_speed, 4), "force": round(exponents.level_force, 4)},
        "frequency_exponent": round(exponents.frequency, 4),
        "periodic": info.periodic,
        "wavelength_metres": info.wavelength_metres,
        "stiffness_newtons_per_metre": info.stiffness_newtons_per_metre,
        "friction_coefficient": info.friction_coefficient,
    }


def _header(
    config: TrainingConfig,
    model: HaptoFlowModel,
    store: Store,
    infos: Sequence[LabelInfo],
    provenance: Provenance,
    seed_entries: list[dict[str, object]],
    measurements: dict[str, Any],
) -> dict[str, Any]:
    return {
        "format": "haptoflow",
        "name": config.name,
        "description": config.description,
        "provenance": {
            "statement": provenance.statement,
            "recordings": provenance.recordings,
            "licence": provenance.licence,
            "seed": config.seed,
            "commit": measurements.get("commit", source_commit(Path(__file__).parent)),
            "configuration": config.to_dict(),
            "created": provenance.created,
        },
        "sample_rate_hz": 2000,
        "segment_samples": SEGMENT_SAMPLES,
        "normalisation": {"unit": "m/s^2", "peak_mps2": float(store.peak_mps2)},
        "range": _range(store),
        "embedding_size": EMBEDDING_SIZE,
        "labels": [_label_entry(store, row, info, config.seed) for row, info in enumerate(infos)],
        "tiers": [
            {
                "name": _TIER,
                "kind": "flow",
                "field": "standard.field",
                "level": "level",
                "solver": config.solver.kind,
                "steps": config.solver.steps,
                "parameters": parameter_count(model.field),
                "representation": "raw",
                "accuracy": {},
                "cost": {},
            }
        ],
        "default_tier": _TIER,
        "seed_bank": {"samples": SEED_SAMPLES, "tensor": "seeds", "entries": seed_entries},
        "measurements": measurements,
    }


def export_run(
    folder: Path,
    store: Store,
    infos: Sequence[LabelInfo],
    provenance: Provenance,
    out: Path,
    parity: Path | None = None,
) -> int:
    """Write the finished run in `folder` to `out`, and golden vectors to `parity`; returns the file's CRC-32."""
    config, labels, model = load_trained(folder)
    if [info.name for info in infos] != labels:
        raise InputError(f"{folder}: trained on labels {labels}, described are {[info.name for info in infos]}")
    if config.model.representation.get("kind", "raw") != "raw":
        raise InputError(
            f"{folder}: representation '{config.model.representation['kind']}' cannot be exported yet: the engine "
            "runs raw segments; train with representation kind 'raw'"
        )
    bank = build_seed_bank(store, seed=config.seed)
    run_file = folder / "run.json"
    measurements = json.loads(run_file.read_text(encoding="utf-8")) if run_file.exists() else {}
    measurements.pop("configuration", None)
    header = _header(config, model, store, infos, provenance, bank.entries, measurements)
    file = ModelFile(
        header=header,
        tensors={"embedding": model.embedding.weight.detach().numpy().copy(), "seeds": bank.waves},
        graphs={
            "standard.field": export_velocity_field(model.field),
            "level": export_level_model(model.level),
        },
    )
    checksum = write_model_file(out, file)
    if parity is not None:
        batch = SegmentBatches(store, "validation", config.batch, config.seed).draw(10)
        write_parity(parity, model, batch, tier=_TIER, model_crc32=checksum, seed=config.seed)
    return checksum
