"""Untrained networks, of the sizes that a row's own has, to measure its time where its model is not on this machine: the
time of a segment does not depend on the weights, and training them takes hours."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Sequence

from haptoflow_paper.codec.small_codec import SmallCodec
from haptoflow_paper.rows.row_plan import PlannedRow
from haptoflow_paper.rows.workplace import Workplace, training_job
from haptoflow_training.training.config import load_config
from haptoflow_training.training.processes import Job, run_jobs
from haptoflow_training.whole_file import write_text

_CONFIGURATION = """extends = {extends}

[optimiser]
budget_seconds = 0.0
batch_size = 16
level_steps = 20
steps = 1
level_polish_steps = 0

[recipe]
filter_steps = 0
reflow_steps = 0
energy_steps = 0
self_forcing_steps = 0
calibrate_level = false
"""
_CODEC = """
[model.representation]
kind = "small-codec"
checkpoint = {checkpoint}
"""


def make_untrained(
    place: Workplace, rows: Sequence[PlannedRow], lanes: int, progress: Callable[[int], None] = lambda finished: None
) -> None:
    """Write the files that `place.timed_file` names for rows whose model is not on this machine."""
    jobs = {out: _job(place, row) for row in rows if not (out := place.timed_file(row)).exists()}
    run_jobs(list(jobs.values()), lanes, progress)


def _job(place: Workplace, row: PlannedRow) -> Job:
    seed, out = row.seeds[0], place.timed_file(row)
    model = row.model_of(seed)
    config, codec = out.with_name(f"{model}.toml"), out.with_name(f"{model}-codec.pt")
    config.parent.mkdir(parents=True, exist_ok=True)
    text = _CONFIGURATION.format(extends=json.dumps(os.path.relpath(place.config_file(model), config.parent)))
    if load_config(place.config_file(model)).model.representation["kind"] == "small-codec":
        SmallCodec().save(codec)
        text += _CODEC.format(checkpoint=json.dumps(str(codec)))
    write_text(config, text)
    return training_job(place, f"{model}, untrained", config, seed, out.parent / model, out)
