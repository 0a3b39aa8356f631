"""The goals of the default tier, compared with accuracy-time.json; missed goals are reported like met ones."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from haptoflow_paper.report.cell_figures import BY_KEY
from haptoflow_paper.report.accuracy_time import AHEAD, BEHIND, EVEN, rivals
from haptoflow_paper.rows.row_plan import RIVAL_BLOCKS

_Row = Mapping[str, Any]

_MEBIBYTE = 2**20
_MAXIMUM_FILE_MEBIBYTES = 12.0
_NOT_MEASURED = "not measured"


@dataclass(frozen=True)
class Goal:
    """what: the goal in words. wanted and measured: printable values. holds: None if a row that it needs is missing."""

    what: str
    wanted: str
    measured: str
    holds: bool | None


def judge(table: Mapping[str, Any]) -> list[Goal]:
    """Every goal; empty if the default tier was not measured."""
    rows = {row["name"]: row for row in table["rows"]}
    if "standard" not in rows:
        return []
    standard = rows["standard"]
    goals = [_bound(what, _found(standard, path), limit, is_highest) for what, path, limit, is_highest in _BOUNDS]
    goals.append(_oblique(standard))
    goals += _told_apart(standard)
    goals += _tiers(rows)
    goals += [_not_behind(table["rows"], block) for block in RIVAL_BLOCKS]
    goals += list(_times(rows))
    size = table.get("model_bytes")
    goals.append(_bound("size of the model file, MiB", size and size / _MEBIBYTE, _MAXIMUM_FILE_MEBIBYTES, True))
    return [*goals, *(_fast_strokes(standard["fast"]) if "fast" in standard else [])]


# Goal, path of the figure in the row, limit, and whether the limit is a maximum. Spreads are of error magnitudes over
# cells: nine cells in ten are at least as good as p90 (for a share, the tenth percentile).
_BOUNDS: tuple[tuple[str, tuple[str, ...], float, bool], ...] = (
    ("size of the median level error, dB", ("level_error_db",), 0.25, True),
    ("level, nine cells in ten, dB", ("cells", "level_error_db", "p90"), 0.7, True),
    ("level at 10 mm/s, nine cells in ten, dB", ("special", "slow_level_error_db", "p90"), 2.2, True),
    ("GFC", ("gfc_recording",), 0.988, False),
    ("GFC of the worst label", ("gfc_label_worst",), 0.95, False),
    ("LSD, dB", ("lsd_db",), 0.9, True),
    ("LSD, nine cells in ten, dB", ("cells", "lsd_db", "p90"), 1.8, True),
    ("LSD of ruled labels, median cell, dB", ("special", "ruled_lsd_db", "median"), 1.4, True),
    ("error of the fundamental, nine cells in ten, %", ("cells", "f0_error_percent", "p90"), 1.0, True),
    ("harmonic share, folded, nine cells in ten", ("cells", "harmonic_share", "p90"), 0.8, False),
    ("impacts: factor of kurtosis, nine cells in ten", ("special", "impact_kurtosis_log_ratio", "p90"), 1.6, True),
    ("impacts: crest, nine cells in ten, dB", ("special", "impact_crest_error_db", "p90"), 1.5, True),
    ("ribs, 0.01 to 0.5 m/s: modulation, nine in ten, dB", ("special", "rib_modulation_error_db", "p90"), 3.0, True),
    ("ribs, 0.01 to 0.5 m/s: coherence, nine in ten", ("special", "rib_coherence", "p90"), 0.8, False),
    ("nap of carpet and fur, difference of along and against, dB", ("special", "nap_error_db"), 0.7, True),
    ("drift, dB a minute", ("drift_db_per_min",), 0.1, True),
)  # fmt: skip
# Of the faster tiers: LSD in dB, and the share told apart of the median label in percent.
_FASTER_TIERS = (("draft", 1.05, 62.0), ("sketch", 1.2, 68.0))
# How many times faster than the paper's sizes a segment is made: hot, and at live pace.
_TIMES_FASTER = (("standard", 90.0, 40.0), ("draft", 200.0, 75.0), ("sketch", 350.0, 250.0))
# The figures in which a slower tier should be ahead of a faster one.
_EARNED = ("lsd_db", "gfc_recording", "told_apart_percent", "rib_modulation_error_db", "kurtosis_log_ratio")


def _found(row: _Row, path: Sequence[str]) -> float | None:
    value: Any = row
    for key in path:
        value = None if value is None else value.get(key)
    if value is None:
        return None
    # A ratio of kurtoses is stored as its logarithm.
    return math.exp(value) if path[-2:-1] == ("impact_kurtosis_log_ratio",) else float(value)


def _bound(what: str, value: float | None, limit: float, is_highest: bool) -> Goal:
    wanted = f"at {'most' if is_highest else 'least'} {limit:g}"
    if value is None:
        return Goal(what, wanted, _NOT_MEASURED, None)
    measured = abs(value)
    return Goal(what, wanted, f"{measured:.3g}", measured <= limit if is_highest else measured >= limit)


def _oblique(standard: _Row) -> Goal:
    straight, oblique = (_found(standard, ("special", f"{name}_lsd_db")) for name in ("straight", "oblique"))
    what, wanted = "LSD across ribs obliquely over that straight across, dB", "at most +0.5"
    if straight is None or oblique is None:
        return Goal(what, wanted, _NOT_MEASURED, None)
    return Goal(what, wanted, f"{oblique - straight:+.2f}", oblique - straight <= 0.5)


def _told_apart(standard: _Row) -> list[Goal]:
    return [
        _bound(f"told apart from recordings, {key} label, %", _found(standard, ("told_apart_percent", key)), limit, True)
        for key, limit in (("median", 60.0), ("worst", 70.0))
    ]


def _tiers(rows: Mapping[str, _Row]) -> Iterator[Goal]:
    """What the faster tiers reach, and whether the default one is ahead of them where a network should be."""
    for name, lsd_db, told_percent in _FASTER_TIERS:
        row = rows.get(name, {})
        yield _bound(f"LSD of {name}, dB", row.get("lsd_db"), lsd_db, True)
        told = row.get("told_apart_percent") or {}
        yield _bound(f"told apart, {name}, median label, %", told.get("median"), told_percent, True)
        yield _earned(name, row.get("verdict"))


def _earned(name: str, verdict: Mapping[str, str] | None) -> Goal:
    what, wanted = f"standard ahead of {name}", f"in {', '.join(BY_KEY[key].words for key in _EARNED)}"
    if verdict is None:
        return Goal(what, wanted, _NOT_MEASURED, None)
    ahead = [key for key in _EARNED if verdict.get(key) == AHEAD]
    words = f"in {', '.join(BY_KEY[key].words for key in ahead)}" if ahead else "in none"
    return Goal(what, wanted, words, len(ahead) == len(_EARNED))


def _not_behind(rows: Sequence[_Row], block: str) -> Goal:
    """The comparison with every rival: counts over rivals and figures, with the figures where one wins."""
    what = f"behind a rival, {block.replace('-', ' ')}"
    found = rivals(rows, (block,))
    if not found:
        return Goal(what, "in no figure", _NOT_MEASURED, None)
    counts = {outcome: sum(len(rival.figures(outcome)) for rival in found) for outcome in (AHEAD, EVEN, BEHIND)}
    wins = [
        f"{rival.rival} in {', '.join(BY_KEY[key].words for key in rival.figures(BEHIND))}"
        for rival in found if rival.figures(BEHIND)
    ]  # fmt: skip
    words = f"ahead {counts[AHEAD]}, even {counts[EVEN]}, behind {counts[BEHIND]}"
    return Goal(what, "in no figure", f"{words}: {'; '.join(wins)}" if wins else words, not wins)


def _times(rows: Mapping[str, _Row]) -> Iterator[Goal]:
    paper = rows.get("paper-codec-size")
    for name, hot, paced in _TIMES_FASTER:
        for key, words, wanted in (("ms_per_segment", "hot", hot), ("ms_paced", "at live pace", paced)):
            times = [row and row.get(key) for row in (rows.get(name), paper)]
            what = f"times faster than the paper's sizes, {words}: {name}"
            ratio = times[1]["p50"] / times[0]["p50"] if times[0] and times[1] else None
            yield _bound(what, ratio, wanted, False)


def _fast_strokes(fast: Sequence[_Row]) -> list[Goal]:
    where = "500 to 1500 mm/s at 30, 72 and 120 Hz"
    level = max(abs(entry["level_error_db"]) for entry in fast)
    gfc = min(entry["gfc_recording"] for entry in fast)
    lsd = max(entry["lsd_db"] for entry in fast)
    return [
        _bound(f"level error, {where}, dB", level, 0.75, True),
        _bound(f"GFC, {where}", gfc, 0.985, False),
        _bound(f"LSD, {where}, dB", lsd, 2.4, True),
    ]
