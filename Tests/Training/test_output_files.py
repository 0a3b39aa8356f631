"""No output of a command is a file that it reads, a name in a file never chooses a path, and messages quote files
without their control characters."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from haptoflow_training.cli import main
from haptoflow_training.errors import InputError, printable
from haptoflow_training.recordings.native_recording import read_native
from haptoflow_training.whole_file import require_apart
from places import TRAINING

SCRIPT = "waypoints_metres = [[0.0, 0.0, 0.0], [0.1, 0.0, 0.0]]\nsegment_seconds = 1.0\n"


@pytest.mark.parametrize("spelling", ["script.toml", "./script.toml", "link.toml", "hard.toml", "here/script.toml"])
def test_a_command_does_not_overwrite_its_input_by_any_spelling(
    tmp_path: Path, spelling: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    script = Path("script.toml")
    script.write_text(SCRIPT, encoding="utf-8")
    Path("link.toml").symlink_to(script)
    Path("hard.toml").hardlink_to(script)
    Path("here").symlink_to(tmp_path, target_is_directory=True)
    assert main(["stroke", "--script", "script.toml", "--out", spelling]) == 3
    said = capsys.readouterr().err
    assert f"--out {Path(spelling)}: is the same file as script.toml, which the command reads" in said
    assert "name another file for --out" in said
    assert script.read_text(encoding="utf-8") == SCRIPT


def test_two_outputs_are_two_files_before_they_exist(tmp_path: Path) -> None:
    options = {"out": tmp_path / "a.json", "results": tmp_path / "b" / ".." / "a.json"}
    with pytest.raises(InputError, match="--out .*a.json: is the same file as .*, which the command writes, too"):
        require_apart(options)
    require_apart({"out": tmp_path / "a.json", "results": tmp_path / "b.json", "recordings": [tmp_path]})


@pytest.mark.parametrize("name", ["../secret.csv", "{folder}/secret.csv", "link.csv", "x/../../secret.csv"])
def test_a_motion_file_does_not_leave_the_folder_of_its_sidecar(tmp_path: Path, name: str) -> None:
    folder = tmp_path / "in"
    folder.mkdir()
    (tmp_path / "secret.csv").write_text("time_s,speed_mps\n", encoding="utf-8")
    (folder / "link.csv").symlink_to(tmp_path / "secret.csv")
    motion = name.replace("{folder}", str(tmp_path))
    (folder / "felt.json").write_text(json.dumps({"motion": motion}), encoding="utf-8")
    with pytest.raises(InputError, match="key 'motion' names .*, which is outside the folder of felt.json"):
        read_native(folder / "felt.csv", samples=False)


def test_control_characters_of_a_file_are_escaped_in_messages(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    script = tmp_path / "script.toml"
    script.write_text('"a\\u001b[31mb" = 1\n', encoding="utf-8")
    assert main(["stroke", "--script", str(script), "--out", str(tmp_path / "s.csv")]) == 3
    said = capsys.readouterr().err
    assert "unknown key 'a\\x1b[31mb'" in said
    assert "\x1b" not in said
    assert printable("caf\udce9\x07\x9b\né") == "caf\\udce9\\x07\\x9b\né"


# Of each package, those that it may not know.
ABOVE = {"haptoflow_training": ("haptoflow_benchmark", "haptoflow_paper"), "haptoflow_benchmark": ("haptoflow_paper",)}


@pytest.mark.parametrize("package", ABOVE)
def test_no_module_names_a_package_above_its_own(package: str) -> None:
    modules = sorted((TRAINING / package).rglob("*.py"))
    assert len(modules) > 10
    for path in modules:
        # The package's description says where the comparison is.
        beginning = r"^\s*(?:from|import) " if path.name == "__init__.py" else ""
        found = re.findall(f"{beginning}(?:{'|'.join(ABOVE[package])})", path.read_text(encoding="utf-8"), re.MULTILINE)
        assert not found, path.relative_to(TRAINING)


def _alone(tmp_path: Path, *words: str) -> subprocess.CompletedProcess[str]:
    """Python in a process of its own: other tests of this one import haptoflow_paper, which changes what is read."""
    return subprocess.run(
        [sys.executable, *words],
        cwd=tmp_path, env={**os.environ, "PYTHONPATH": str(TRAINING)}, capture_output=True, text=True, check=False,
        timeout=60,
    )  # fmt: skip


def test_the_training_program_refuses_a_row_of_the_evaluation_and_names_the_other_program(tmp_path: Path) -> None:
    config = TRAINING / "haptoflow_paper" / "configs" / "mean-flow.toml"
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
