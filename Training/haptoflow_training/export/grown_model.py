"""A model file that grew by labels of one's own: the networks of the file that training began with, its labels, and the
new ones, each with the level and the tone that the library fits to its recordings."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from haptoflow_training.errors import InputError
from haptoflow_training.export.exporter import described_configuration
from haptoflow_training.recordings.landing import LabelInfo
from haptoflow_training.export.model_file import ModelFile, model_space, read_model_file, with_label, write_model_file
from haptoflow_training.export.learning import joined, learn_material
from haptoflow_training.models.label_embedding import WAVE_NUMBERS
from haptoflow_training.training.found_wave_vectors import stored_recordings
from haptoflow_training.training.recordings_source import Source
from haptoflow_training.training.run_log import source_commit
from haptoflow_training.training.trainer import load_trained

_Floats = NDArray[np.float32]
# Of the label that a new one is nearest to: what only its own recordings say.
_OF_ITS_RECORDINGS = ("name", "embedding_row", "level", "tone", "impulse_gain", "wavelength_metres")
_NO_LIMIT_SECONDS = 3600.0


def export_grown_model(
    folder: Path, source: Source, start: Path, out: Path, advance: Callable[[], object] = lambda: None
) -> int:
    """Write the labels of the finished run in `folder` into a copy of the model file `start`; returns the CRC-32. A label
    of the same name is replaced. advance: called after each label."""
    config, labels, model = load_trained(folder)
    if labels != [info.name for info in source.labels]:
        raise InputError(f"{folder}: trained on labels {labels}, the recordings have {[info.name for info in source.labels]}")
    begun = without_labels(read_model_file(start), labels)
    rows: _Floats = model.embedding.weight.detach().numpy()
    placed = begun
    for info, row in zip(source.labels, rows, strict=True):
        placed = with_label(placed, _described(begun, info, row))
    grown = begun
    with tempfile.TemporaryDirectory() as temporary:
        file = Path(temporary) / "placed.haptoflow"
        write_model_file(file, placed)
        for number, info in enumerate(source.labels):
            try:
                text, _ = learn_material(
                    file, joined(stored_recordings(source.store, number)), info.name,
                    category=info.category, licence=source.provenance.licence,
                    seed=config.seed, seconds_limit=_NO_LIMIT_SECONDS, label=info.name,
                )  # fmt: skip
            except InputError as error:
                raise InputError(f"label '{info.name}', the part of its recordings that is trained on: {error}") from error
            grown = with_label(grown, {**json.loads(text), **_of_its_surface(info)})
            advance()
    run = json.loads((folder / "run.json").read_text(encoding="utf-8"))
    run.pop("configuration", None)
    header = {
        **grown.header,
        "name": config.name,
        "description": config.description,
        "provenance": {
            **_provenance(grown.header["provenance"], source),
            "seed": config.seed,
            "commit": source_commit(Path(__file__).parent),
            "configuration": described_configuration(config),
            "turned_degrees": {name: round(degrees, 3) for name, degrees in source.turned_degrees.items()},
        },
        "measurements": run,
    }
    return write_model_file(out, ModelFile(header, grown.tensors, grown.graphs))


def without_labels(file: ModelFile, names: Sequence[str]) -> ModelFile:
    """The file without these labels, if it has them."""
    kept = [label for label in file.header["labels"] if label["name"] not in names]
    if len(kept) == len(file.header["labels"]):
        return file
    rows = [label["embedding_row"] for label in kept]
    labels = [{**label, "embedding_row": number} for number, label in enumerate(kept)]
    by_row = ("embedding", "pieces")
    tensors = {name: tensor[rows] if name in by_row else tensor for name, tensor in file.tensors.items()}
    return ModelFile({**file.header, "labels": labels}, tensors, file.graphs)


def _described(file: ModelFile, info: LabelInfo, row: _Floats) -> dict[str, Any]:
    """The label as a material that differs from the nearest label by its place alone."""
    learnt = slice(0, len(row) - WAVE_NUMBERS)
    distances = np.linalg.norm(file.tensors["embedding"][:, learnt] - row[learnt], axis=1)
    nearest = min(file.header["labels"], key=lambda label: float(distances[label["embedding_row"]]))
    shared = {key: value for key, value in nearest.items() if key not in _OF_ITS_RECORDINGS}
    return {
        **shared, **_of_its_surface(info), "name": info.name, "space": model_space(file), "embedding": row.tolist(),
        "periodic": info.periodic, "wavelength_metres": info.wavelength_metres,
    }  # fmt: skip


def _of_its_surface(info: LabelInfo) -> dict[str, Any]:
    """What the labels file says of the surface, which no recording contains."""
    return {
        "category": info.category,
        "stiffness_newtons_per_metre": info.stiffness_newtons_per_metre,
        "friction_coefficient": info.friction_coefficient,
    }


def _provenance(begun: dict[str, Any], source: Source) -> dict[str, Any]:
    own = source.provenance
    licences = dict.fromkeys([*str(begun["licence"]).split(", "), *own.licence.split(", ")])
    return {
        **begun,
        "statement": f"{begun['statement']}; own labels {own.statement}",
        "recordings": f"{begun['recordings']}; {own.recordings}",
        "licence": ", ".join(licences),
    }
