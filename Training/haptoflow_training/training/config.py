"""The configuration of a training run, from one TOML file. Every key is checked, so that a misspelt key is an error."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, ClassVar, TypeVar

from haptoflow_training.errors import InputError
from haptoflow_training.extensions import configuration_class
from haptoflow_training.whole_file import read_toml

Rule = tuple[bool, str, str]
# The order of tiers in a file; the most accurate comes last.
TIER_NAMES = ("sketch", "draft", "standard")
# Of a perceptron that native code reads.
MAXIMUM_HIDDEN = 512


@dataclass(frozen=True)
class DataConfig:
    """Where the recordings come from. In a TOML file, `folders` and `labels_file` are relative to that file.

    source: `synthetic` (the synthetic recorder) or `folders` (data set roots listed in `folders`).
    labels_file: assigns textures to labels, for `folders`; empty for configs/labels-cluster.toml.
    labels: use only these; empty for all.
    machine_* and hand_*: how many synthetic recordings of each protocol;
    hand_guided_share: the share of hand recordings in which speed and direction are held for a while.
    accelerometer_noise: whether synthetic recordings hold the noise and the steps of their accelerometer, which a model
    would learn as part of every material.
    """

    source: str = "synthetic"
    folders: tuple[str, ...] = ()
    labels_file: str = ""
    labels: tuple[str, ...] = ()
    recordings_seed: int = 1
    machine_directions: tuple[int, ...] = (0, 45, 90, 135, 180, 225, 270, 315)
    machine_speeds_mmps: tuple[int, ...] = (20, 30, 40, 50, 60)
    machine_forces_millinewtons: tuple[int, ...] = (500, 1000)
    machine_repeats: int = 2
    hand_recordings_per_label: int = 24
    hand_duration_seconds: float = 8.0
    hand_guided_share: float = 0.0
    accelerometer_noise: bool = True


@dataclass(frozen=True)
class ModelConfig:
    """network: `skeleton` (no network: a filter, rib lines and impulses) or `refinement` (of the skeleton of another run,
    `--base`). hidden: widths of the skeleton's two perceptrons, of the filter's and of that of what drives it; or one
    width for all. width, previous_width, levels: of a refinement.
    """

    networks: ClassVar[tuple[str, ...]] = ("skeleton", "refinement")

    network: str = "skeleton"
    hidden: tuple[int, ...] = (128, 192)
    width: int = 64
    previous_width: int = 32
    levels: int = 2

    @property
    def has_filter(self) -> bool:
        """Whether an all-pole filter is trained."""
        return self.network == "skeleton"


@dataclass(frozen=True)
class OptimiserConfig:
    """AdamW with warm-up, cosine decay over each phase's second half, gradient clipping and a moving average."""

    learning_rate: float = 6e-4
    weight_decay: float = 1e-4
    batch_size: int = 96
    level_steps: int = 1500
    steps: int = 24000
    level_polish_steps: int = 2000
    warm_up_steps: int = 200
    average_decay: float = 0.999
    gradient_clip: float = 2.0


@dataclass(frozen=True)
class BatchConfig:
    """How training pairs are drawn.

    held_out_speed_mps, held_out_force_newtons, held_out_direction_degrees: [from, to]; windows with a sample in the
    band are used neither for training nor for levels, seeds and exponents; empty for none. Directions are counter-
    clockwise from the surface's first axis.
    hop_samples: the condition of a pair is the mean motion over this many leading samples of the segment, drawn from
    [min, max] (the hops of updates at 120 Hz to 30 Hz).
    silence_probability: previous waveform zeroed, as at touch-down.
    machine_share: share of pairs from machine recordings where both protocols exist.
    switch_probability: previous waveform taken from another recording, as at a change of label.
    chain_hops: how many hops a chain of the self-forcing phase renders.
    chain_silence_probability: share of chains that begin in silence.
    emphasised_labels: drawn `emphasis` times as often as other labels, because a label with a pitch is harder to learn
    than noise.
    """

    hop_samples: tuple[int, int] = (16, 66)
    silence_probability: float = 0.05
    switch_probability: float = 0.03
    machine_share: float = 0.35
    chain_hops: tuple[int, int] = (1, 8)
    chain_silence_probability: float = 0.3
    emphasised_labels: tuple[str, ...] = ()
    emphasis: float = 1.0
    held_out_speed_mps: tuple[float, ...] = ()
    held_out_force_newtons: tuple[float, ...] = ()
    held_out_direction_degrees: tuple[float, ...] = ()


