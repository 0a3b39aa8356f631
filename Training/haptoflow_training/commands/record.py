"""`record`: write synthetic recordings in the published data set's layout; resumable, each seeded by its identity."""

from __future__ import annotations

import argparse
import os
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

from tqdm import tqdm

from haptoflow_training.errors import InputError
from haptoflow_training.recordings.dataset_layout import (
    SENSOR_FOLDER, TextureEntry, write_provenance, write_recording, write_texture_list
)
from haptoflow_training.recordings.recording import RecordingIdentity
from haptoflow_training.recordings.synthetic import (
    TRAINING_SPECIMENS, Material, hand_conditions, load_materials, machine_conditions, record_condition_of
)
from haptoflow_training.recordings.synthetic.materials import select_materials

_SENSOR_KINDS = ("accel", "force", "position")
_SOURCE = "HaptoFlow's synthetic recorder: simulated surfaces and sensors, nothing measured on real materials"
_LICENCE = "the repository's own licence; no third-party data"


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.description = "Simulate a stylus on the materials of configs/materials.toml and its sensors."
    parser.epilog = (
        "example: haptoflow-training record --protocol hand --out recordings --labels wood,stone "
        "--recordings-per-label 20. Complete recordings already in the folder are kept."
    )
    parser.formatter_class = argparse.HelpFormatter
    parser.add_argument("--protocol", choices=("machine", "hand", "both"), default="both")
    parser.add_argument("--out", type=Path, required=True, help="data set folder to write or to complete")
    parser.add_argument("--labels", help="labels separated by commas (default: all)")
    parser.add_argument("--materials", type=Path, help="another materials.toml")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--repeats", type=int, default=2, help="machine passes of each condition (default 2)")
    parser.add_argument("--recordings-per-label", type=int, default=40, help="hand recordings (default 40)")
    parser.add_argument("--duration-seconds", type=float, default=8.0, help="of a hand recording (default 8)")
    parser.add_argument("--jobs", type=int, default=2, help="processes (default 2)")


def run(options: argparse.Namespace) -> int:
    _require_usable(options)
    materials = load_materials(options.materials)
    labels = None if options.labels is None else [label.strip() for label in options.labels.split(",")]
    chosen = select_materials(materials, labels)
    wanted = list(_wanted(chosen, options))
    missing = [task for task in wanted if not _complete(options.out, task[1])]
    write_texture_list(
        options.out,
        [TextureEntry(each.texture_id, each.label, {"Friction coefficient": each.friction}) for each in materials],
    )
    write_provenance(
        options.out,
        source=_SOURCE,
        licence=_LICENCE,
        synthetic=True,
        details={
            "command": "haptoflow-training record",
            "seed": options.seed,
            "protocol": options.protocol,
            "labels": [each.label for each in chosen],
            "recordings": len(wanted),
            "hand_duration_seconds": options.duration_seconds,
            "specimens": list(TRAINING_SPECIMENS),
        },
    )
    if len(missing) < len(wanted):
        print(f"{len(wanted) - len(missing)} of {len(wanted)} recordings are there already")
    with ProcessPoolExecutor(options.jobs) as processes:
        tasks = [(options.out, options.seed, options.duration_seconds, *task) for task in missing]
        done = processes.map(_record, tasks)
        for _ in tqdm(done, total=len(missing), unit="recording", disable=None):
            pass
    print(f"{len(wanted)} recordings of {len(chosen)} labels in {options.out}")
    return 0


def _require_usable(options: argparse.Namespace) -> None:
    for name, value, least in (
        ("--seed", options.seed, 0),
        ("--repeats", options.repeats, 1),
        ("--recordings-per-label", options.recordings_per_label, 1),
        ("--duration-seconds", options.duration_seconds, 2.0),
        ("--jobs", options.jobs, 1),
    ):
        if not value >= least:
            raise InputError(f"{name} is {value}; expected {least} or more")


def _wanted(
    materials: tuple[Material, ...], options: argparse.Namespace
) -> Iterator[tuple[Material, RecordingIdentity]]:
    for material in materials:
        if options.protocol in ("machine", "both"):
            for identity in machine_conditions(material, repeats=options.repeats):
                yield material, identity
        if options.protocol in ("hand", "both"):
            count = options.recordings_per_label
            for identity in hand_conditions(material, seed=options.seed, recordings=count):
                yield material, identity


def _complete(root: Path, identity: RecordingIdentity) -> bool:
    return all((root / SENSOR_FOLDER / kind / f"{identity.name}.csv").is_file() for kind in _SENSOR_KINDS)


def _record(task: tuple[Path, int, float, Material, RecordingIdentity]) -> None:
    # One process a core: numeric libraries that start threads of their own would only compete.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    root, seed, duration_seconds, material, identity = task
    write_recording(root, record_condition_of(material, identity, seed=seed, duration_seconds=duration_seconds))
