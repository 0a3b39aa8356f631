"""Configurations of the evaluation for tests."""

from __future__ import annotations

from pathlib import Path
from typing import Any

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
