"""Where the evaluation finds configurations and keeps models, trainings and figures."""

from __future__ import annotations

import dataclasses
import json
import zlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from haptoflow_benchmark.rows.row_plan import PlannedRow
from haptoflow_training.training.config import load_config


_CODEC_CONFIGURATION = "paper-codec"


@dataclass(frozen=True)
class Workplace:
    """root: the repository. work: where trainings and models are kept (not committed). results: where measured rows are.
    quick: every fourth recording and no long measurements, and results apart from the whole ones."""

    root: Path
    plan: Path
    work: Path
    store: Path
    results: Path
    quick: bool = False

    @property
    def codec_checkpoint(self) -> Path:
        """The small codec's, which rows in its latents bring with their training."""
        representation = load_config(self.config_file(_CODEC_CONFIGURATION)).model.representation
        return self.root / str(representation["checkpoint"])

    def model_file(self, row: PlannedRow, seed: int) -> Path:
        """The row's model: of the repository, or as its training exports it."""
        if is_of_repository(row, seed):
            return self.root / row.model
        return self.work / "models" / f"{row.model_of(seed)}-{seed}.haptoflow"

    def seeds_of(self, row: PlannedRow) -> list[int]:
        """The row's seeds but for those of a training that the plan's folder does not describe."""
        return [
            seed for seed in row.seeds
            if row.is_reference or is_of_repository(row, seed) or self.config_file(row.model_of(seed)).exists()
        ]  # fmt: skip

    def config_file(self, model: str) -> Path:
        """The configuration that a trained model is made from."""
        return self.plan.parent / f"{model}.toml"

    def configuration(self, model: str, seed: int) -> dict[str, Any]:
        """How a model and seed are trained today, as JSON would give it back."""
        config = dataclasses.replace(load_config(self.config_file(model)), seed=seed)
        described: dict[str, Any] = json.loads(json.dumps(config.to_dict()))
        return described

    def run_folder(self, model: str, seed: int) -> Path:
        """Checkpoints, metrics and log of a training."""
        return self.work / "runs" / f"{model}-{seed}"

    def row_file(self, row: PlannedRow, seed: int) -> Path:
        """Figures of a row and seed."""
        return (self.work / "rows-quick" if self.quick else self.results / "rows") / f"{row.name}-{seed}.json"

    def configuration_crc32(self, row: PlannedRow, seed: int) -> str:
        """Of how a row's model is trained; empty where nothing is trained for it."""
        if row.is_reference or is_of_repository(row, seed):
            return ""
        described = json.dumps(self.configuration(row.model_of(seed), seed), sort_keys=True)
        return f"{zlib.crc32(described.encode()):08x}"


def is_of_repository(row: PlannedRow, seed: int) -> bool:
    """Whether the model of a row's seed is a file of the repository, and not one that the evaluation trains."""
    return row.model_of(seed).endswith(".haptoflow")
