"""Writes a trained run as a `.haptoflow` file: header, embeddings, skeleton, graphs; and golden vectors of it, which are
what PyTorch makes and the C++ engine must reproduce."""

from __future__ import annotations

import copy
import dataclasses
import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import torch
from torch import Tensor

from haptoflow_training.errors import InputError
from haptoflow_training.export.exponents import fit_exponents
from haptoflow_training.export.level_table import LevelTable, MeasuredLevels
from haptoflow_training.export.model_file import ModelFile, write_model_file
from haptoflow_training.export.trained_tier import TrainedTier, load_tiers
from haptoflow_training.models.conditioning import EMBEDDING_SIZE
from haptoflow_training.models.label_embedding import surface_phases
from haptoflow_training.models.level_model import scaled_previous, shift_level
from haptoflow_training.preprocessing.store import SegmentStore
from haptoflow_training.recordings.landing import LabelInfo, Landing
from haptoflow_training.training.batches import HeldOut, SegmentBatch, SegmentBatches
from haptoflow_training.training.config import TrainingConfig
from haptoflow_training.training.run_log import source_commit
from haptoflow_training.waveform import SAMPLE_RATE_HZ, SEGMENT_SAMPLES
from haptoflow_training.whole_file import write_json

def _in_double(batch: SegmentBatch) -> SegmentBatch:
    parts = {field.name: getattr(batch, field.name) for field in dataclasses.fields(batch)}
    return dataclasses.replace(
        batch, **{name: part.double() for name, part in parts.items() if isinstance(part, Tensor) and part.is_floating_point()}
    )


@torch.no_grad()
def write_parity(path: Path, tiers: list[TrainedTier], batch: SegmentBatch, *, model_crc32: int, seed: int) -> None:
    """Write one case for each row of `batch`, cycling through tiers and solvers; the previous waveforms, and what goes
    on beneath them in a tier with a skeleton, are recorded ones. Computed in double precision: an all-pole filter at
    single precision is no reference."""
    generator = torch.Generator().manual_seed(seed)
    tiers = [copy.deepcopy(tier) for tier in tiers]
    for tier in tiers:
        tier.model.double()
    batch = _in_double(batch)
    cases: list[dict[str, Any]] = []
    for row in range(batch.label.shape[0]):
        tier = tiers[row % len(tiers)]
        kind, steps = tier.golden_solvers[row // len(tiers) % len(tier.golden_solvers)]
        embedding = tier.model.embedding(batch.label[row : row + 1])
        # What was played, and another recording for what goes on beneath it.
        pasts = [batch.previous[(row + past) % len(batch.label)] for past in range(tier.model.pasts)]
        motion, previous = batch.motion[row : row + 1], torch.stack(pasts, dim=1)
        where = batch.position_mm[row : row + 1], batch.wander[row : row + 1]
        phases = surface_phases(embedding, motion, *where)
        log_level = tier.model.level(embedding, motion)
        condition = scaled_previous(previous, log_level), embedding, motion, phases
        noise = torch.randn(1, 1, SEGMENT_SAMPLES, generator=generator).double()
        # Nothing rings on from before.
        after_silence = torch.nn.functional.pad(noise, (tier.model.noise_before, 0))
        segment = tier.generate(after_silence, condition, kind, steps)[:, :1] * torch.exp(log_level).unsqueeze(-1)
        cases.append(
            {
                "tier": tier.name,
                "solver": kind,
                "steps": steps,
                "embedding": embedding.flatten().tolist(),
                "motion": motion.flatten().tolist(),
                "phases": phases.flatten().tolist(),
                "previous": previous[:, 0].flatten().tolist(),
                **({"own": previous[:, 1].flatten().tolist()} if tier.model.pasts > 1 else {}),
                "noise": noise.flatten().tolist(),
                "log_level": log_level.item(),
                "segment": segment.flatten().tolist(),
            }
        )
    write_json(path, {"model_crc32": f"{model_crc32:08x}", "cases": cases})


if TYPE_CHECKING:
    from haptoflow_training.training.recordings_source import Source

_PERCENTILES = (5, 25, 50, 75, 95)


def _range(store: SegmentStore) -> dict[str, Any]:
    rows = np.concatenate(
        [
            store.motion[recording.start : recording.start + recording.length]
            for recording in store.recordings
            if recording.split == "train"
        ]
    )
    speed, force = np.hypot(rows[:, 0], rows[:, 1]), rows[:, 2]
    # The last tenth of a per cent is a handful of samples, too few for the network to have learnt from.
    return {
        "speed_mps": [0.0, round(float(np.quantile(speed, 0.999)), 4)],
        "force_newtons": [0.0, round(float(np.quantile(force, 0.999)), 4)],
        "speed_percentiles_mps": [round(float(value), 5) for value in np.percentile(speed, _PERCENTILES)],
        "force_percentiles_newtons": [round(float(value), 4) for value in np.percentile(force, _PERCENTILES)],
    }


def _label_entry(
    store: SegmentStore, row: int, info: LabelInfo, seed: int, held_out: HeldOut, table: LevelTable | None
) -> dict[str, Any]:
    exponents = fit_exponents(store, row, periodic=info.periodic, seed=seed, held_out=held_out)
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
        **({} if info.landing is None else {"impact": _impact_entry(info.landing)}),
        **({} if info.stick_slip is None else {"stick_slip": _rounded(asdict(info.stick_slip))}),
        **({} if not info.rib_wander else {"rib_wander": [_rounded(asdict(each)) for each in info.rib_wander]}),
        **({} if table is None else {"level": table.to_json()}),
    }


