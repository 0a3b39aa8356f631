"""What training cannot know of the distilled file: further names of its labels, and an assumed level."""

from __future__ import annotations

from pathlib import Path

from haptoflow_paper.distil.teacher import Teacher
from haptoflow_training.export.model_file import read_model_file, write_model_file

_OF_THE_OTHER = ("name", "category", "stiffness_newtons_per_metre", "friction_coefficient")


def complete(file: Path, teacher: Teacher) -> int:
    """Rewrite the file with them; returns its CRC-32."""
    model = read_model_file(file)
    header = model.header
    entries = {entry["name"]: entry for entry in header["labels"]}
    for label in teacher.labels:
        for other in label.others:
            header["labels"].append({**entries[label.name], **{key: other[key] for key in _OF_THE_OTHER}})
    header["name"] = f"{teacher.name}, distilled"
    header["description"] = f"{len(entries)} materials of {teacher.name}, learnt from what it generates."
    header["normalisation"]["assumed"] = teacher.level_is_assumed
    return write_model_file(file, model)
