"""A run's TOML file: every key checked, every error naming file and key."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import pytest

from haptoflow_paper.rows.row_plan import load_plan
from haptoflow_training.errors import InputError
from haptoflow_training.models.haptoflow_model import SkeletonModel
from haptoflow_training.training.config import TrainingConfig, config_of_run, load_config
from haptoflow_training.training.trainer import Trainer, build_model, planned_steps
from places import TRAINING

CONFIGURATIONS = TRAINING / "configs"
PAPER = TRAINING / "haptoflow_paper" / "configs"


def _load(tmp_path: Path, text: str) -> TrainingConfig:
    path = tmp_path / "run.toml"
    path.write_text(text, encoding="utf-8")
    return load_config(path)


TRAININGS = sorted(
    path.relative_to(TRAINING).as_posix()
    for pattern in ("configs/own.toml", "configs/refine-*.toml", "configs/*/*.toml", "haptoflow_paper/configs/*.toml")
    for path in TRAINING.glob(pattern)
    if path.name not in ("rows.toml", "codec-small.toml")
)


@pytest.mark.parametrize("name", TRAININGS)
def test_the_shipped_configurations_load_and_plan_steps(name: str) -> None:
    assert sum(planned_steps(load_config(TRAINING / name))) > 0


@pytest.mark.parametrize("name", ["base", "draft", "standard"])
def test_what_is_trained_on_the_cluster_data_set_is_what_ships(name: str) -> None:
    shipped, cluster = (load_config(CONFIGURATIONS / folder / f"{name}.toml") for folder in ("default", "cluster"))
    assert cluster.data.source == "folders" and cluster.name == "cluster" and cluster.licence == "CC BY 4.0"
    for part in ("tier", "seed", "threads", "model", "optimiser", "recipe"):
        assert getattr(cluster, part) == getattr(shipped, part), part
    _requires_all_but_the_ranges(cluster, shipped)
    assert Trainer.phases(cluster) == Trainer.phases(shipped)
    assert Trainer.losses_of(cluster) is Trainer.losses_of(shipped)


def _requires_all_but_the_ranges(config: TrainingConfig, shipped: TrainingConfig) -> None:
    """The batches are those of the shipped model, with nothing held out but recordings."""
    nothing = {f"held_out_{name}": () for name in ("speed_mps", "force_newtons", "direction_degrees")}
    share = config.batch.machine_share
    assert config.batch == dataclasses.replace(shipped.batch, **nothing, machine_share=share)


def test_a_configuration_that_names_no_network_trains_the_tier_that_ships_without_one(tmp_path: Path) -> None:
    config = _load(tmp_path, 'name = "mine"\n')
    shipped = load_config(CONFIGURATIONS / "default" / "base.toml")
    assert config.model == shipped.model and config.tier == shipped.tier == "sketch"
    assert isinstance(build_model(config, [(), ()]), SkeletonModel)


def test_recordings_of_one_s_own_train_labels_alone() -> None:
    phases = Trainer.phases(load_config(CONFIGURATIONS / "own.toml"))
    assert [(phase.name, phase.objective) for phase in phases] == [("embedding", "likelihood")]


def test_a_skeleton_s_filter_is_fitted_before_its_likelihood_and_a_refinement_has_none() -> None:
    base, standard = (load_config(CONFIGURATIONS / "default" / f"{name}.toml") for name in ("base", "standard"))
    objectives = [[phase.objective for phase in Trainer.phases(config)] for config in (base, standard)]
    assert objectives == [["level", "filter", "likelihood", "energy", "energy", "level"], ["energy", "energy"]]


def test_a_configuration_takes_what_it_does_not_set_from_the_one_it_extends(tmp_path: Path) -> None:
    (tmp_path / "base.toml").write_text("seed = 5\n[optimiser]\nsteps = 7\nbatch_size = 3\n", encoding="utf-8")
    config = _load(tmp_path, 'extends = "base.toml"\n[optimiser]\nsteps = 9\n')
    assert (config.seed, config.optimiser.steps, config.optimiser.batch_size) == (5, 9, 3)


def test_of_several_extended_configurations_the_later_one_goes_before(tmp_path: Path) -> None:
    (tmp_path / "one.toml").write_text("seed = 5\n[optimiser]\nsteps = 7\nbatch_size = 3\n", encoding="utf-8")
    (tmp_path / "two.toml").write_text("seed = 6\n[optimiser]\nsteps = 8\n", encoding="utf-8")
    config = _load(tmp_path, 'extends = ["one.toml", "two.toml"]\n[optimiser]\nlevel_steps = 4\n')
    assert (config.seed, config.optimiser.steps) == (6, 8)
    assert (config.optimiser.batch_size, config.optimiser.level_steps) == (3, 4)
    with pytest.raises(InputError, match="'extends' is .*, or a list of such names"):
        _load(tmp_path, 'extends = ["one.toml", 3]')


def test_a_configuration_that_extends_itself_is_refused(tmp_path: Path) -> None:
    (tmp_path / "other.toml").write_text('extends = "run.toml"', encoding="utf-8")
    with pytest.raises(InputError, match="leads back"):
        _load(tmp_path, 'extends = "other.toml"')


def test_every_row_of_the_evaluation_names_a_model_or_a_training_that_is_there() -> None:
    for row in load_plan(PAPER / "rows.toml"):
        if row.model and not row.model.endswith(".haptoflow"):
            assert (PAPER / f"{row.model}.toml").is_file(), row.name


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ('[[row]]\nname = "a"\nblock = "ours"', "'model' is missing"),
        ('[[row]]\nname = "a"\nmodel = "b"', "'block' is missing"),
        ('[[row]]\nname = "a"\nblock = "rivals"\nmodel = "b"', "'rivals', expected one of ours"),
        ('[[row]]\nname = "a"\nblock = "reference"\nmodel = "b"', "are of the block 'reference'"),
        ('[[row]]\nname = "a"\nblok = "b"', "unknown key 'blok'"),
        ('[[row]]\nname = "a"\nblock = "ours"\nmodel = "b"\nseeds = []', "'seeds' is empty"),
        ('[[row]]\nname = "a"\nblock = "ours"\nmodel = "b"\nagainst = "c"', "names no row of the plan: 'c'"),
        (
            '[[row]]\nname = "a"\nblock = "ours"\nmodel = "m"\n'
            '[[row]]\nname = "b"\nblock = "ablation"\nmodel = "m"\nagainst = "a"\nevery_fourth = true',
            "row 'b': key 'against' names 'a', which is measured on other recordings",
        ),
        ('[[row]]\nname = "silence"\nblock = "reference"\n' * 2, "stands there twice"),
        ("", "no \\[\\[row"),
    ],
)
def test_a_wrong_plan_is_refused_with_row_and_key_named(tmp_path: Path, text: str, complaint: str) -> None:
    (tmp_path / "rows.toml").write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=complaint):
        load_plan(tmp_path / "rows.toml")


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
        ("[recipe]\nobjective = 'magic'", "'recipe.objective' is out of range"),
        ("[recipe]\nobjective = 'average-velocity'\nenergy_steps = 5", "'recipe.objective' is out of range"),
        ("[model]\nnetwork = 'gan'", "'model.network' is out of range, expected one of field, skeleton, refinement"),
        ("[model]\nnetwork = 'refinement'", "'recipe.shares_base' is out of range, expected true"),
        ("[model]\nnetwork = 'skeleton'\nhidden = [8, 4]", "'model.hidden' is out of range"),
        ("tier = 'quick'", "'tier' is out of range, expected one of sketch, draft, standard"),
        ("[batch]\nheld_out_speed_mps = [0.3, 0.2]", "'batch.held_out_speed_mps' is out of range"),
        ("extends = 'nowhere.toml'", "nowhere.toml"),
        ("[batch]\nhop_samples = [50, 20]", "'batch.hop_samples' is out of range"),
        ("data = 3", "'data' must be a table"),
        ("not toml at all", "not valid TOML"),
    ],
)
def test_a_wrong_key_or_value_is_named_with_its_file(tmp_path: Path, text: str, complaint: str) -> None:
    with pytest.raises(InputError) as raised:
        _load(tmp_path, text)
    assert complaint in str(raised.value)
    assert "run.toml" in str(raised.value) or "nowhere.toml" in str(raised.value)


def test_a_missing_file_is_named() -> None:
    with pytest.raises(InputError, match="nowhere.toml"):
        load_config(Path("nowhere.toml"))


def test_a_configuration_is_restored_from_a_checkpoint() -> None:
    config = load_config(CONFIGURATIONS / "default" / "standard.toml")
    of_another_version = {**config.to_dict(), "gone": 1, "solver": {"kind": "midpoint", "sort": 3}}
    assert config_of_run(of_another_version, Path("checkpoint.pt")) == config
