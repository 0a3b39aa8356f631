"""`haptoflow-paper import-published`: the authors' published weights as a model file of the engine."""

from __future__ import annotations

import argparse
import json
import math
from pathlib import Path

from tqdm import tqdm

from haptoflow_benchmark.engine_library import default_engine
from haptoflow_paper.published.checkpoint import read_checkpoint
from haptoflow_paper.published.level_measurement import segments_to_render
from haptoflow_paper.published.published_file import LICENCES, PublishedFile
from haptoflow_training.errors import InputError
from haptoflow_training.whole_file import check_writable

_DESCRIPTION = """\
Turn the weights that the authors of the paper publish into a .haptoflow file that the engine plays: their network,
their solver, their guidance, with the codec that it works in. The first tier is the fastest; the last one, `published`,
computes what theirs does, within 1e-4 of the RMS.

FOLDER holds meta.json and one .safetensors, as the model repository tamago117/HaptoFlow has them in haptoflow_accel,
and EnCodec's 24 kHz weights (encodec_24khz-d7cc33bc.th) beside them or where --encodec says. Nothing of a file is run.

A checkpoint does not state how strong its vibrations are. That stands in the dataset_info.json of the recordings that
it was trained on (--dataset-info), or state it in g (--peak-g). Without either, the level is assumed: the median of the
materials at 40 mm/s and .75 N becomes .57 m/s^2, as measured on the data set, and the file says so where `haptoflow
inspect` shows it. Levels, exponents beyond the range and the seeds of touches are measured on the model itself, by the
engine: some minutes for the published one.
"""
_EXAMPLES = """examples:
  haptoflow-paper import-published haptoflow_accel --encodec encodec_24khz-d7cc33bc.th -o published.haptoflow
  haptoflow-paper import-published haptoflow_accel --dataset-info dataset_info.json -o published.haptoflow
  haptoflow-paper import-published Tests/Golden/published/heun --peak-g 1.5 -o work/small.haptoflow

Then: build/native/haptoflow inspect published.haptoflow
"""
_LARGEST_PEAK_G = 100.0


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.description = _DESCRIPTION
    parser.epilog = _EXAMPLES
    parser.add_argument("folder", type=Path, metavar="FOLDER", help="folder with meta.json and one .safetensors")
    parser.add_argument(
        "--encodec", type=Path, metavar="FILE", help="EnCodec's 24 kHz state dict (default: the .th in FOLDER)"
    )
    peak = parser.add_mutually_exclusive_group()
    peak.add_argument("--peak-g", type=float, metavar="G", help="peak of the recordings that 1 stands for, in g")
    peak.add_argument(
        "--dataset-info", type=Path, metavar="FILE", help="dataset_info.json of the recordings, which states the peak"
    )
    parser.add_argument("-o", "--out", required=True, type=Path, metavar="OUT.haptoflow", help="model file to write")


def run(options: argparse.Namespace) -> int:
    check_writable(options.out)
    peak_g = _peak_g(options)
    engine = default_engine(Path(__file__).resolve().parents[3])
    checkpoint = read_checkpoint(options.folder, options.encodec)
    meta = checkpoint.model.meta
    # `./run published` has already printed the licences of what it downloaded, with the addresses.
    for part, text in LICENCES if checkpoint.origin is None else ():
        print(f"{part}: {text}")
    file = PublishedFile(checkpoint)
    steps = f"{meta.steps} {meta.solver} steps, guidance {meta.guidance:g}"
    print(f"{len(meta.classes)} materials, {steps}, {', '.join(tier.name for tier in file.tiers)}")
    if file.tiers[-1].steps != meta.steps:
        print(f"published: {file.tiers[-1].steps} steps, the most that the engine takes, instead of {meta.steps}")
    with tqdm(total=segments_to_render(len(meta.classes)), desc="measuring levels", unit="segment") as progress:
        measured = file.measure(engine, progress.update)
    level = file.level(measured, peak_g)
    checksum = file.write(options.out, level, measured)
    print(f"{level.origin}: 1 stands for {level.unit_mps2:.3g} m/s^2")
    print(f"{options.out}: {options.out.stat().st_size / 1e6:.1f} MB, CRC-32 {checksum:08x}")
    return 0


def _peak_g(options: argparse.Namespace) -> float | None:
    if options.dataset_info is None:
        peak, source = options.peak_g, "--peak-g"
    else:
        peak, source = _peak_of_info(options.dataset_info), f"{options.dataset_info}: preprocessing.global_peak_value"
    if peak is not None and not (math.isfinite(peak) and 0.0 < peak <= _LARGEST_PEAK_G):
        raise InputError(f"{source} is {peak:g}; expected a peak in g, above 0 to {_LARGEST_PEAK_G:g}")
    return peak


def _peak_of_info(path: Path) -> float:
    try:
        document = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror}); expected a dataset_info.json") from error
    except (ValueError, RecursionError) as error:
        raise InputError(f"{path}: not valid JSON ({error})") from error
    preprocessing = document.get("preprocessing") if isinstance(document, dict) else None
    peak = preprocessing.get("global_peak_value") if isinstance(preprocessing, dict) else None
    if not isinstance(peak, (int, float)) or isinstance(peak, bool):
        raise InputError(
            f"{path}: key 'preprocessing.global_peak_value' is {peak!r}; expected the peak in g by which the "
            "recordings were divided (or state it with --peak-g)"
        )
    return float(peak)
