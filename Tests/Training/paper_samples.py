"""Configurations of the evaluation for tests."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from test_trainer import _config

from haptoflow_paper.runs.configuration import EvaluatedConfig
from haptoflow_training.training.config import TrainingConfig, config_from_dict


def evaluated(config: TrainingConfig, **sections: dict[str, Any]) -> EvaluatedConfig:
    """The same run as one of the evaluation, with these keys of its sections."""
    table = config.to_dict()
    for section, keys in sections.items():
        table[section] = {**table[section], **keys}
    made = config_from_dict(table, Path("test"), EvaluatedConfig)
    assert isinstance(made, EvaluatedConfig)
    return made


def field_config(steps: int = 30, **sections: dict[str, Any]) -> EvaluatedConfig:
    """A short run of a small velocity field, or of a rival in its place."""
    model = {"network": "field", "width": 16, "previous_width": 8, **sections.pop("model", {})}
    return evaluated(_config(steps), model=model, **sections)
