"""Runs the commands of "A new material from ten seconds, in Python" as printed on the page."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from own_samples import csv_one_axis, stroke
from test_few_shot_study import stored

from haptoflow_paper.few_shot.few_shot_cases import SECONDS
from haptoflow_benchmark import cli as benchmark
from haptoflow_paper import cli as paper
from haptoflow_training import cli as training

ROOT = Path(__file__).parents[2]
DEFAULT = ROOT / "Packages" / "com.haptoflow.runtime" / "Runtime" / "Models" / "default.haptoflow"
PAGE = ROOT / "Documentation~" / "own-materials.md"
HEADING = "## A new material from ten seconds, in Python"

PROGRAMS = {
    "haptoflow-benchmark": benchmark.main, "haptoflow-paper": paper.main, "haptoflow-training": training.main,
}  # fmt: skip


def commands() -> list[list[str]]:
    """The words of each command on the page, its program first."""
    section = PAGE.read_text(encoding="utf-8").split(HEADING, 1)[1].split("\n## ", 1)[0]
    blocks = re.findall(r"^```\n(.*?)^```", section, re.DOTALL | re.MULTILINE)
    lines = [line.split() for block in blocks for line in block.splitlines()]
    return [words for words in lines if words[:1] and words[0] in PROGRAMS]


def test_every_command_of_the_page_runs_and_writes_what_it_names(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    csv_one_axis(tmp_path, "doormat", "doormat", stroke(4.0))
    (tmp_path / "default.haptoflow").symlink_to(DEFAULT)
    work = tmp_path / "work"
    work.mkdir()
    made = {name: {**stored(name, False), "filtered": name == "filtered-01"} for name in ("unseen-01", "filtered-01")}
    for name, cells in made.items():
        (work / f"{name}.json").write_text(json.dumps(cells), encoding="utf-8")
    trained = {name: cells["rows"]["learn 10"] for name, cells in made.items()}
    for seconds in SECONDS:
        (work / f"trained-{seconds:g}.json").write_text(json.dumps(trained), encoding="utf-8")
    ran = set()
    for program, *words in commands():
        quick = {
            "add-material": ["--seconds-limit", "1"],
            "sliders": [],
            "measure-wave-vectors": ["--every", "60"],
            # The slow cells are stored already.
            "few-shot": ["--materials", "1", "--work", str(work)],
        }[words[0]]
        assert PROGRAMS[program]([*words, *quick]) == 0, words
        ran.add(words[0])
        for before, named in zip(words[:-1], words[1:], strict=True):
            if before in ("-o", "--results", "--chart"):
                assert (tmp_path / named).stat().st_size > 0
    assert ran == {"add-material", "sliders", "few-shot", "measure-wave-vectors"}
    assert (tmp_path / "doormat.haptomaterial").exists()
    assert "trained 10" in (tmp_path / "few-shot.json").read_text(encoding="utf-8")
    assert "learn 10" in (tmp_path / "few-shot.json").read_text(encoding="utf-8")
