"""`haptoflow-training train`: train on recordings, write the run and, on request, its model file."""

from __future__ import annotations

import argparse
import copy
import dataclasses
import math
import sys
import time
from dataclasses import dataclass
from pathlib import Path

from haptoflow_training.commands.export import SHIPPED, write_grown_model, write_model
from haptoflow_training.errors import InputError
from haptoflow_training.export.level_table import MeasuredLevels
from haptoflow_training.export.trained_tier import TrainedTier, tier_of
from haptoflow_training.models.haptoflow_model import HaptoFlowModel
from haptoflow_training.stopping import Stopped, end_if_stopped
from haptoflow_training.training.config import TrainingConfig, load_config
from haptoflow_training.training.level_calibration import Extent, measured_levels, seconds_of_a_measurement
from haptoflow_training.training.processes import join_processes
from haptoflow_training.training.recordings_source import Source, open_source
from haptoflow_training.training.trainer import TimeLimit, TrainingStopped, trainer_of

MINIMUM_MINUTES = 0.1
# Levels are measured once without level tables and at most twice with them.
_ROUNDS = 3.0
_MAXIMUM_SHARE_AFTER = 0.25
_MINIMUM_SHARE_OF_TRAINING = 0.3
_LONGEST_COMPARED_SAMPLES = 16000
_MINIMUM_RECORDINGS = 2
# Of a whole model's training, with one round of networks.
_BASE_SHARE, _NETWORK_SHARE, _LEVELS_SHARE = 0.35, 0.57, 0.08
# What the library takes for level and tone of one label.
_SECONDS_OF_A_LABELS_FIT = 2.0


def share_out(
    minutes: float, begun: float, config: TrainingConfig, source: Source, untrained: HaptoFlowModel, *, exports: bool
) -> tuple[TimeLimit, Extent]:
    """Share out the minutes: the time limit of training, and how much is compared when levels are measured afterwards.
    What measuring levels and writing graphs takes is timed on the untrained network, because training does not change
    it.

    begun: time.monotonic() when the command began. Training gets at least three tenths of the minutes, even if
    preparing the recordings took most of them.
    """
    whole = 60.0 * minutes
    extent = Extent(longest_samples=_LONGEST_COMPARED_SAMPLES)
    after = 0.0
    if exports and config.recipe.embedding_steps:
        after = _SECONDS_OF_A_LABELS_FIT * len(source.labels)
    elif exports:
        model = copy.deepcopy(untrained).eval().requires_grad_(False)
        tier = tier_of(config, list(source.store.labels), model)
        started = time.monotonic()
        tier.graphs()
        after = 1.5 * (time.monotonic() - started) + 1.0
        if config.calibrates_level:
            extent, seconds = affordable_extent(tier, source, _MAXIMUM_SHARE_AFTER * whole - after)
            after += seconds
    training = whole - (time.monotonic() - begun) - after
    return TimeLimit(max(training, _MINIMUM_SHARE_OF_TRAINING * whole), after), extent


def affordable_extent(tier: TrainedTier, source: Source, seconds: float) -> tuple[Extent, float]:
    """How much can be compared within so many seconds, two recordings of each label at least; and how long it takes."""
    one = Extent(_MINIMUM_RECORDINGS, _LONGEST_COMPARED_SAMPLES)
    each = _ROUNDS * seconds_of_a_measurement(tier, source, one) / one.recordings_per_label
    count = min(Extent().recordings_per_label, max(_MINIMUM_RECORDINGS, int(max(0.0, seconds) / max(each, 1e-6))))
    return Extent(count, _LONGEST_COMPARED_SAMPLES), each * count


@dataclass(frozen=True)
class TiersMinutes:
    """Seconds of a wall clock: of the base, of each network, and of the level measurement at the end."""

    base: float
    network: float
    levels: float

    @classmethod
    def of(cls, minutes: float, begun: float, networks: int, lanes: int) -> TiersMinutes:
        """Share out what is left of the minutes, as the shipped model's training does. At least three tenths of them,
        even if preparing the recordings took most."""
        whole = 60.0 * minutes
        left = max(whole - (time.monotonic() - begun), _MINIMUM_SHARE_OF_TRAINING * whole)
        rounds = -(-networks // max(1, lanes))
        unit = left / (_BASE_SHARE + rounds * _NETWORK_SHARE + _LEVELS_SHARE)
        return cls(_BASE_SHARE * unit, _NETWORK_SHARE * unit, _LEVELS_SHARE * unit)


OWN_CONFIGURATION = Path(__file__).resolve().parents[2] / "configs" / "own.toml"


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.description = (
        "Prepares the recordings (once), trains what the configuration names, and writes checkpoint.pt, metrics.csv, "
        "metrics.png and run.json into --out. Without --config, recordings of your own become further labels of the "
        "shipped model, whose networks stay as they are. Run it again to resume "
        "after an interruption (the exit code is then not 0): the result is the same. "
        "Paths are relative to the current folder; those in a "
        "configuration file are relative to that file."
    )
    parser.epilog = (
        "examples:\n"
        "  haptoflow-training train --recordings recordings --labels labels.toml --out out/own --export own.haptoflow\n"
        "  haptoflow-training train --config Training/configs/default/base.toml --out out/train/base\n"
        "  torchrun --redirects 1 --tee 1 --nproc_per_node 2 -m haptoflow_training train --config … --out …\n"
        "`haptoflow-training train-tiers` trains a whole model as the shipped one, on recordings of any origin."
    )
    parser.add_argument(
        "--config",
        type=Path,
        default=OWN_CONFIGURATION,
        help="the run's TOML file, for example Training/configs/default/base.toml (default: Training/configs/own.toml)",
    )
    parser.add_argument(
        "--out", type=Path, required=True,
        help="folder of the run; created if absent, otherwise the run in it is resumed",
    )  # fmt: skip
    parser.add_argument(
        "--store", type=Path, help="folder of the prepared recordings (default: `store` beside the run's folder)"
    )
    add_recordings_options(parser)
    add_minutes_option(parser)
    parser.add_argument("--seed", type=int, help="in place of the configuration's seed")
    parser.add_argument(
        "--base", type=Path, metavar="FOLDER",
        help="finished run whose embedding, level and skeleton a further tier keeps",
    )  # fmt: skip
    parser.add_argument(
        "--from", type=Path, dest="start", metavar="PATH",
        help="what to begin from: a finished run of the same labels and [model], for a further round; or a model file with "
        "a skeleton, whose labels yours join (for recordings of your own: the shipped model)",
    )  # fmt: skip
    parser.add_argument("--export", type=Path, metavar="FILE", help="write the .haptoflow model file here at the end")
    parser.add_argument("--parity", type=Path, metavar="FILE", help="write golden vectors of the exported model here")
    parser.add_argument("--workers", type=int, default=2, help="processes that prepare recordings (default: 2)")


def add_minutes_option(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--minutes", type=_minutes, metavar="N",
        help="end with a whole, exported model after about N minutes: preparing, training and measuring levels share them",
    )  # fmt: skip


def _minutes(text: str) -> float:
    try:
        minutes = float(text)
    except ValueError:
        minutes = math.nan
    if not MINIMUM_MINUTES <= minutes <= 1e5:
        raise argparse.ArgumentTypeError(f"'{text}'; expected minutes, {MINIMUM_MINUTES} at least")
    return minutes


def add_recordings_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--recordings", type=Path, nargs="+", metavar="PATH",
        help="folders of recordings, or files, in place of the configuration's",
    )  # fmt: skip
    parser.add_argument(
        "--labels", type=Path, metavar="FILE",
        help="TOML file of labels and their textures (as configs/labels-cluster.toml)",
    )  # fmt: skip


