"""What runs of the evaluation add to those of the product, and that their stored rows belong to their configurations."""

from __future__ import annotations

import json
from pathlib import Path

import torch
from paper_samples import evaluated
from test_trainer import _config

from haptoflow_paper.rows.row_plan import load_plan
from haptoflow_paper.rows.workplace import Workplace
from haptoflow_paper.runs.networks import AverageVelocityField
from haptoflow_paper.runs.trainer import EvaluatedTrainer
from haptoflow_training.models.velocity_field import VelocityField
from haptoflow_training.training.config import TrainingConfig, config_from_dict, load_config
from haptoflow_training.training.trainer import Trainer, build_model

PAPER = Path(__file__).parents[2] / "Training" / "haptoflow_paper"
CONDITION = (torch.full((2, 64), 0.1), torch.full((2, 3), 0.2), torch.full((2, 6), 0.3))


def test_every_published_row_was_measured_with_the_present_configuration_of_its_model() -> None:
    place = Workplace(PAPER.parents[1], PAPER / "configs" / "rows.toml", Path("work"), Path("store"), PAPER / "results")
    published = json.loads((place.results / "accuracy-time.json").read_text(encoding="utf-8"))
    checked = 0
    for row in load_plan(place.plan):
        for seed in place.seeds_of(row):
            if not place.row_file(row, seed).exists():
                assert row.name in published["not_measured"] or seed != row.seeds[0], f"{row.name}, seed {seed}"
                continue
            stored = json.loads(place.row_file(row, seed).read_text(encoding="utf-8"))["made_from"]
            assert stored["configuration_crc32"] == place.configuration_crc32(row, seed), f"{row.name}, seed {seed}"
            checked += bool(stored["configuration_crc32"])
    assert checked >= 4


def _moved(field: torch.nn.Module) -> torch.nn.Module:
    """A field whose weights are all different from zero."""
    generator = torch.Generator().manual_seed(4)
    with torch.no_grad():
        for parameter in field.parameters():
            parameter.copy_(0.1 * torch.randn(parameter.shape, generator=generator))
    return field.eval()


def test_an_average_velocity_depends_on_its_interval_and_is_the_velocity_without_one() -> None:
    field = _moved(AverageVelocityField(width=16, previous_width=8))
    given = (torch.randn(2, 1, 200), torch.zeros(2, 1), torch.zeros(2, 1, 200), *CONDITION)
    whole, half = field(*given, torch.ones(2, 1)), field(*given, 0.5 * torch.ones(2, 1))
    assert not torch.allclose(whole, half)
    plain = VelocityField(width=16, previous_width=8)
    plain.load_state_dict({name: value for name, value in field.state_dict().items() if not name.startswith("interval.")})
    assert torch.equal(plain(*given), field(*given))


def test_a_configuration_names_the_classes_that_train_and_export_it() -> None:
    averaging = evaluated(_config(), recipe={"objective": "average-velocity"})
    assert isinstance(build_model(averaging, [(), ()]).field, AverageVelocityField)
    assert type(build_model(_config(), [(), ()])).__name__ == "FieldModel"


def test_an_evaluated_run_with_no_key_of_its_own_has_the_weights_and_phases_of_the_product() -> None:
    product = config_from_dict(_config().to_dict(), Path("test"), TrainingConfig)
    models = []
    for config in (product, evaluated(product)):
        torch.manual_seed(8)
        models.append(build_model(config, [(), ()]).state_dict())
    assert models[0].keys() == models[1].keys()
    assert all(torch.equal(models[0][name], models[1][name]) for name in models[0])
    phases = [trainer.phases(config) for trainer, config in ((Trainer, product), (EvaluatedTrainer, evaluated(product)))]
    assert phases[0] == phases[1]


def test_an_ablation_is_a_patch_of_few_keys_of_the_recipe_that_it_extends() -> None:
    ours = load_config(PAPER / "configs" / "sketch.toml").to_dict()
    for file in sorted((PAPER / "configs").glob("sketch-*.toml")):
        ablation = load_config(file).to_dict()
        changed = {
            (section, key)
            for section in ("data", "model", "optimiser", "batch", "recipe", "solver")
            for key, value in ablation[section].items()
            if value != ours[section][key]
        }
        assert 1 <= len(changed) <= 2, (file.name, changed)
