"""Plans of the two user studies, and the golden file that the Unity package reads too."""

from __future__ import annotations

import json
import re
import shlex
from collections import Counter
from pathlib import Path

import pytest

from haptoflow_training.cli import main
from haptoflow_training.errors import InputError
from haptoflow_training.model_stamp import with_measured_words
from haptoflow_training.studies.delay_budget import (
    BenchFigures, Block, Budget, budgets, page_words as budget_words, read_bench
)
from haptoflow_training.studies.plans import SplitMix64, latency_plan, similarity_plan, williams_design
from places import ROOT

GOLDEN = Path(__file__).parents[1] / "Golden" / "studies" / "plans.json"
LEVELS = [float(level) for level in range(50, 251, 20)]
MATERIALS = ["ceramic", "jute", "wood", "plastic", "fur", "metal"]
METHODS = ["haptoflow", "transformer", "dstn", "spsi"]


def test_the_generator_gives_the_published_values_of_splitmix64() -> None:
    random = SplitMix64(1234567)
    assert [random.next() for _ in range(5)] == [
        6457827717110365317, 3203168211198807973, 9817491932198370423, 4593380528125082431, 16408922859458223821,
    ]  # fmt: skip


@pytest.mark.parametrize("count", range(1, 13))
def test_in_a_williams_design_each_treatment_has_each_place_and_follows_each_other_equally_often(count: int) -> None:
    rows = williams_design(count)
    assert len(rows) == (1 if count == 1 else count if count % 2 == 0 else 2 * count)
    for place in range(count):
        assert set(Counter(row[place] for row in rows).values()) == {len(rows) // count}
    pairs = Counter(pair for row in rows for pair in zip(row, row[1:]))
    assert len(pairs) == count * (count - 1) and len(set(pairs.values())) <= 1


@pytest.mark.parametrize("participant", range(1, 25))
def test_every_participant_gets_every_level_once_under_each_condition_after_four_practice_trials(
    participant: int,
) -> None:
    plan = latency_plan(participant, 3, LEVELS)
    assert [trial.trial for trial in plan] == list(range(1, 27))
    practice, first, second = plan[:4], plan[4:15], plan[15:]
    order = ["turn-on", "turn-off"] if participant % 2 else ["turn-off", "turn-on"]
    assert [(trial.condition, trial.delay_ms) for trial in practice] == [
        (order[0], 50.0), (order[0], 250.0), (order[1], 50.0), (order[1], 250.0),
    ]  # fmt: skip
    for block, condition in ((first, order[0]), (second, order[1])):
        assert {trial.condition for trial in block} == {condition}
        assert sorted(trial.delay_ms for trial in block) == LEVELS
    assert [trial.block for trial in plan] == ["practice"] * 4 + ["main"] * 22


@pytest.mark.parametrize("participant", range(1, 25))
def test_every_participant_rates_every_method_once_on_every_material_one_material_after_another(
    participant: int,
) -> None:
    plan = similarity_plan(participant, 3, MATERIALS, METHODS)
    assert [(trial.block, trial.material, trial.method) for trial in plan[:4]] == [
        ("practice", "ceramic", method) for method in METHODS
    ]
    main_trials = plan[4:]
    assert {trial.block for trial in main_trials} == {"main"}
    for begin in range(0, 24, 4):
        assert len({trial.material for trial in main_trials[begin : begin + 4]}) == 1
    assert len({(trial.material, trial.method) for trial in main_trials}) == 24


def test_over_24_participants_each_method_stands_six_times_at_each_place_of_each_material() -> None:
    places = Counter()
    for participant in range(1, 25):
        trials = [trial for trial in similarity_plan(participant, 9, MATERIALS, METHODS) if trial.block == "main"]
        places.update((trial.material, trial.method, place % 4) for place, trial in enumerate(trials))
    assert set(places.values()) == {6} and len(places) == 6 * 4 * 4


def test_the_committed_golden_plans_are_what_the_command_writes(tmp_path: Path) -> None:
    assert main(["study", "golden", "--out", str(tmp_path / "plans.json")]) == 0
    assert (tmp_path / "plans.json").read_bytes() == GOLDEN.read_bytes()
    golden = json.loads(GOLDEN.read_text(encoding="utf-8"))
    assert {case["participant"] for case in golden["latency"]} == {1, 2, 7, 24}
    assert {len(case["levels_ms"]) for case in golden["latency"]} == {11, 4}
    assert {(len(case["materials"]), len(case["methods"])) for case in golden["similarity"]} == {(6, 4), (3, 3), (2, 6)}
    assert {case["seed"] for case in golden["similarity"]} == {1, 2**63 + 5}


PUBLISHED = ROOT / "Training" / "results" / "benchmarks.md"
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
    assert bench.inference_ms == {"standard": 1.5} and bench.model_sha256 == "a" * 64
    assert bench.onset_ms[Block(256, 2)] == 10.0 and bench.words == "2026-11-23, Some CPU, 2 cores"


def test_a_budget_is_the_sum_of_its_parts_and_leaves_the_rest_of_the_threshold() -> None:
    bench = BenchFigures("", "", 48000.0, {"standard": 2.0}, {}, {})
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
    assert not (tmp_path / "images").exists()


def test_the_chart_and_the_page_are_written_together(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    page.write_text("<!-- measured: begin (x) -->\n<!-- measured: end -->\n", encoding="utf-8")
    assert main(["study", "budget", "--bench", str(PUBLISHED), "--page", str(page)]) == 0
    assert "(images/delay-budget.png)" in page.read_text(encoding="utf-8")
    chart = (tmp_path / "images" / "delay-budget.png").read_bytes()
    assert chart.startswith(b"\x89PNG") and read_bench(PUBLISHED).model_sha256.encode() in chart


PAGES = ROOT / "Documentation~"
FILES, STUDIES = PAGES / "study-files.md", PAGES / "studies.md"
RESULTS = ROOT / "Training" / "results"
# Options added to a command, so that a test does not take minutes.
SHORTER = {"power": ["--simulations", "10"]}


def commands(page: Path) -> list[list[str]]:
    """The words of each command in the blocks without a language."""
    blocks = [part for part in page.read_text(encoding="utf-8").split("\n```")[1::2] if part.startswith("\n")]
    found = []
    for line in (line for block in blocks for line in block.strip().splitlines()):
        command = re.fullmatch(r"PYTHONPATH=Training python3 -m haptoflow_training (.*)", line)
        assert command, f"not a command of this page: {line}"
        found.append(shlex.split(command[1]))
    return found


@pytest.mark.parametrize(
    ("page", "steps"),
    [
        (FILES, ["power", "power", "simulate", "simulate", "check", "merge", "analyse"]),
        (STUDIES, ["budget", "budget"]),
    ],
)
def test_every_command_of_a_page_runs_in_its_order(
    page: Path, steps: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "Training" / "results").mkdir(parents=True)
    (tmp_path / "Training" / "results" / "benchmarks.md").write_bytes((RESULTS / "benchmarks.md").read_bytes())
    monkeypatch.chdir(tmp_path)
    ran = []
    for words in commands(page):
        assert main([*words, *SHORTER.get(words[1], [])]) == 0, (words, capsys.readouterr().err)
        ran.append(words[1])
    assert ran == steps
    if "analyse" in ran:
        assert "SIMULATED" in (tmp_path / "report.html").read_text(encoding="utf-8")
    if "merge" in ran:
        assert sorted(path.name for path in (tmp_path / "tables").iterdir()) == ["latency.csv", "similarity.csv"]


def test_the_published_budget_is_that_of_the_published_benchmark() -> None:
    page = (RESULTS / "delay-budget.md").read_text(encoding="utf-8")
    chart = "../../Documentation~/images/delay-budget.png"
    words = budget_words(read_bench(PUBLISHED), chart)
    assert page == with_measured_words(page, words), "write it anew: haptoflow-training study budget --page"
