"""`haptoflow-paper train-codec`: train the small codec for latent tiers."""

from __future__ import annotations

import argparse
import dataclasses
from pathlib import Path

from haptoflow_paper.codec.small_codec import read_small_codec_config
from haptoflow_paper.codec.trainer import RESULT_NAME, train_small_codec
from haptoflow_training.preprocessing.store import SegmentStore


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.description = "Trains the small codec on prepared recordings; run it again to go on after an interruption."
    parser.epilog = (
        "example:\n"
        "  haptoflow-paper train-codec --config Training/haptoflow_paper/configs/codec-small.toml \\\n"
        "    --store out/train/default/store"
    )
    parser.add_argument("--config", type=Path, required=True, help="the codec's TOML file")
    parser.add_argument("--store", type=Path, required=True, help="prepared recordings (`haptoflow-training prepare`)")
    parser.add_argument("--out", type=Path, help="in place of the configuration's output_folder")


def run(options: argparse.Namespace) -> int:
    config = read_small_codec_config(options.config)
    if options.out is not None:
        config = dataclasses.replace(config, output_folder=options.out)
    train_small_codec(SegmentStore.open(options.store), config)
    print(config.output_folder / RESULT_NAME)
    return 0
