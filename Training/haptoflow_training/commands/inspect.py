"""`haptoflow-training inspect`: report the contents and the problems of a data set folder."""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from tqdm import tqdm

from haptoflow_training.errors import InputError
from haptoflow_training.recordings.dataset_inspection import inspect_dataset
from haptoflow_training.recordings.labels import load_labels
from haptoflow_training.recordings.open_recordings import open_recordings

_DESCRIPTION = """\
Read every recording of a data set folder once and report what it holds: recordings by material, speed,
direction, force, repeat and protocol; the sample rates found, from the time stamps; durations; coverage of
the grid; and every missing or broken file with what was expected of it.

DIR is a folder of recordings of your own, CSV, Parquet or WAV with their sidecars (or one such file), or the
folder that holds sensor_data/, in the file release's layout (sensor_data/accel/0_135_40_500_0.csv), the hub
release's (sensor_data/accel/0/0_135_40_500_0.parquet), or written by `record`."""

_EXAMPLES = """\
examples:
  haptoflow-training inspect cluster-haptic-texture
  haptoflow-training inspect cluster-haptic-texture --labels configs/labels-cluster.toml
  haptoflow-training inspect recordings --json > report.json

exit codes: 0 read (problems, if any, are listed), 2 wrong usage, 3 nothing could be read"""


# Chance differences between the axes of a few dozen passes are smaller.
_LEAST_APPARATUS_DB = 2.0


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.description = _DESCRIPTION
    parser.epilog = _EXAMPLES
    parser.add_argument("folder", metavar="DIR", type=Path, help="a folder of recordings, or one file")
    parser.add_argument(
        "--labels", metavar="FILE", type=Path, help="count by the labels of this TOML file, not by texture"
    )
    parser.add_argument("--json", action="store_true", help="print the report as JSON")


def run(options: argparse.Namespace) -> int:
    labels = load_labels(options.labels) if options.labels else None
    dataset = open_recordings(options.folder, labels)
    bar = tqdm(dataset.recordings, unit=" recordings", desc="inspect", disable=None)
    report = inspect_dataset(dataset, bar)
    problems = ["{file}: {found}; expected {expected}".format(**problem) for problem in report["problems"]]
    if options.json:
        print(json.dumps(report, indent=1))
    else:
        print("\n".join(_lines(report, problems)))
    if report["recordings"]:
        return 0
    if dataset.unlabelled and not dataset.recordings:
        count = len(dataset.unlabelled)
        raise InputError(f"{dataset.root}: none of {count} recordings has a label; name their textures in --labels")
    first = f"; the first problem: {problems[0]}" if problems else ""
    raise InputError(f"{dataset.root}: no recording could be read{first}")


def _lines(report: dict[str, Any], problems: list[str]) -> Iterator[str]:
    durations = report["duration_seconds"]
    yield f"{report['root']}: {report['recordings']} recordings, {durations['total'] / 60:.1f} minutes"
    yield f"  source        {report['provenance'].get('source')} ({report['provenance'].get('licence')})"
    yield (
        f"  duration      {durations['shortest']:.2f} to {durations['longest']:.2f} s, "
        f"median {durations['median']:.2f} s"
    )
    for sensor, clock in report["clocks"].items():
        yield f"  {sensor:<14}{clock['rate_hz']:.1f} Hz, irregularity {100 * clock['irregularity']:.0f} %"
    for quantity, found in report["ranges"].items():
        yield (
            f"  {quantity:<14}{found['low']:.3g} to {found['high']:.3g} {found['unit']}, "
            f"median {found['middle']:.3g} {found['unit']}"
        )
    yield from _noise_lines(report["sensor_noise"])
    yield from _apparatus_lines(report["apparatus"])
    yield f"  audio         {report['audio_files']} files (not used)"
    if report["unlabelled"]:
        yield f"  unlabelled    {report['unlabelled']} recordings that no label names"
    for axis, counts in report["counts"].items():
        if axis != "material" and counts:
            yield f"  {axis:<20}" + ", ".join(f"{value}: {count}" for value, count in counts.items())
    yield from _coverage_table(report["coverage"])
    yield from (f"  note: {note}" for note in report["notes"])
    if problems:
        yield f"{len(problems)} problems:"
        yield from (f"  {problem}" for problem in problems)


def _noise_lines(noise: dict[str, Any]) -> Iterator[str]:
    if not noise["from"]:
        return
    where = ", ".join(f"{count} from {source}" for source, count in noise["from"].items() if source != "none")
    nowhere = noise["from"].get("none", 0)
    if noise["mps2"]:
        low, middle, high = noise["mps2"]
        yield f"  sensor noise  {low:.2g} to {high:.2g} m/s^2 RMS, median {middle:.2g}; removed ({where})"
    if nowhere:
        yield f"  sensor noise  none found in {nowhere} recordings"


def _apparatus_lines(apparatus: dict[str, Any]) -> Iterator[str]:
    decibels = apparatus["x_over_y_db"]
    if decibels is None or abs(decibels) < _LEAST_APPARATUS_DB:
        return
    low, high = apparatus["band_hz"]
    axes = "X over Y" if decibels > 0.0 else "Y over X"
    yield (
        f"  apparatus     {axes} by {abs(decibels):.1f} dB at {low:.0f}-{high:.0f} Hz, over passes in all directions alike: "
        "this is no material's, and stays in the recordings"
    )


def _coverage_table(rows: list[dict[str, object]]) -> Iterator[str]:
    if not rows:
        return
    width = max(len("material"), *(len(str(row["material"])) for row in rows))
    yield f"  {'material':<{width}}  {'machine':>7}  {'of grid':>7}  {'hand':>5}"
    for row in rows:
        yield f"  {row['material']:<{width}}  {row['machine']:>7}  {row['machine_grid']:>7}  {row['hand']:>5}"
