"""Times are published from the first complete run: no run can be picked, none is lost."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from haptoflow_paper.rows.timing import Milliseconds
from haptoflow_paper.rows.timing_history import append_run, published_run, read_history, timing_run

_WANTED = {"standard", "draft"}


def _run(model: str, milliseconds: float, *rows: str, complete: bool = False) -> dict[str, Any]:
    times = {row: Milliseconds(milliseconds, 2 * milliseconds) for row in rows}
    return timing_run(
        times, times, date="2026-11-23", commit="c", graphs_sha256=model, is_complete=complete, machine="m",
        load_before=(0.123, 0.2, 0.3), load_after=(0.4, 0.5, 0.6),
    )  # fmt: skip


def test_the_first_complete_run_of_the_model_is_published_and_faster_ones_after_it_change_nothing() -> None:
    runs = [_run("a", 3.0, *_WANTED), _run("a", 1.0, *_WANTED), _run("a", 2.0, *_WANTED)]
    published = published_run(runs, "a", _WANTED)
    assert published is not None and published["rows"]["standard"]["ms_per_segment"] == {"p50": 3.0, "p99": 6.0}


def test_a_run_that_lacks_a_row_of_the_table_is_kept_and_not_published() -> None:
    assert published_run([_run("a", 1.0, "standard")], "a", _WANTED) is None
    runs = [_run("a", 1.0, "standard"), _run("a", 2.0, *_WANTED, "more")]
    assert published_run(runs, "a", _WANTED) is runs[1]


def test_without_a_run_of_every_row_the_first_one_that_skipped_none_by_request_is_shown() -> None:
    runs = [_run("a", 1.0, "standard"), *(_run("a", time, "standard", complete=True) for time in (3.0, 2.0))]
    assert published_run(runs, "a", _WANTED) is runs[1]
    runs.append(_run("a", 9.0, *_WANTED, complete=True))
    assert published_run(runs, "a", _WANTED) is runs[3]


def test_times_of_another_model_are_not_used() -> None:
    runs = [_run("a", 1.0, *_WANTED)]
    assert published_run(runs, "b", _WANTED) is None
    runs.append(_run("b", 5.0, *_WANTED))
    assert published_run(runs, "b", _WANTED) is runs[1] and published_run(runs, "a", _WANTED) is runs[0]


def test_runs_are_appended_with_their_load_and_existing_ones_stay_unchanged(tmp_path: Path) -> None:
    path = tmp_path / "timing-history.json"
    assert read_history(path) == []
    append_run(path, _run("a", 1.0, "standard"))
    first = path.read_text(encoding="utf-8").splitlines()[2]
    runs = append_run(path, _run("a", 2.0, "standard"))
    lines = path.read_text(encoding="utf-8").splitlines()
    assert lines[2].rstrip(",") == first and len(runs) == 2 and read_history(path) == runs
    assert runs[0]["load_before"] == [0.12, 0.2, 0.3] and runs[0]["load_after"] == [0.4, 0.5, 0.6]
    assert json.loads(path.read_text(encoding="utf-8"))["runs"][1]["rows"]["standard"]["ms_paced"]["p99"] == 4.0
