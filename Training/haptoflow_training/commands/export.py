"""`haptoflow-training export`: write a finished run as a `.haptoflow` file without training again."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from tqdm import tqdm

from haptoflow_training.training.level_calibration import by_label, measured_levels
from haptoflow_training.export.exporter import export_run
from haptoflow_training.export.grown_model import export_grown_model
from haptoflow_training.export.level_table import MeasuredLevels
from haptoflow_training.model_stamp import SHIPPED_MODEL
from haptoflow_training.training.recordings_source import Source, open_source
from haptoflow_training.training.trainer import load_trained
from haptoflow_training.whole_file import write_json

SHIPPED = Path(__file__).resolve().parents[3] / SHIPPED_MODEL


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.description = (
        "Writes the moving average of a finished run as a model file. The run's recordings are needed again, for "
        "seeds, exponents and ranges: the store is reused where it is, made anew where it is not."
    )
    parser.epilog = "example:\n  haptoflow-training export --run out/train/default --out default.haptoflow"
    parser.add_argument("--run", dest="folder", type=Path, required=True, help="folder of the run (checkpoint.pt)")
    parser.add_argument(
        "--tier", dest="tiers", type=Path, nargs="+", default=[], metavar="FOLDER",
        help="runs trained with `--base` of this run: further tiers of the file",
    )  # fmt: skip
    parser.add_argument("--store", type=Path, help="prepared recordings (default: `store` beside the run's folder)")
    parser.add_argument(
        "--from", type=Path, dest="start", default=SHIPPED, metavar="FILE",
        help="for a run of labels alone: the model file that it began from (default: the shipped model)",
    )  # fmt: skip
    parser.add_argument("--out", type=Path, required=True, metavar="FILE", help="the model file")
    parser.add_argument("--parity", type=Path, metavar="FILE", help="also write golden vectors for the engine's tests")
    parser.add_argument("--workers", type=int, default=2, help="processes that prepare recordings (default: 2)")


def write_model(
    folder: Path,
    source: Source,
    out: Path,
    parity: Path | None,
    levels: MeasuredLevels,
    further_tiers: Sequence[Path] = (),
    record: Path | None = None,
) -> None:
    """Write the model file of the run in `folder`, and print its name and checksum. record: a JSON file that keeps
    them, with the measured levels."""
    checksum = export_run(folder, source, out, parity, further_tiers, levels)
    _tell(out, checksum, record, by_label(levels, source))


def write_grown_model(folder: Path, source: Source, start: Path, out: Path, record: Path | None = None) -> None:
    """Write the labels of the run in `folder` into a copy of the model file `start`, and print its name and checksum.
    record: as of `write_model`."""
    with tqdm(total=len(source.labels), unit="label", desc="level and tone", disable=None) as bar:
        checksum = export_grown_model(folder, source, start, out, bar.update)
    _tell(out, checksum, record, {})


def _tell(out: Path, checksum: int, record: Path | None, levels: dict[str, Any]) -> None:
    if record is not None:
        write_json(record, {"file": out.name, "crc32": f"{checksum:08x}", **levels})
    print(f"{out}: {out.stat().st_size / 2**20:.2f} MiB, CRC-32 {checksum:08x}")


def run(options: argparse.Namespace) -> int:
    config, _, _ = load_trained(options.folder)
    source = open_source(config.data, options.store or options.folder.parent / "store", options.workers)
    if config.recipe.embedding_steps:
        write_grown_model(options.folder, source, options.start, options.out)
        return 0
    levels = measured_levels(options.folder, source) if config.calibrates_level else MeasuredLevels()
    write_model(options.folder, source, options.out, options.parity, levels, options.tiers)
    return 0
