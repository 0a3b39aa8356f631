"""What the default tier is meant to reach, held against accuracy-time.json: what is missed is stated like what is met."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

_Row = dict[str, Any]

# The families whose rows nobody would ship instead of ours; references are a ruler, ablations are parts of ours.
_RIVAL_FAMILIES = ("baselines", "plain flow matching", "other recipes")


@dataclass(frozen=True)
class Goal:
    """what: in words. wanted and measured: as a reader reads them. holds: None where a row that it needs is missing."""

    what: str
    wanted: str
    measured: str
    holds: bool | None


def judge(table: dict[str, Any]) -> list[Goal]:
    """Every goal; empty where the default tier was not measured."""
    rows = {row["name"]: row for row in table["rows"]}
    if "standard" not in rows:
        return []
    standard = rows["standard"]
    goals = [_bound(standard, *entry) for entry in _BOUNDS]
    goals += _beside_eight_steps(standard, rows.get("eight-step"))
    goals.append(_ahead(standard, list(rows.values())))
    goals += [
        _faster(rows.get(name), rows.get("paper-codec-size"), f"times faster than the paper's sizes: {name}", wanted)
        for name, wanted in (("standard", 60.0), ("draft", 120.0))
    ]
    return [*goals, *(_fast_strokes(standard["fast"]) if "fast" in standard else [])]


# What, key, limit, and whether the size of the figure may at most be that, or must at least.
_BOUNDS: tuple[tuple[str, str, float, bool], ...] = (
    ("size of the level error, dB", "level_error_db", 0.5, True),
    ("level error of nine recordings in ten, dB", "level_error_p90_db", 2.2, True),
    ("GFC by recording", "gfc_recording", 0.99, False),
    ("GFC of the worst label", "gfc_label_worst", 0.95, False),
    ("log-spectral distance, dB", "lsd_db", 1.6, True),
    ("error of the fundamental, %", "f0_error_percent", 1.0, True),
    ("share of power near harmonics, over the recording's", "harmonic_share", 0.9, False),
    ("drift, dB a minute", "drift_db_per_min", 0.1, True),
)


def _bound(row: _Row, what: str, key: str, limit: float, is_highest: bool) -> Goal:
    value = row[key]
    wanted = f"at {'most' if is_highest else 'least'} {limit:g}"
    if value is None:
        return Goal(what, wanted, "not measured", None)
    measured = abs(value)
    return Goal(what, wanted, f"{measured:.4g}", measured <= limit if is_highest else measured >= limit)


def _beside_eight_steps(standard: _Row, reference: _Row | None) -> list[Goal]:
    goals = []
    for key, what, limit, sign in (
        ("gfc_recording", "GFC below our network's at eight evaluations", 0.005, 1.0),
        ("lsd_db", "log-spectral distance above it, dB", 0.3, -1.0),
    ):
        wanted = f"at most {limit:g}"
        if reference is None:
            goals.append(Goal(what, wanted, "not measured", None))
            continue
        behind = sign * (reference[key] - standard[key])
        goals.append(Goal(what, wanted, f"{behind:+.3g}", behind <= limit))
    return goals


def _ahead(standard: _Row, rows: list[_Row]) -> Goal:
    def is_ahead(rival: _Row) -> bool:
        return (
            abs(standard["level_error_db"]) < abs(rival["level_error_db"])
            and standard["gfc_recording"] > rival["gfc_recording"]
            and standard["lsd_db"] < rival["lsd_db"]
        )

    rivals = [row for row in rows if row["family"] in _RIVAL_FAMILIES and row["level_error_db"] is not None]
    not_behind = [row["name"] for row in rivals if not is_ahead(row)]
    measured = f"of {len(rivals) - len(not_behind)} of {len(rivals)}"
    if not_behind:
        measured += f", not of {', '.join(not_behind)}"
    return Goal("ahead in level, GFC and log-spectral distance at once", "of every rival", measured, not not_behind)


def _faster(ours: _Row | None, paper: _Row | None, what: str, wanted: float) -> Goal:
    times = [row and row["ms_per_segment"] for row in (ours, paper)]
    if times[0] is None or times[1] is None:
        return Goal(what, f"at least {wanted:g}", "not measured", None)
    ratio = times[1]["p50"] / times[0]["p50"]
    return Goal(what, f"at least {wanted:g}", f"{ratio:.3g}", ratio >= wanted)


def _fast_strokes(fast: list[_Row]) -> list[Goal]:
    where = "500 to 1500 mm/s at 30, 72 and 120 Hz"
    level = max(abs(entry["level_error_db"]) for entry in fast)
    gfc = min(entry["gfc_recording"] for entry in fast)
    lsd = max(entry["lsd_db"] for entry in fast)
    return [
        Goal(f"level error, {where}, dB", "at most 0.75", f"{level:.2f}", level <= 0.75),
        Goal(f"GFC, {where}", "at least 0.985", f"{gfc:.4f}", gfc >= 0.985),
        Goal(f"log-spectral distance, {where}, dB", "at most 2.4", f"{lsd:.2f}", lsd <= 2.4),
    ]