@dataclass(frozen=True)
class RecipeConfig:
    """The training recipe around the fit (`optimiser.steps`: of a skeleton by its likelihood), phase after phase; a phase
    of 0 steps is left out.

    embedding_steps: first of all, fits the labels alone to a skeleton and a level that are there (`--from`).
    filter_steps: before it, fits an all-pole filter to Burg's estimates from single segments.
    energy_steps: one-step fine-tuning by a spectral energy distance; afterwards the network is a `direct` tier.
    self_forcing_steps: the objective of the phase before, on the network's own output as previous waveform.
    shares_base: keep the embedding and level model of another run (`--base`), as further tiers of a file do.
    calibrate_level: `train --export` subtracts the closed-loop level error of each label, as train-tiers does for the
    default model.
    """

    embedding_steps: int = 0
    embedding_learning_rate: float = 5e-3
    filter_steps: int = 0
    energy_steps: int = 0
    energy_batch_size: int = 48
    energy_learning_rate: float = 5e-4
    self_forcing_steps: int = 0
    self_forcing_learning_rate: float = 3e-4
    shares_base: bool = False
    calibrate_level: bool = False


@dataclass(frozen=True)
class TrainingConfig:
    """A whole run. `name` and `description` are written to the model file's header; `tier` names the trained tier
    there.

    trained_by, exported_as: the classes that train and export it (extensions.py), derived from Trainer and TrainedTier.
    """

    trained_by: ClassVar[str] = "haptoflow_training.training.trainer:Trainer"
    exported_as: ClassVar[str] = "haptoflow_training.export.trained_tier:TrainedTier"

    name: str = "default"
    tier: str = "sketch"
    description: str = ""
    licence: str = "MIT"
    seed: int = 1
    threads: int = 2
    data: DataConfig = field(default_factory=DataConfig)
    model: ModelConfig = field(default_factory=ModelConfig)
    optimiser: OptimiserConfig = field(default_factory=OptimiserConfig)
    batch: BatchConfig = field(default_factory=BatchConfig)
    recipe: RecipeConfig = field(default_factory=RecipeConfig)

    def to_dict(self) -> dict[str, Any]:
        return dataclasses.asdict(self)

    @property
    def calibrates_level(self) -> bool:
        """Whether an export of this run corrects its levels: if the configuration says so, and always for recordings
        from folders."""
        return self.recipe.calibrate_level or self.data.source == "folders"

    def rules(self) -> tuple[Rule, ...]:
        """(whether it holds, key, what is expected) of each rule for values."""
        config, optimiser = self, self.optimiser
        return (
            (config.data.source in ("synthetic", "folders"), "data.source", "'synthetic' or 'folders'"),
            (optimiser.learning_rate > 0.0, "optimiser.learning_rate", "above 0"),
            (optimiser.batch_size >= 1, "optimiser.batch_size", "at least 1"),
            (optimiser.steps >= 0, "optimiser.steps", "at least 0"),
            (0.0 <= optimiser.average_decay < 1.0, "optimiser.average_decay", "0 to below 1"),
            (
                len(config.batch.hop_samples) == 2
                and 1 <= config.batch.hop_samples[0] <= config.batch.hop_samples[1] <= 200,
                "batch.hop_samples",
                "two numbers, 1 <= min <= max <= 200",
            ),
            *(
                (len(band) in (0, 2) and tuple(sorted(band)) == band, f"batch.{name}", "empty, or [from, to]")
                for name, band in (
                    ("held_out_speed_mps", config.batch.held_out_speed_mps),
                    ("held_out_force_newtons", config.batch.held_out_force_newtons),
                    ("held_out_direction_degrees", config.batch.held_out_direction_degrees),
                )
            ),
            (
                len(config.batch.chain_hops) == 2
                and 1 <= config.batch.chain_hops[0] <= config.batch.chain_hops[1] <= 50,
                "batch.chain_hops",
                "two numbers, 1 <= min <= max <= 50",
            ),
            (config.batch.emphasis > 0.0, "batch.emphasis", "above 0"),
            (
                config.model.network in config.model.networks,
                "model.network",
                f"one of {', '.join(config.model.networks)}",
            ),
            (
                config.model.has_filter or config.recipe.filter_steps == 0,
                "recipe.filter_steps",
                "0 for a network, which has no filter",
            ),
            (config.model.network != "refinement" or config.recipe.shares_base, "recipe.shares_base", "true"),
            (
                1 <= len(config.model.hidden) <= 2
                and min(config.model.hidden) >= 8
                and sum(config.model.hidden) <= MAXIMUM_HIDDEN,
                "model.hidden",
                f"one or two widths of at least 8, {MAXIMUM_HIDDEN} in all",
            ),
            (config.model.width >= 8, "model.width", "at least 8"),
            (config.tier in TIER_NAMES, "tier", f"one of {', '.join(TIER_NAMES)}"),
        )


