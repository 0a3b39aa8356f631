"""What runs of the evaluation add to those of the product, and that their stored rows belong to their configurations."""

from __future__ import annotations

import json
from pathlib import Path

import torch
from paper_samples import evaluated
from test_trainer import _config

from haptoflow_paper.rows.row_plan import load_plan
from haptoflow_paper.rows.workplace import Workplace
from haptoflow_paper.runs.trainer import EvaluatedTrainer
from haptoflow_training.training.config import TrainingConfig, config_from_dict
from haptoflow_training.training.trainer import Trainer, build_model

PAPER = Path(__file__).parents[2] / "Training" / "haptoflow_paper"


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
