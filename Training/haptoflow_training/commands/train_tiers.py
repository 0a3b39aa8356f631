"""haptoflow-training train-tiers: train a whole model file, several tiers over one embedding and level model."""

from __future__ import annotations

import argparse
import os
import time
from pathlib import Path

from tqdm import tqdm

from haptoflow_training.training.level_calibration import Extent, measured_levels
from haptoflow_training.commands.export import write_model
from haptoflow_training.commands.train import (
    MINIMUM_MINUTES, TiersMinutes, add_minutes_option, add_recordings_options, affordable_extent, report_left_out,
    with_recordings
)
from haptoflow_training.errors import InputError
from haptoflow_training.export.trained_tier import load_tiers
from haptoflow_training.training.config import load_config
from haptoflow_training.training.processes import Job, run_jobs
from haptoflow_training.training.recordings_source import open_source
from haptoflow_training.training.run_log import last_step
from haptoflow_training.training.trainer import planned_steps

CONFIGURATIONS = Path(__file__).resolve().parents[2] / "configs" / "default"


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.description = (
        "Trains what the tiers share (embedding, level model and, if base.toml says so, the skeleton, which is a tier "
        "of its own), then the networks, --lanes of them at a time, each on one core, corrects the level error of the "
        "default tier for each label, and writes one model file. Run it again to resume after an interruption."
    )
    parser.epilog = (
        "example:\n"
        "  haptoflow-training train-tiers --out out/train/default --export default.haptoflow\n"
        "  haptoflow-training train-tiers --configs Training/configs/cluster --recordings ~/cluster-haptic-texture \\\n"
        "    --out out/train/cluster --export cluster.haptoflow\n"
        "Each tier's log and curves lie in its folder below --out."
    )
    parser.add_argument(
        "--configs", type=Path, default=CONFIGURATIONS, metavar="DIR",
        help="folder with base.toml and one TOML file for each tier (default: %(default)s)",
    )  # fmt: skip
    parser.add_argument(
        "--out", type=Path, required=True, help="folder of the runs; created if absent, otherwise its runs are resumed"
    )
    add_recordings_options(parser)
    add_minutes_option(parser)
    parser.add_argument("--lanes", type=int, default=os.cpu_count() or 1, help="trainings at a time (default: cores)")
    parser.add_argument("--workers", type=int, default=2, help="processes that prepare recordings (default: 2)")
    parser.add_argument("--export", type=Path, metavar="FILE", help="write the .haptoflow model file here at the end")
    parser.add_argument("--parity", type=Path, metavar="FILE", help="write golden vectors of the exported model here")


def run(options: argparse.Namespace) -> int:
    begun = time.monotonic()
    base_file = options.configs / "base.toml"
    config = with_recordings(load_config(base_file), options)
    tier_files = sorted(path for path in options.configs.glob("*.toml") if path != base_file)
    if not tier_files:
        raise InputError(f"{options.configs}: no tier beside base.toml; write one that extends it")
    store = options.out / "store"
    source = open_source(config.data, store, options.workers)
    if config.data.source == "folders":
        report_left_out(source)
    minutes = None
    if options.minutes is not None:
        minutes = TiersMinutes.of(options.minutes, begun, len(tier_files), options.lanes)
    base = options.out / "base"
    given = ["--recordings", *map(str, options.recordings)] if options.recordings else []
    given += ["--labels", str(options.labels)] if options.labels else []
    _train_all([base_file], options.out, 1, given, minutes.base if minutes else None)
    # The longest training first, so that the short ones fill the lane beside it.
    tier_files.sort(key=lambda path: -sum(planned_steps(load_config(path))) * load_config(path).model.width)
    more = ["--base", str(base), *given]
    _train_all(tier_files, options.out, options.lanes, more, minutes.network if minutes else None)
    if options.export is None:
        return 0
    folders = [options.out / path.stem for path in tier_files]
    default = options.out / "standard" if options.out / "standard" in folders else folders[0]
    extent = Extent()
    if minutes is not None:
        extent, _ = affordable_extent(load_tiers([default])[0], source, minutes.levels)
    levels = measured_levels(default, source, extent)
    further = [folder for folder in folders if folder != default]
    if config.model.network == "skeleton":
        further.append(base)
    write_model(default, source, options.export, options.parity, levels, further, options.out / "export.json")
    return 0


def _train_all(files: list[Path], out: Path, lanes: int, more: list[str], seconds: float | None) -> None:
    """Train each file in a process of its own, `lanes` at a time; seconds: of each, None for all its steps. InputError
    names the log of a training that failed."""
    begun = time.monotonic()
    total = sum(sum(planned_steps(load_config(path))) for path in files)
    if seconds is not None:
        more = [*more, "--minutes", f"{max(seconds / 60.0, MINIMUM_MINUTES):.3f}"]
        total = round(seconds * -(-len(files) // lanes))
    names = ", ".join(path.stem for path in files)
    with tqdm(total=total, unit="step" if seconds is None else "s", desc=names) as bar:

        def show_progress(finished: int) -> None:
            trained = sum(last_step(out / path.stem / "metrics.csv") for path in files)
            bar.n = trained if seconds is None else min(total, round(time.monotonic() - begun))
            bar.refresh()

        run_jobs([_job(path, out, more) for path in files], lanes, show_progress)


def _job(path: Path, out: Path, more: list[str]) -> Job:
    folder = out / path.stem
    words = ["train", "--config", str(path), "--out", str(folder), "--store", str(out / "store"), *more]
    return Job(str(path), words, folder / "train.log", folder / "run.json")
