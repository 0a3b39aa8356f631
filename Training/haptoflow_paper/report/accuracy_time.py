"""accuracy-time.json: every row's accuracy and cost, from which the chart and the page are generated."""

from __future__ import annotations

import dataclasses
import datetime
import json
import platform
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from haptoflow_paper.report.cell_figures import BY_KEY, IDENTITY, JUDGED, JudgedFigure, spread
from haptoflow_paper.rows.row_plan import OURS, PlannedRow
from haptoflow_paper.rows.row_summary import label_table, level_error_p90_db, mean_interval, over_labels, summary
from haptoflow_training.export.model_file import read_model_file, write_model_file
from haptoflow_training.whole_file import write_json

_Cell = Mapping[str, Any]

AHEAD, EVEN, BEHIND = "ahead", "even", "behind"


def verdict(ours: Sequence[_Cell], rival: Sequence[_Cell]) -> dict[str, str]:
    """For each judged figure that both rows have: whether ours is ahead of the rival, even with it or behind it.

    Compared is the error magnitude, rival's less ours, of each recording that both were measured on, averaged over the
    mean of each label. Ahead or behind means that its 95 % bootstrap interval, over recordings within labels, excludes
    zero.
    """
    by_identity = {_identity(cell): cell for cell in ours}
    pairs = [(by_identity[_identity(cell)], cell) for cell in rival if _identity(cell) in by_identity]
    found = {}
    for figure in JUDGED:
        differences = _differences(pairs, figure)
        if differences:
            low, high = mean_interval(differences)
            found[figure.key] = AHEAD if low > 0.0 else BEHIND if high < 0.0 else EVEN
    return found


def _identity(cell: _Cell) -> tuple[Any, ...]:
    return tuple(cell[key] for key in IDENTITY)


def _differences(pairs: Sequence[tuple[_Cell, _Cell]], figure: JudgedFigure) -> dict[str, list[float]]:
    grouped: dict[str, list[float]] = {}
    for ours, theirs in pairs:
        values = [cell.get(figure.key) for cell in (ours, theirs)]
        if values[0] is not None and values[1] is not None:
            difference = figure.size(values[1]) - figure.size(values[0])
            grouped.setdefault(ours["label"], []).append(difference)
    return grouped


@dataclass(frozen=True)
class RivalVerdict:
    """A rival in every figure, by its best variant in each: `variants` names that row by figure."""

    rival: str
    block: str
    by_figure: dict[str, str]
    variants: dict[str, str]

    def figures(self, outcome: str) -> list[str]:
        return [key for key, found in self.by_figure.items() if found == outcome]


def rivals(rows: Sequence[Mapping[str, Any]], blocks: Sequence[str]) -> list[RivalVerdict]:
    """Every rival of the blocks. Rows of one network at several numbers of steps are one rival, represented in each
    figure by its best row: the one whose median is furthest ahead of the row it is judged against, because not all
    are measured on the same recordings."""
    by_name = {row["name"]: row for row in rows}
    grouped: dict[tuple[str, str], list[Mapping[str, Any]]] = {}
    for row in rows:
        if row["block"] in blocks and row.get("verdict"):
            grouped.setdefault((row["block"], row["rival"]), []).append(row)
    return [_joined(rival, block, variants, by_name) for (block, rival), variants in grouped.items()]


def _joined(
    rival: str, block: str, variants: Sequence[Mapping[str, Any]], by_name: Mapping[str, Mapping[str, Any]]
) -> RivalVerdict:
    def lag(row: Mapping[str, Any], figure: JudgedFigure) -> float:
        reference = by_name.get(row.get("against", ""))
        ours = 0.0 if reference is None else figure.size(median_of(reference, figure.key))
        return figure.size(median_of(row, figure.key)) - ours

    by_figure, best = {}, {}
    for key, figure in BY_KEY.items():
        having = [row for row in variants if key in row["verdict"]]
        if having:
            chosen = min(having, key=lambda row: lag(row, figure))
            by_figure[key], best[key] = chosen["verdict"][key], chosen["name"]
    return RivalVerdict(rival, block, by_figure, best)


def median_of(row: Mapping[str, Any], key: str) -> float:
    """The median over cells of a row of accuracy-time.json."""
    spread = row[key] if isinstance(row.get(key), Mapping) else row["cells"][key]
    return float(spread["median"])


