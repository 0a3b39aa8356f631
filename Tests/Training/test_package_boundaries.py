"""haptoflow_benchmark builds on haptoflow_training, never the other way round."""

from __future__ import annotations

import ast
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

TRAINING = Path(__file__).parents[2] / "Training"
MODULES = sorted((TRAINING / "haptoflow_training").rglob("*.py"))


def _imported(tree: ast.AST) -> Iterator[tuple[int, str]]:
    """(line, name of the module) of each import statement, inside functions and type-checking blocks too."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from ((node.lineno, alias.name) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"line {node.lineno}: relative import; write the whole name of the package"
            yield node.lineno, str(node.module)


def test_the_training_package_has_modules_to_check() -> None:
    assert len(MODULES) > 100


@pytest.mark.parametrize("path", MODULES, ids=lambda path: str(path.relative_to(TRAINING)))
def test_no_module_of_the_training_package_imports_the_benchmark_package(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    found = [
        f"{path.relative_to(TRAINING)}:{line}: imports {name}"
        for line, name in _imported(ast.parse(text))
        if name.split(".")[0] == "haptoflow_benchmark"
    ]
    assert not found, "\n".join(found)
    assert "haptoflow_benchmark" not in text, "the training package names no module of the benchmark package"


@pytest.mark.parametrize(
    ("configuration", "part"),
    [("spsi", "architecture 'spsi'"), ("mean-flow", "objective 'average-velocity'"), ("reflow", "objective 'reflow'"),
     ("paper-codec", "representation")],
)  # fmt: skip
def test_the_training_program_refuses_a_row_of_the_benchmark_and_names_the_other_program(
    tmp_path: Path, configuration: str, part: str
) -> None:
    config = TRAINING / "haptoflow_paper" / "configs" / f"{configuration}.toml"
    words = ["train", "--config", str(config), "--out", str(tmp_path / "run")]
    # A process of its own: other tests of this one import haptoflow_benchmark, which registers the parts.
    ended = subprocess.run(
        [sys.executable, "-m", "haptoflow_training", *words],
        cwd=tmp_path, env={**os.environ, "PYTHONPATH": str(TRAINING)}, capture_output=True, text=True, check=False,
        timeout=60,
    )  # fmt: skip
    assert ended.returncode == 3, ended.stderr
    assert part in ended.stderr and "haptoflow-benchmark" in ended.stderr
    assert not any(tmp_path.iterdir())
