"""Runs the commands of the studies' pages as printed, and checks the pages' figures, keys and columns."""

from __future__ import annotations

import json
import re
import shlex
from collections import Counter
from pathlib import Path

import pytest

from haptoflow_training.cli import main
from haptoflow_training.model_stamp import with_measured_words
from haptoflow_training.studies.bench_figures import read_bench
from haptoflow_training.studies.delay_budget import page_words as budget_words
from haptoflow_training.studies.delay_budget import read_lags
from haptoflow_training.studies.log_columns import COLUMNS
from haptoflow_training.studies.plans import latency_plan, similarity_plan
from haptoflow_training.studies.shaffer import factors
from haptoflow_training.studies.sidecar_file import KEYS
from haptoflow_training.studies.simulated_participants import LEVELS_MS, MATERIALS, METHODS
from haptoflow_training.studies.validation_words import page_words as validation_words

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


def test_the_page_states_the_counterbalancing_of_the_plans() -> None:
    text = " ".join(LOGS.read_text(encoding="utf-8").split())
    materials: Counter[tuple[str, int]] = Counter()
    methods: Counter[tuple[str, str, int]] = Counter()
    levels: Counter[tuple[str, float, int]] = Counter()
    for participant in range(1, 25):
        trials = [trial for trial in similarity_plan(participant, 1, MATERIALS, METHODS) if trial.block == "main"]
        materials.update((trial.material, place) for place, trial in enumerate(trials[::4]))
        methods.update((trial.material, trial.method, place % 4) for place, trial in enumerate(trials))
        answered = [trial for trial in latency_plan(participant, 1, LEVELS_MS) if trial.block == "main"]
        levels.update((trial.condition, trial.delay_ms, place % 11) for place, trial in enumerate(answered))
    assert (len(materials), len(methods), len(levels)) == (6 * 6, 6 * 4 * 4, 2 * 11 * 11)
    (of_materials,), (of_methods,) = set(materials.values()), set(methods.values())
    assert f"each of six materials stands at each place exactly {of_materials} times" in text
    assert f"at each place of each material exactly {of_methods} times" in text
    assert f"of a condition's block {min(levels.values())} to {max(levels.values())} times" in text
    twice, three, four = (list(levels.values()).count(times) for times in (2, 3, 4))
    combinations = f"of the {len(levels)} combinations of condition, level and place"
    assert f"{combinations}, {twice} come twice, {three} three times, {four} four times" in text


def test_the_budget_page_shows_the_published_benchmark() -> None:
    page = BUDGET.read_text(encoding="utf-8")
    lags = read_lags(ROOT / "Training" / "results" / "default" / "stylus-lag.json")
    words = budget_words(read_bench(PAGES / "benchmarks.md"), "images/delay-budget.png", None, lags)
    assert page == with_measured_words(page, words), "write it anew: haptoflow-training study budget --page"


def test_the_analysis_page_shows_the_committed_validation_and_the_factors() -> None:
    page = ANALYSIS.read_text(encoding="utf-8")
    found = json.loads((ROOT / "Training" / "results" / "study-validation.json").read_text(encoding="utf-8"))
    assert found["studies"] >= 200 and found["simulations"] >= 1000
    assert page == with_measured_words(page, validation_words(found)), "write it anew: study validate --page"
    text = " ".join(page.split())
    for methods in (4, 5, 6):
        assert ", ".join(map(str, factors(methods))) in text


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


def test_each_page_is_linked_where_pages_are_listed() -> None:
    index = (PAGES / "index.md").read_text(encoding="utf-8")
    for page in (LOGS, ANALYSIS, BUDGET):
        assert f"({page.name})" in index, page.name
        for target in re.findall(r"\]\(([\w/.-]+\.(?:md|png))\)", page.read_text(encoding="utf-8")):
            assert (PAGES / target).exists(), (page.name, target)
