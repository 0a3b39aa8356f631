"""Runs the commands of the studies' pages as printed, and checks the pages' figures, keys and columns."""

from __future__ import annotations

import json
import re
import shlex
from pathlib import Path

import pytest

from haptoflow_training.cli import main
from haptoflow_training.model_stamp import with_measured_words
from haptoflow_training.studies.delay_budget import page_words as budget_words, read_bench, read_lags
from haptoflow_training.studies.log_table import COLUMNS
from haptoflow_training.studies.session_file import KEYS

ROOT = Path(__file__).parents[2]
PAGES = ROOT / "Documentation~"
LOGS, ANALYSIS, BUDGET = (PAGES / f"{name}.md" for name in ("study-logs", "study-analysis", "delay-budget"))
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
        (LOGS, ["simulate", "simulate", "check", "merge", "analyse"]),
        (ANALYSIS, ["power", "power", "simulate", "simulate", "analyse", "validate"]),
        (BUDGET, ["budget", "budget"]),
    ],
)
def test_every_command_of_a_page_runs_in_its_order(
    page: Path, steps: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "Documentation~").mkdir()
    for name in (page.name, "benchmarks.md"):
        (tmp_path / "Documentation~" / name).write_bytes((PAGES / name).read_bytes())
    lags = tmp_path / "Training" / "results" / "default" / "stylus-lag.json"
    lags.parent.mkdir(parents=True)
    lags.write_bytes((ROOT / lags.relative_to(tmp_path)).read_bytes())
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
    named = set(re.findall(r"`([a-z0-9_]+)`", LOGS.read_text(encoding="utf-8")))
    for columns in COLUMNS.values():
        for column in columns:
            assert column.name in named, column.name
            assert set(column.words) <= named | {"turn-on", "turn-off"}
    for key in ("format", "version", *KEYS):
        assert key in named, key


def test_the_budget_page_shows_the_published_benchmark() -> None:
    page = BUDGET.read_text(encoding="utf-8")
    lags = read_lags(ROOT / "Training" / "results" / "default" / "stylus-lag.json")
    words = budget_words(read_bench(PAGES / "benchmarks.md"), "images/delay-budget.png", None, lags)
    assert page == with_measured_words(page, words), "write it anew: haptoflow-training study budget --page"
