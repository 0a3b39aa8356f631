"""A published checkpoint in a folder: `meta.json`, one .safetensors, and EnCodec's state dict."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import torch
from torch import Tensor

from haptoflow_paper.codec.checkpoint_file import load_state
from haptoflow_paper.codec.encodec import EnCodec, read_published_state
from haptoflow_paper.published.meta_file import META_FILE, PublishedMeta, read_meta
from haptoflow_paper.published.network import NetworkSizes, PublishedNetwork, ResidualQuantiser, codebooks_of
from haptoflow_paper.published.published_model import PublishedModel
from haptoflow_paper.published.safetensors_file import read_safetensors
from haptoflow_training.errors import InputError

_CODEBOOK = re.compile(r"quantizer\.vq\.layers\.(\d+)\._codebook\.(\w+)")
# What a codebook's training leaves behind beside the code vectors.
_CODEBOOK_PARTS = {"embed", "embed_avg", "cluster_size", "inited"}
_BACKBONE = "model.backbone."
# Saved by some versions: the U-Net once more.
_ALIAS = "unet."
# Written beside the files by `./run published`.
_ORIGIN_FILE = "origin.json"


@dataclass(frozen=True)
class Checkpoint:
    """model: ready to run. weights, codec: the files that were read. origin: of a download, as
    hf://OWNER/REPO/FOLDER@COMMIT."""

    model: PublishedModel
    weights: Path
    codec: Path
    origin: str | None = None


def read_checkpoint(folder: Path, codec: Path | None = None) -> Checkpoint:
    """Read and check all three files; codec: EnCodec's state dict, by default the one .th file of the folder.

    Raises InputError naming the file, what does not fit and what was expected.
    """
    if not folder.is_dir():
        raise InputError(f"{folder}: no such folder; expected one with {META_FILE} and a .safetensors file")
    meta = read_meta(folder / META_FILE)
    weights = _only_file(folder, "*.safetensors", "the weights")
    codec = codec or _only_file(folder, "*.th", "EnCodec's 24 kHz state dict (or name it with --encodec)")
    tensors = read_safetensors(weights)
    tensors = {name: value for name, value in tensors.items() if not name.startswith(_ALIAS)}
    sizes = _sizes(weights, tensors, meta)
    network = PublishedNetwork(sizes)
    load_state(network, tensors, weights)
    encodec, quantiser = _read_codec(codec, sizes, meta)
    model = PublishedModel(meta, sizes, network, encodec, quantiser)
    return Checkpoint(model, weights, codec, _origin(folder / _ORIGIN_FILE))


def _origin(path: Path) -> str | None:
    if not path.exists():
        return None
    try:
        origin = json.loads(path.read_text(encoding="utf-8"))["origin"]
    except (OSError, ValueError, KeyError, TypeError, RecursionError) as error:
        raise InputError(
            f"{path}: expected the note of a download, with the key 'origin'; delete it to do without"
        ) from error
    return str(origin)


def _only_file(folder: Path, pattern: str, what: str) -> Path:
    found = sorted(folder.glob(pattern))
    if len(found) != 1:
        names = ", ".join(path.name for path in found) or "none"
        raise InputError(f"{folder}: {pattern}: {names}; expected one file, {what}")
    return found[0]


def _sizes(path: Path, tensors: Mapping[str, Tensor], meta: PublishedMeta) -> NetworkSizes:
    def dimension(name: str, axis: int, rank: int) -> int:
        if name not in tensors:
            raise InputError(f"{path}: the tensor '{name}' is missing; expected the weights that {META_FILE} describes")
        shape = list(tensors[name].shape)
        if len(shape) != rank or 0 in shape:
            raise InputError(f"{path}: the tensor '{name}' has the shape {shape}; expected {rank} dimensions above 0")
        return shape[axis]

    levels = len({name for name in tensors if re.fullmatch(rf"{re.escape(_BACKBONE)}downs\.\d+\.pool\.weight", name)})
    channels = tuple(dimension(f"{_BACKBONE}downs.{level}.block.conv1.weight", 0, 3) for level in range(max(1, levels)))
    label = dimension("label_embed.emb.weight", 1, 2)
    control = dimension("control_embedding.net.2.weight", 0, 2)
    condition = dimension(f"{_BACKBONE}mid.cond1.to_scale_shift.weight", 1, 2)
    time = condition - label - control
    if time < 2 or time % 2:
        raise InputError(
            f"{path}: a condition of {condition} numbers with {label} of the label and {control} of the control leaves "
            f"{time} for the time; expected an even number"
        )
    classes = dimension("label_embed.emb.weight", 0, 2)
    if classes != len(meta.classes):
        raise InputError(f"{path}: {classes} rows in label_embed.emb.weight; expected {len(meta.classes)}, one a class")
    return NetworkSizes(
        classes=classes,
        latent=dimension(f"{_BACKBONE}in_conv.weight", 1, 3),
        channels=channels,
        label=label,
        control=control,
        hidden=dimension("control_embedding.net.0.weight", 0, 2),
        time=time,
        position=dimension("prev_segment_encoder.pos_proj.weight", 1, 2),
        groups=meta.groups,
        past_groups=meta.past_groups,
    )


def _read_codec(path: Path, sizes: NetworkSizes, meta: PublishedMeta) -> tuple[EnCodec, ResidualQuantiser]:
    state = read_published_state(path)
    first = state.get("encoder.model.0.conv.conv.weight_v")
    if not isinstance(first, Tensor) or first.dim() != 3 or 0 in first.shape:
        raise InputError(f"{path}: no encoder.model.0.conv.conv.weight_v; expected EnCodec's 24 kHz state dict")
    if first.shape[1] != 1:
        raise InputError(
            f"{path}: EnCodec's first layer takes {first.shape[1]} channels; expected 1: the 24 kHz model "
            "(encodec_24khz-d7cc33bc.th), not the 48 kHz one"
        )
    codec = EnCodec(int(first.shape[0]), sizes.latent)
    load_state(codec, {name: value for name, value in state.items() if not name.startswith("quantizer.")}, path)
    return codec, _quantiser(path, state, sizes, meta)


def _quantiser(path: Path, state: Mapping[str, object], sizes: NetworkSizes, meta: PublishedMeta) -> ResidualQuantiser:
    books: dict[int, Tensor] = {}
    for name, value in state.items():
        if not name.startswith("quantizer."):
            continue
        match = _CODEBOOK.fullmatch(name)
        if match is None or match[2] not in _CODEBOOK_PARTS:
            raise InputError(f"{path}: not the weights of this network; unexpected: {name}")
        if match[2] == "embed" and isinstance(value, Tensor):
            books[int(match[1])] = value
    if sorted(books) != list(range(len(books))) or not books:
        raise InputError(f"{path}: codebooks {sorted(books)}; expected EnCodec's, numbered from 0")
    shape = books[0].shape
    for number, book in books.items():
        if book.shape != shape or len(shape) != 2 or shape[0] < 2 or shape[1] != sizes.latent:
            raise InputError(
                f"{path}: codebook {number} has the shape {list(book.shape)}; expected [{shape[0]}, {sizes.latent}]"
            )
        if not bool(torch.isfinite(book).all()):
            raise InputError(f"{path}: not a finite number in codebook {number}; the file is damaged")
    used = codebooks_of(meta.bandwidth_kbps, len(books), int(shape[0]))
    return ResidualQuantiser(torch.stack([books[number] for number in range(used)]))