def _impact_entry(landing: Landing) -> dict[str, Any]:
    modes = [{key: round(value, 2) for key, value in asdict(mode).items()} for mode in landing.modes]
    return {"modes": modes, "restitution": round(landing.restitution, 3)}


def _rounded(values: dict[str, float]) -> dict[str, float]:
    return {key: round(value, 6) for key, value in values.items()}


def _header(
    config: TrainingConfig,
    tiers: Sequence[TrainedTier],
    source: Source,
    measurements: dict[str, Any],
    level_tables: Mapping[int, LevelTable],
) -> dict[str, Any]:
    store, provenance = source.store, source.provenance
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
            "configuration": described_configuration(config),
            "created": "",
        },
        "sample_rate_hz": SAMPLE_RATE_HZ,
        "segment_samples": SEGMENT_SAMPLES,
        "normalisation": {"unit": "m/s^2", "peak_mps2": float(store.peak_mps2)},
        "range": _range(store),
        "embedding_size": EMBEDDING_SIZE,
        "labels": [
            _label_entry(store, row, info, config.seed, HeldOut.of(config.batch), level_tables.get(row))
            for row, info in enumerate(source.labels)
        ],
        "tiers": [tier.header_entry() for tier in tiers],
        "default_tier": config.tier,
        "measurements": measurements,
    }


def described_configuration(config: TrainingConfig) -> dict[str, Any]:
    """The configuration with only the last part of each path, so that the model file does not reveal folders of this
    machine."""
    described = config.to_dict()
    data = described["data"]
    data["folders"] = [Path(folder).name for folder in data["folders"]]
    data["labels_file"] = Path(data["labels_file"]).name if data["labels_file"] else ""
    return described


def export_run(
    folder: Path,
    source: Source,
    out: Path,
    parity: Path | None = None,
    further_tiers: Sequence[Path] = (),
    levels: MeasuredLevels = MeasuredLevels(),
) -> int:
    """Write the finished run in `folder` to `out`, and golden vectors to `parity`; returns the file's CRC-32.

    further_tiers: folders of runs trained with `--base folder`, each one more tier of the same file. levels: the
    level error of each label, which is subtracted, and level tables.
    """
    store, infos = source.store, source.labels
    tiers = load_tiers([folder, *further_tiers])
    if levels.offsets_db is not None:
        shift = torch.tensor(levels.offsets_db) * (-math.log(10.0) / 20.0)
        for tier in tiers:
            shift_level(tier.model.level, tier.model.embedding.weight, shift)
    default = next(tier for tier in tiers if tier.folder == folder)
    config, model = default.config, default.model
    if [info.name for info in infos] != default.labels:
        raise InputError(f"{folder}: trained on labels {default.labels}, described are {[info.name for info in infos]}")
    run_file = folder / "run.json"
    measurements = json.loads(run_file.read_text(encoding="utf-8")) if run_file.exists() else {}
    measurements.pop("configuration", None)
    if levels.offsets_db is not None:
        measurements["level_offsets_db"] = [round(offset, 3) for offset in levels.offsets_db]
    header = _header(config, tiers, source, measurements, levels.tables)
    graphs = {name: graph for tier in tiers for name, graph in tier.graphs().items()}
    tensors = {name: values for tier in tiers for name, values in tier.tensors().items()}
    tensors["embedding"] = model.embedding.weight.detach().numpy().copy()
    shared = default.shared(store)
    header |= shared.header
    tensors |= shared.tensors
    graphs |= shared.graphs
    file = ModelFile(header=header, tensors=tensors, graphs=graphs)
    checksum = write_model_file(out, file)
    if parity is not None:
        batch = SegmentBatches(store, "validation", config.batch, config.seed).draw(10)
        golden = [tier for tier in tiers if tier.golden_solvers]
        write_parity(parity, golden, batch, model_crc32=checksum, seed=config.seed)
    return checksum
