"""No output of a command is a file that it reads, a name in a file never chooses a path, and messages quote files
without their control characters."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from haptoflow_training.cli import main
from haptoflow_training.errors import InputError, printable
from haptoflow_training.recordings.native_recording import read_native
from haptoflow_training.whole_file import require_apart

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
