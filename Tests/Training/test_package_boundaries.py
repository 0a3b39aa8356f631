"""haptoflow_paper builds on haptoflow_benchmark, which builds on haptoflow_training, never the other way round."""

from __future__ import annotations

import ast
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

TRAINING = Path(__file__).parents[2] / "Training"
# Of each package, those that it may not know.
ABOVE = {
    "haptoflow_training": ("haptoflow_benchmark", "haptoflow_paper"),
    "haptoflow_benchmark": ("haptoflow_paper",),
}
MODULES = [(package, path) for package in ABOVE for path in sorted((TRAINING / package).rglob("*.py"))]


def _imported(tree: ast.AST) -> Iterator[tuple[int, str]]:
    """(line, name of the module) of each import statement, inside functions and type-checking blocks too."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from ((node.lineno, alias.name) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"line {node.lineno}: relative import; write the whole name of the package"
            yield node.lineno, str(node.module)


def test_each_package_has_modules_to_check() -> None:
    counts = {package: sum(found == package for found, _ in MODULES) for package in ABOVE}
    assert counts["haptoflow_training"] > 100 and counts["haptoflow_benchmark"] > 20


@pytest.mark.parametrize(("package", "path"), MODULES, ids=lambda value: str(value).removeprefix(f"{TRAINING}/"))
def test_no_module_names_a_package_above_its_own(package: str, path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    found = [
        f"{path.relative_to(TRAINING)}:{line}: imports {name}"
        for line, name in _imported(ast.parse(text))
        if name.split(".")[0] in ABOVE[package]
    ]
    assert not found, "\n".join(found)
    # The package's description says where the comparison is.
    if path.name != "__init__.py":
        assert not [above for above in ABOVE[package] if above in text]


def _alone(tmp_path: Path, *words: str) -> subprocess.CompletedProcess[str]:
    """Python in a process of its own: other tests of this one import haptoflow_paper, which changes what is read."""
    return subprocess.run(
        [sys.executable, *words],
        cwd=tmp_path, env={**os.environ, "PYTHONPATH": str(TRAINING)}, capture_output=True, text=True, check=False,
        timeout=60,
    )  # fmt: skip


@pytest.mark.parametrize("configuration", ["spsi", "mean-flow", "paper-codec"])
def test_the_training_program_refuses_a_row_of_the_evaluation_and_names_the_other_program(
    tmp_path: Path, configuration: str
) -> None:
    config = TRAINING / "haptoflow_paper" / "configs" / f"{configuration}.toml"
    ended = _alone(tmp_path, "-m", "haptoflow_training", "train", "--config", str(config), "--out", "run")
    assert ended.returncode == 3, ended.stderr
    assert "unknown key '" in ended.stderr and "haptoflow-paper" in ended.stderr
    assert not any(tmp_path.iterdir())


_CHECK = """
import sys
from pathlib import Path
from haptoflow_training.training.config import TrainingConfig, config_from_dict, config_of_run, load_config

for path in sys.argv[1:]:
    assert type(load_config(Path(path))) is TrainingConfig

old = {
    "model": {"architecture": "unet", "patch": 8, "representation": {"kind": "raw"}, "ribs": False, "width": 48},
    "optimiser": {"budget_seconds": 0.0}, "recipe": {"objective": "flow"}, "solver": {"kind": "midpoint", "steps": 2},
}
assert config_of_run(old, Path("checkpoint.pt")) == config_from_dict({"model": {"width": 48}}, Path("own.toml"))
"""


def test_the_product_alone_reads_its_configurations_and_old_checkpoints_and_has_no_key_of_the_evaluation(
    tmp_path: Path,
) -> None:
    shipped = [str(path) for path in (TRAINING / "configs").rglob("*.toml") if path.name not in
               ("labels-cluster.toml", "materials.toml")]  # fmt: skip
    assert len(shipped) >= 8
    ended = _alone(tmp_path, "-c", _CHECK, *shipped)
    assert ended.returncode == 0, ended.stderr
