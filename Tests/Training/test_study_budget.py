"""The delay budget: what it reads from the benchmark, its sums, and refused input."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from haptoflow_training.cli import main
from haptoflow_training.errors import InputError
from haptoflow_training.studies.delay_budget import (
    BenchFigures,
    Block,
    Budget,
    Spread,
    budgets,
    page_words,
    read_bench,
    read_lags,
)

PUBLISHED = Path(__file__).parents[2] / "Documentation~" / "benchmarks.md"
ROWS = [
    {"block_frames": 256, "burst_blocks": 1, "p50": 2.0, "p99": 5.0},
    {"block_frames": 256, "burst_blocks": 2, "p50": 4.0, "p99": 10.0},
]
REPORT = {
    "date": "2026-11-23",
    "machine": {"processor": "Some CPU", "cores": 2},
    "model": {"sha256": "a" * 64},
    "sample_rate_hz": 48000,
    "inference_ms": {"standard": {"p50": 0.3, "p99": 0.4, "paced": {"p50": 1.0, "p99": 1.5}}},
    "onset_ms": {"rows": ROWS},
    "stop_ms": {"rows": ROWS},
}


def test_the_report_gives_inference_at_the_pace_of_use_and_latencies_by_block(tmp_path: Path) -> None:
    path = tmp_path / "bench.json"
    path.write_text(json.dumps(REPORT), encoding="utf-8")
    bench = read_bench(path)
    assert bench.inference_ms == {"standard": Spread(1.0, 1.5)} and bench.model_sha256 == "a" * 64
    assert bench.onset_ms[Block(256, 2)] == Spread(4.0, 10.0) and bench.words == "2026-11-23, Some CPU, 2 cores"


def test_a_budget_is_the_sum_of_its_parts_and_leaves_the_rest_of_the_threshold() -> None:
    bench = BenchFigures("", "", 48000.0, {"standard": Spread(1.0, 2.0)}, {}, {})
    (budget,) = budgets(bench, 100.0, Block(480), 20.0).values()
    assert budget == Budget(10.0, 2.0, 10.0, 20.0) and budget.known_ms == 42.0
    assert budget.left_ms("turn-on") == pytest.approx(88.25) and budget.left_ms("turn-off") == pytest.approx(65.74)


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("bench.json", "{}"),
        ("bench.json", "["),
        ("bench.json", "[]"),
        ("page.md", "# Benchmarks\n"),
        ("page.md", PUBLISHED.read_text(encoding="utf-8").split("\nstop, ms")[0]),
    ],
)
def test_an_incomplete_benchmark_is_refused_by_name(tmp_path: Path, name: str, text: str) -> None:
    (tmp_path / name).write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=f"{name}: not a whole report of the benchmark"):
        read_bench(tmp_path / name)


def test_a_page_without_a_measured_part_is_refused_before_anything_is_written(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    plain = tmp_path / "plain.md"
    plain.write_text("# Page\n", encoding="utf-8")
    gone = tmp_path / "gone.md"
    for page, said in ((plain, "the page has no `<!-- measured: begin"), (gone, "gone.md: cannot be read")):
        assert main(["study", "budget", "--bench", str(PUBLISHED), "--page", str(page)]) == 3
        assert said in capsys.readouterr().err
        assert main(["study", "validate", "--out", str(tmp_path / "v.json"), "--page", str(page)]) == 3
        assert said in capsys.readouterr().err
    assert not (tmp_path / "v.json").exists() and not (tmp_path / "images").exists()


def test_the_chart_and_the_page_are_written_together(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    page.write_text("<!-- measured: begin (x) -->\n<!-- measured: end -->\n", encoding="utf-8")
    assert main(["study", "budget", "--bench", str(PUBLISHED), "--page", str(page)]) == 0
    assert "(images/delay-budget.png)" in page.read_text(encoding="utf-8")
    chart = (tmp_path / "images" / "delay-budget.png").read_bytes()
    assert chart.startswith(b"\x89PNG") and read_bench(PUBLISHED).model_sha256.encode() in chart


def _row(lag_ms: float) -> dict[str, object]:
    rates = {rate: {"lag_ms": lag_ms, "correlation": 0.9} for rate in ("72", "90", "120")}
    return {"lags": {"scribbles": rates, "real strokes": rates}}


def test_the_lag_from_stylus_to_vibration_is_a_row_for_each_kind_of_stroke_and_version(tmp_path: Path) -> None:
    path = tmp_path / "lag.json"
    path.write_text(json.dumps({"before": _row(30.0), "now": _row(12.04)}), encoding="utf-8")
    words = page_words(read_bench(PUBLISHED), "c.png", None, read_lags(path))
    assert "| scribbles, before | 30.0 | 30.0 | 30.0 |" in words
    assert "| real strokes, now | 12.0 | 12.0 | 12.0 |" in words
