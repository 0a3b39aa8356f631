"""Writes measured figures into a model file's header: accuracy and cost of each tier."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from haptoflow_training.export.model_file import read_model_file, write_model_file
from haptoflow_training.training.run_log import write_json

_ACCURACY = ("level_error_db", "level_error_p90_db", "gfc_recording", "lsd_db", "f0_error_percent", "drift_db_per_min")


def annotate_model(path: Path, machine: str, rows: Mapping[str, Mapping[str, Any]], parity: Path | None = None) -> int:
    """Write `accuracy` and `cost` of the tiers named in `rows` (rows of accuracy-time.json by tier) into the file.

    A tier keeps the cost of its first timing while its accuracy is the same, so that a later evaluation of more rivals
    leaves the file as it is, and every page that names it. Returns the file's CRC-32, which is also written to the golden
    vectors `parity`, because they name their model file.
    """
    file = read_model_file(path)
    header = json.loads(json.dumps(file.header))
    for tier in header["tiers"]:
        row = rows.get(tier["name"])
        if row is None:
            continue
        accuracy = {key: row[key] for key in _ACCURACY if row.get(key) is not None}
        if tier.get("accuracy") == accuracy and "ms_p50" in tier.get("cost", {}):
            continue
        tier["accuracy"] = accuracy
        hot, live = row.get("ms_per_segment"), row.get("ms_paced")
        tier["cost"] = {"machine": machine}
        if hot is not None and live is not None:
            tier["cost"] |= {"ms_p50": hot["p50"], "ms_live_p50": live["p50"], "ms_live_p99": live["p99"]}
    checksum = write_model_file(path, dataclasses.replace(file, header=header))
    if parity is not None:
        golden = json.loads(parity.read_text(encoding="utf-8"))
        write_json(parity, {**golden, "model_crc32": f"{checksum:08x}"})
    return checksum
