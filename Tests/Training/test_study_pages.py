"""Runs the commands of the studies' pages as printed, and checks published figures, keys and columns."""

from __future__ import annotations

import json
import re
import shlex
from pathlib import Path

import pytest

from haptoflow_training.cli import main
from haptoflow_training.model_stamp import with_measured_words
from haptoflow_training.studies.bench_figures import read_bench
from haptoflow_training.studies.delay_budget import page_words as budget_words
from haptoflow_training.studies.delay_budget import read_lags
from haptoflow_training.studies.log_columns import COLUMNS
from haptoflow_training.studies.sidecar_file import KEYS
from haptoflow_training.studies.validation_words import page_words as validation_words

ROOT = Path(__file__).parents[2]
PAGES = ROOT / "Documentation~"
FILES, STUDIES = PAGES / "study-files.md", PAGES / "studies.md"
RESULTS = ROOT / "Training" / "results"
# Options added to a command, so that a test does not take minutes.
SHORTER = {
    "power": ["--simulations", "10"],
    "validate": ["--studies", "2", "--simulations", "2"],
}


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
        (FILES, ["power", "power", "simulate", "simulate", "check", "merge", "analyse", "validate"]),
        (STUDIES, ["budget", "budget"]),
    ],
)
def test_every_command_of_a_page_runs_in_its_order(
    page: Path, steps: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "Training" / "results" / "default").mkdir(parents=True)
    for name in ("benchmarks.md", "study-validation.md", "default/stylus-lag.json"):
        (tmp_path / "Training" / "results" / name).write_bytes((RESULTS / name).read_bytes())
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
    if "validate" in ran:
        assert json.loads((tmp_path / "Training" / "results" / "study-validation.json").read_text())["studies"] == 2


def test_every_column_and_key_of_the_logs_is_explained() -> None:
    named = set(re.findall(r"`([a-z0-9_]+)`", FILES.read_text(encoding="utf-8")))
    for columns in COLUMNS.values():
        for column in columns:
            assert column.name in named, column.name
            assert set(column.words) <= named | {"turn-on", "turn-off"}
    for key in ("format", "version", *KEYS):
        assert key in named, key


def test_the_published_budget_is_that_of_the_published_benchmark() -> None:
    page = (RESULTS / "delay-budget.md").read_text(encoding="utf-8")
    lags = read_lags(RESULTS / "default" / "stylus-lag.json")
    chart = "../../Documentation~/images/delay-budget.png"
    words = budget_words(read_bench(RESULTS / "benchmarks.md"), chart, None, lags)
    assert page == with_measured_words(page, words), "write it anew: haptoflow-training study budget --page"


def test_the_published_validation_is_the_committed_one() -> None:
    page = (RESULTS / "study-validation.md").read_text(encoding="utf-8")
    found = json.loads((RESULTS / "study-validation.json").read_text(encoding="utf-8"))
    assert found["studies"] >= 200 and found["simulations"] >= 1000
    assert page == with_measured_words(page, validation_words(found)), "write it anew: study validate --page"


def test_the_committed_validation_meets_its_criteria() -> None:
    found = json.loads((ROOT / "Training" / "results" / "study-validation.json").read_text(encoding="utf-8"))
    assert found["participants"] == 24
    for condition, truth in (("turn-on", 130.25), ("turn-off", 107.74)):
        one = found["thresholds"][condition]
        assert one["truth_ms"] == truth and one["covered"]["of"] == 200
        assert one["covered"]["low"] <= 0.95 <= one["covered"]["high"]
    for name, rate in found["false_positives"].items():
        assert rate["low"] <= 0.05, name
    for bound, rates in found["equivalence"].items():
        assert rates["at_the_bound"]["low"] <= 0.05 and rates["any_of_four"]["low"] <= 0.05, bound
        assert set(rates["alike"]) == {"24", "48", "96", "144"}
    for name in ("friedman", "pair", "pair_alone"):
        planned, planted = found["planned"][name], found["planted"][name]
        assert planted["low"] <= planned["high"] and planned["low"] <= planted["high"], name
