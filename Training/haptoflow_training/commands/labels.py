"""`haptoflow-training labels`: write a labels file for textures of the published data set."""

from __future__ import annotations

import argparse
from pathlib import Path

from haptoflow_training.recordings.cluster_dataset import as_toml, labels_of_textures, read_texture_list
from haptoflow_training.recordings.labels import load_labels
from haptoflow_training.whole_file import write_whole

_DESCRIPTION = """\
Write a labels file for textures of the Cluster Haptic Texture Dataset, by their ids (0 to 117). A texture that
Training/configs/labels-cluster.toml names keeps that label; any other is called as the data set calls it, with
stiffness and friction of the first label of its category: look at them before you train. Prints each texture's id and label.

DIR is the folder of the data set; only its texture_list.xlsx is read."""

_EXAMPLES = """\
example:
  haptoflow-training labels cluster-haptic-texture --textures 0,38,49 --out labels.toml"""


def add_options(parser: argparse.ArgumentParser) -> None:
    parser.description = _DESCRIPTION
    parser.epilog = _EXAMPLES
    parser.add_argument("folder", metavar="DIR", type=Path, help="folder of the data set, with texture_list.xlsx")
    parser.add_argument(
        "--textures", metavar="IDS", type=_ids, default=(),
        help="ids with commas between them (default: the textures that labels-cluster.toml names)",
    )  # fmt: skip
    parser.add_argument("--out", metavar="FILE", type=Path, required=True, help="the labels file, in TOML")


def _ids(text: str) -> tuple[int, ...]:
    words = [word.strip() for word in text.split(",")]
    if not all(word.isdecimal() for word in words):
        raise argparse.ArgumentTypeError(f"'{text}'; expected ids with commas between them, as 0,38,49")
    return tuple(int(word) for word in words)


def run(options: argparse.Namespace) -> int:
    labels = labels_of_textures(load_labels(), read_texture_list(options.folder), options.textures)
    write_whole(options.out, as_toml(labels).encode())
    for definition in labels.definitions:
        print(f"{definition.textures[0]}\t{definition.name}")
    return 0
