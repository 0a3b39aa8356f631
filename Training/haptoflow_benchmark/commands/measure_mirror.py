"""`haptoflow-benchmark measure-mirror`: what the faults of the real data set cost, each by itself and all together."""

from __future__ import annotations

import argparse
import dataclasses
from pathlib import Path

from tqdm import tqdm

from haptoflow_benchmark.mirror.comparison import Loss, losses_of, median_loss, mirror_rows
from haptoflow_benchmark.mirror.faults import ALL_FAULTS, MachinePass, simulated_pass
from haptoflow_training.preprocessing.pipeline import PreparedRecording, preprocess_recording
from haptoflow_training.preprocessing.settings import PreprocessingSettings
from haptoflow_training.recordings.dataset_writer import (
    TextureEntry,
    write_provenance,
    write_recording,
    write_texture_list,
)
from haptoflow_training.recordings.recording import Recording
from haptoflow_training.recordings.synthetic import Material, load_materials, machine_conditions
from haptoflow_training.recordings.synthetic.materials import select_materials
from haptoflow_training.training.run_log import source_commit, write_json
from haptoflow_training.whole_file import check_writable

_LABELS = "wood,glass,metal,corduroy"
_SPEEDS = "20,30,40,50,60"
_SOURCE = "HaptoFlow's synthetic recorder with the faults of the Cluster Haptic Texture Dataset; nothing is measured"


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.description = (
        "Records machine passes of the synthetic recorder with the faults that were measured on the files of the Cluster "
        "Haptic Texture Dataset, prepares them as training does, and compares them with the same passes without: level, "
        "log-spectral distance and goodness of fit, for each fault alone, all together, and all but the apparatus, whose "
        "resonance nothing can tell from a material's."
    )
    parser.epilog = (
        "example (some minutes of one core; one label at one speed takes seconds):\n"
        "  haptoflow-benchmark measure-mirror --out Training/results/mirror.json\n"
        "--write keeps all faults as a data set, on which `haptoflow-training train-tiers --configs "
        "Training/configs/cluster` trains."
    )
    parser.add_argument("--labels", default=_LABELS, help="separated by commas (default: %(default)s)")
    parser.add_argument("--speeds", default=_SPEEDS, help="mm/s, separated by commas (default: %(default)s)")
    parser.add_argument("--repeats", type=int, default=2, help="passes of each condition (default: 2)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--write", type=Path, metavar="FOLDER", help="write the passes with all faults as a data set")
    parser.add_argument("--out", type=Path, required=True, help="JSON")


def run(options: argparse.Namespace) -> int:
    check_writable(options.out)
    materials = select_materials(load_materials(), [label.strip() for label in options.labels.split(",")])
    labels: dict[str, dict[str, Loss]] = {}
    for material in tqdm(materials, unit="label"):
        passes = _passes(material, options)
        labels[material.label] = losses_of(passes, mirror_rows(), _prepared)
        if options.write is not None:
            for each in tqdm(passes, unit="pass", leave=False):
                write_recording(options.write, each.recorded(ALL_FAULTS))
    if options.write is not None:
        _describe(options.write, materials, options.seed)
    medians = {row: median_loss([losses[row] for losses in labels.values()]) for row in mirror_rows()}
    write_json(options.out, {
        "commit": source_commit(Path(__file__).parent), "seed": options.seed, "speeds_mmps": options.speeds,
        "repeats": options.repeats, "median": {row: dataclasses.asdict(loss) for row, loss in medians.items()},
        "labels": {label: {row: dataclasses.asdict(loss) for row, loss in rows.items()} for label, rows in labels.items()},
    })  # fmt: skip
    print("| fault | level, dB | LSD, dB | 1 - GFC | force, % | speed, % |\n|---|---|---|---|---|---|")
    for row, loss in medians.items():
        figures = f"{loss.level_db:.2f} | {loss.lsd_db:.2f} | {1.0 - loss.gfc:.4f}"
        print(f"| {row} | {figures} | {100.0 * loss.force:.1f} | {100.0 * loss.speed:.1f} |")
    return 0


def _passes(material: Material, options: argparse.Namespace) -> list[MachinePass]:
    speeds = [int(speed) for speed in options.speeds.split(",")]
    conditions = machine_conditions(material, speeds_mmps=speeds, repeats=options.repeats)
    return [simulated_pass(material, identity, seed=options.seed) for identity in conditions]


def _prepared(recording: Recording) -> PreparedRecording:
    """As files of the data set are, whose noise is removed."""
    return preprocess_recording(dataclasses.replace(recording, has_sensor_noise=True), PreprocessingSettings())


def _describe(folder: Path, materials: tuple[Material, ...], seed: int) -> None:
    entries = [TextureEntry(each.texture_id, each.label, {"Friction coefficient": each.friction}) for each in materials]
    write_texture_list(folder, entries)
    write_provenance(
        folder, source=_SOURCE, licence="the repository's own licence; no third-party data", synthetic=True,
        details={"command": "haptoflow-benchmark measure-mirror", "seed": seed},
    )  # fmt: skip
