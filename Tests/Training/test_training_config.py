"""A run's TOML file: every key checked, every error naming file and key."""

from __future__ import annotations

from pathlib import Path

import pytest

from haptoflow_training.errors import InputError
from haptoflow_training.training.config import config_from_dict, load_config

CONFIGURATIONS = Path(__file__).parents[2] / "Training" / "configs"


def _load(tmp_path: Path, text: str) -> object:
    path = tmp_path / "run.toml"
    path.write_text(text, encoding="utf-8")
    return load_config(path)


@pytest.mark.parametrize("name", ["default.toml", "cluster.toml"])
def test_the_shipped_configurations_load(name: str) -> None:
    assert load_config(CONFIGURATIONS / name).optimiser.steps > 0


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("speling = 1", "unknown key 'speling'"),
        ("[optimiser]\nlearning_rat = 1e-3", "unknown key 'optimiser.learning_rat'"),
        ("[optimiser]\nsteps = 'many'", "'optimiser.steps' is 'many', expected int"),
        ("[optimiser]\nsteps = true", "'optimiser.steps' is True, expected int"),
        ("[optimiser]\nlearning_rate = -1.0", "'optimiser.learning_rate' is out of range"),
        ("[solver]\nkind = 'rk4'", "'solver.kind' is out of range"),
        ("[solver]\nsteps = 17", "'solver.steps' is out of range"),
        ("[batch]\nhop_samples = [50, 20]", "'batch.hop_samples' is out of range"),
        ("data = 3", "'data' must be a table"),
        ("not toml at all", "is not TOML"),
    ],
)
def test_a_wrong_key_or_value_is_named_with_its_file(tmp_path: Path, text: str, complaint: str) -> None:
    with pytest.raises(InputError) as raised:
        _load(tmp_path, text)
    assert complaint in str(raised.value)
    assert "run.toml" in str(raised.value)


def test_a_missing_file_is_named() -> None:
    with pytest.raises(InputError, match="nowhere.toml"):
        load_config(Path("nowhere.toml"))


def test_a_configuration_survives_the_way_through_a_checkpoint() -> None:
    config = load_config(CONFIGURATIONS / "default.toml")
    assert config_from_dict(config.to_dict(), Path("checkpoint.pt")) == config
