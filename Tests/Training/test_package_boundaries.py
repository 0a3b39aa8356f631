"""haptoflow_benchmark builds on haptoflow_training, never the other way round."""

from __future__ import annotations

import ast
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