def with_recordings(config: TrainingConfig, options: argparse.Namespace) -> TrainingConfig:
    """The configuration with the command line's --recordings and --labels applied."""
    data = config.data
    if options.recordings:
        folders = tuple(str(folder.resolve()) for folder in options.recordings)
        data = dataclasses.replace(data, source="folders", folders=folders)
    if options.labels:
        data = dataclasses.replace(data, labels_file=str(options.labels.resolve()))
    return dataclasses.replace(config, data=data)


def configuration(options: argparse.Namespace) -> TrainingConfig:
    """The configuration file, with the command line's --recordings, --labels and --seed applied."""
    config = with_recordings(load_config(options.config), options)
    if options.seed is not None:
        config = dataclasses.replace(config, seed=options.seed)
    return config


def _emphasising_what_is_there(config: TrainingConfig, source: Source) -> TrainingConfig:
    """Of recordings from folders, the labels are whatever the user has; the recipe emphasises those that it knows."""
    if config.data.source == "synthetic":
        return config
    there = {info.name for info in source.labels}
    known = tuple(name for name in config.batch.emphasised_labels if name in there)
    return dataclasses.replace(config, batch=dataclasses.replace(config.batch, emphasised_labels=known))


def report_left_out(source: Source) -> None:
    """Print which recordings are not used for training, and why."""
    for skipped in source.store.skipped:
        print(f"skipped: {skipped}", file=sys.stderr)
    for line in dict.fromkeys((*source.left_out, *source.store.notes)):
        print(line, file=sys.stderr)
    for info in source.labels:
        if (degrees := source.turned_degrees.get(info.name)) is not None:
            vectors = ", ".join(f"({x:g}, {y:g})" for x, y in info.wave_vectors_per_mm)
            print(
                f"{info.name}: ribs found, wave vectors {vectors} per mm; its first axis lies across them, {degrees:.0f} "
                "degrees from the recordings' first axis: turn surfaces accordingly, or state the vectors in the labels file",
                file=sys.stderr,
            )


def run(options: argparse.Namespace) -> int:
    try:
        return _run(options)
    except TrainingStopped:
        raise
    except Stopped as stop:
        words = f"{stop}, no model is written yet; run the same command again to go on"
        raise Stopped(stop.number, words) from None


def _run(options: argparse.Namespace) -> int:
    begun = time.monotonic()
    config = configuration(options)
    start = options.start
    if start is None and config.recipe.embedding_steps:
        start = SHIPPED
    trainer_class = trainer_of(config)
    store_folder = options.store or options.out.parent / "store"
    with join_processes() as processes:
        trainer_class.check_start(config, processes, options.base)
        if options.minutes is not None and processes.count > 1:
            raise InputError("--minutes works with one process only; leave it out under torchrun")
        if processes.is_first:
            report_left_out(open_source(config.data, store_folder, options.workers))
        processes.wait()
        source = open_source(config.data, store_folder, options.workers)
        config = _emphasising_what_is_there(config, source)
        trainer = trainer_class(config, source.store, options.out, processes, options.base, source.wave_vectors, start)
        extent = Extent()
        if options.minutes is not None:
            limit, extent = share_out(
                options.minutes, begun, config, source, trainer.averaged_model, exports=options.export is not None
            )
            trainer.limit_time(limit)
        trainer.run()
        if processes.is_first and options.export is not None and config.recipe.embedding_steps:
            write_grown_model(options.out, source, start, options.export, options.out / "export.json")
        elif processes.is_first and options.export is not None:
            measured = measured_levels(options.out, source, extent) if config.calibrates_level else MeasuredLevels()
            end_if_stopped()
            write_model(
                options.out, source, options.export, options.parity, measured, record=options.out / "export.json"
            )
    return 0