_Section = TypeVar("_Section")


def _convert(value: Any, default: Any, key: str, path: Path) -> Any:
    if isinstance(default, bool) or isinstance(default, str):
        expected: tuple[type, ...] = (type(default),)
    elif isinstance(default, float):
        expected = (float, int)
    else:
        expected = (list, tuple) if isinstance(default, tuple) else (type(default),)
    if not isinstance(value, expected) or (isinstance(value, bool) and not isinstance(default, bool)):
        wanted = "a list" if isinstance(default, tuple) else type(default).__name__
        raise InputError(f"{path}: key '{key}' is {value!r}, expected {wanted} (for example {default!r})")
    if isinstance(default, float):
        return float(value)
    return tuple(value) if isinstance(default, tuple) else value


def _read_section(section: type[_Section], table: dict[str, Any], prefix: str, path: Path, *, passes: bool) -> _Section:
    defaults = section()
    fields = dataclasses.fields(section)  # type: ignore[arg-type]
    known = {entry.name: getattr(defaults, entry.name) for entry in fields}
    values: dict[str, Any] = {}
    for key, value in table.items():
        name = f"{prefix}{key}"
        if key not in known and passes:
            continue
        if key not in known:
            raise InputError(
                f"{path}: unknown key '{name}'; known here: {', '.join(sorted(known))} (keys of rivals, latents and velocity "
                "fields are those of `haptoflow-paper`, which has the same command)"
            )
        default = known[key]
        if dataclasses.is_dataclass(default):
            if not isinstance(value, dict):
                raise InputError(f"{path}: '{name}' must be a table [{name}]")
            values[key] = _read_section(type(default), value, f"{name}.", path, passes=passes)
        else:
            values[key] = _convert(value, default, name, path)
    return section(**values)


def load_config(path: Path) -> TrainingConfig:
    """Read and check a run's TOML file; InputError names file, key and the expected value.

    `extends = "other.toml"` takes every key that the file does not set from that file beside it; of a list of files, a
    later one goes before an earlier one.
    """
    return config_from_dict(_read_table(path, ()), path)


def _read_table(path: Path, extended_by: tuple[Path, ...]) -> dict[str, Any]:
    if path in extended_by:
        raise InputError(f"{path}: key 'extends' leads back to the file itself; end the chain in a file without it")
    table = read_toml(path, "a run's TOML file")
    _from_the_file(table, path)
    named = table.pop("extends", [])
    parents = [named] if isinstance(named, str) else named
    if not isinstance(parents, list) or not all(isinstance(parent, str) for parent in parents):
        raise InputError(
            f"{path}: key 'extends' is {named!r}, expected the name of a TOML file beside it, or a list of such names"
        )
    merged: dict[str, Any] = {}
    for parent in parents:
        merged = _merged(merged, _read_table(path.parent / parent, (*extended_by, path)))
    return _merged(merged, table)


def _from_the_file(table: dict[str, Any], path: Path) -> None:
    """Paths of recordings and labels are relative to the file that contains them."""
    data = table.get("data")
    if not isinstance(data, dict):
        return

    def located(value: Any) -> Any:
        return str((path.parent / Path(value).expanduser()).resolve()) if isinstance(value, str) and value else value

    if isinstance(data.get("folders"), list):
        data["folders"] = [located(folder) for folder in data["folders"]]
    if "labels_file" in data:
        data["labels_file"] = located(data["labels_file"])


def _merged(below: dict[str, Any], above: dict[str, Any]) -> dict[str, Any]:
    merged = dict(below)
    for key, value in above.items():
        old = merged.get(key)
        merged[key] = _merged(old, value) if isinstance(old, dict) and isinstance(value, dict) else value
    return merged


def config_from_dict(table: dict[str, Any], path: Path, kind: type[TrainingConfig] | None = None) -> TrainingConfig:
    """The configuration in `table`, checked; `path` names its origin in messages. kind: the class to read it as
    (default: that of extensions.py)."""
    return _checked(_read_section(kind or configuration_class(), table, "", path, passes=False), path)


def config_of_run(table: dict[str, Any], path: Path, kind: type[TrainingConfig] | None = None) -> TrainingConfig:
    """As `config_from_dict`, for what a checkpoint of any version states: keys that are no longer known are passed over."""
    return _checked(_read_section(kind or configuration_class(), table, "", path, passes=True), path)


def _checked(config: TrainingConfig, path: Path) -> TrainingConfig:
    for holds, key, expected in config.rules():
        if not holds:
            raise InputError(f"{path}: key '{key}' is out of range, expected {expected}")
    return config