_SEED_HEADLINES = ("level_error_db", "gfc_recording", "lsd_db")
_KEPT = ("fast", "kink_db", "drift_seconds")
_TIMES = ("ms_per_segment", "ms_paced")


def machine_words() -> str:
    """Processor and system of this machine, which published times must state."""
    model = platform.processor() or platform.machine()
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
        model = next((line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")), model)
    except OSError:
        pass
    return f"{model}, one thread, {platform.system()}"


def table(plan: Sequence[PlannedRow], measured: Mapping[str, Sequence[dict[str, Any]]]) -> dict[str, Any]:
    """measured: by row name one result for each seed (row_runner.measure_row), the first seed first. Rows that were
    not measured are left out and named in `not_measured`. Times are added by `with_times`."""

    def judged_against(row: PlannedRow) -> Sequence[dict[str, Any]]:
        own = row.against == row.name or row.against not in measured
        return [] if own else measured[row.against][0]["conditions"]

    rows = [_row(row, measured[row.name], judged_against(row)) for row in plan if row.name in measured]
    today = datetime.date.today().isoformat()
    return {"machine": machine_words(), "date": today, "not_measured": _absent(plan, rows), "rows": rows}


def timed_rows(table: Mapping[str, Any]) -> set[str]:
    """Names of the rows that a complete timing run holds: all except the references."""
    return {row["name"] for row in table["rows"] if row["block"] != "reference"}


def with_times(table: dict[str, Any], run: Mapping[str, Any] | None) -> dict[str, Any]:
    """The table with the times of one run; rows that it does not hold have no times."""
    nothing = dict.fromkeys(_TIMES)
    times = {} if run is None else run["rows"]
    rows = [{**row, **nothing, **times.get(row["name"], {})} for row in table["rows"]]
    timed = None if run is None else {key: value for key, value in run.items() if key != "rows"}
    return {**table, "timed": timed, "rows": rows}


def _absent(plan: Sequence[PlannedRow], rows: Sequence[dict[str, Any]]) -> list[str]:
    present = {row["name"] for row in rows}
    return [row.name for row in plan if row.name not in present]


def _row(
    row: PlannedRow, results: Sequence[dict[str, Any]], reference: Sequence[dict[str, Any]]
) -> dict[str, Any]:
    first = results[0]
    cells = first["conditions"]
    entry: dict[str, Any] = {
        "name": row.name,
        "block": row.block,
        "rival": row.rival_name,
        "family": row.family,
        "solver": row.solver,
        "steps": row.steps,
        "evaluations": row.evaluations,
        "parameters": first["parameters"],
        "bytes": first["bytes"],
        **dict.fromkeys(_TIMES),
        **_rounded(summary(cells)),
        "drift_db_per_min": _rounded(first["drift_db_per_min"]),
        "label_discrimination": _rounded(first["discrimination"]),
        **{key: _rounded(first[key]) for key in _KEPT if key in first},
        "recordings": len(cells),
        "every_fourth": row.every_fourth,
        "seeds": len(results),
    }
    if row.block == OURS and cells:
        entry["by_label"] = _rounded(label_table(cells))
    if cells and reference:
        entry["against"] = row.against
        entry["verdict"] = verdict(reference, cells)
    if len(results) > 1:
        entry["by_seed"] = _by_seed(results)
    return entry


def _by_seed(results: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """Figures of each seed on the recordings that all seeds were measured on."""
    keyed = [{tuple(cell[key] for key in IDENTITY): cell for cell in result["conditions"]} for result in results]
    shared = [key for key in keyed[0] if all(key in other for other in keyed)]
    common = [[cells[key] for key in shared] for cells in keyed]
    spreads = {figure.key: [spread(cells, figure) for cells in common] for figure in JUDGED}
    return {
        "seeds": [result["seed"] for result in results],
        "recordings": len(shared),
        "level_error_p90_db": [_rounded(level_error_p90_db(cells)) for cells in common],
        **{key: [_rounded(over_labels(cells, key)) for cells in common] for key in _SEED_HEADLINES},
        "medians": {
            key: [_rounded(None if found is None else found["median"]) for found in values]
            for key, values in spreads.items()
        },
    }


def _rounded(value: Any) -> Any:
    """Rounded to four digits, at any depth."""
    if isinstance(value, dict):
        return {key: _rounded(entry) for key, entry in value.items()}
    if isinstance(value, list):
        return [_rounded(entry) for entry in value]
    return round(float(value), 4) if isinstance(value, float) else value


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
