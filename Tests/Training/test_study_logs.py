"""Study logs: accepted and refused files, the named places of errors, and the merged tables."""

from __future__ import annotations

import csv
import json
import shutil
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path

import pytest
from study_samples import change_field, change_lines, change_sidecar, latency_study, log_of, similarity_study

from haptoflow_training.cli import main
from haptoflow_training.errors import InputError
from haptoflow_training.studies.log_table import COLUMNS
from haptoflow_training.studies.plans import latency_plan, similarity_plan
from haptoflow_training.studies.session_file import read_faultless, read_folder, read_session
from haptoflow_training.studies.analysis import listed_names

SESSIONS = Path(__file__).parents[1] / "Golden" / "studies"


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return similarity_study(latency_study(tmp_path_factory.mktemp("made") / "logs"))


@pytest.fixture
def logs(made: Path, tmp_path: Path) -> Path:
    shutil.copytree(made, tmp_path / "logs")
    return tmp_path / "logs"


def problems(folder: Path) -> list[str]:
    return [str(problem) for problem in read_folder(folder).problems]


@pytest.mark.parametrize(
    ("row", "column", "value", "said"),
    [
        (3, "answer", "maybe", "row 3, column answer: 'maybe' is not yes or no"),
        (3, "answer", "", "row 3, column answer: it is empty"),
        (5, "delay_ms", "abc", "row 5, column delay_ms: 'abc' is not a number"),
        (5, "response_seconds", "nan", "row 5, column response_seconds: 'nan' is not a number"),
        (5, "response_seconds", "1e999", "row 5, column response_seconds: '1e999' is not a number"),
        (5, "response_seconds", "-1", "column response_seconds: -1 is out of range; expected 0 or more"),
        (6, "artificial_delay_ms", "-4", "column artificial_delay_ms: -4 is out of range"),
        (6, "delivered_delay_ms", "999", "column delivered_delay_ms: 999 is not the sum of system and artificial"),
        (7, "delay_ms", "51", "row 7, column delay_ms: 51.0; the plan of trial 6 says"),
        (7, "condition", "turn-up", "column condition: 'turn-up' is not turn-on or turn-off"),
        (7, "block", "practice", 'column block: "practice"; the plan of trial 6 says "main"'),
        (8, "trial", "6", "row 8, column trial: trial 6 stands in row 7 already"),
        (8, "trial", "99", "row 8, column trial: trial 99 is not in the plan of 26 trials"),
        (8, "trial", "7.0", "row 8, column trial: '7.0' is not a whole number"),
        (8, "attempt", "0", "column attempt: 0 is out of range; expected 1 or more"),
        (9, "elapsed_seconds", "0.5", "row 9, column elapsed_seconds: 0.5 is earlier than the row before"),
    ],
)
def test_a_broken_field_is_named_by_file_row_and_column(
    logs: Path, row: int, column: str, value: str, said: str
) -> None:
    path = log_of(logs, 2)
    change_field(path, row, column, value)
    found = problems(logs)
    assert any(line.startswith(f"{path}: ") and said in line for line in found), found
    assert all(line.startswith(f"{path}: ") for line in found)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda lines: [*lines[:10], *lines[11:]], "finished, but without trial 10 of the plan"),
        (lambda lines: [*lines[:4], *lines[7:]], "finished, but without trial 4 to 6 of the plan"),
        (lambda lines: [*lines[:10], lines[9], *lines[10:]], "row 11, column trial: trial 9 stands in row 10 already"),
        (lambda lines: [*lines[:9], lines[10], lines[9], *lines[11:]], "trial 9 comes after trial 10"),
        (lambda lines: [*lines[:5], lines[5] + ",7", *lines[6:]], "row 6: 19 fields; expected 18"),
        (lambda lines: [*lines[:5], "", *lines[5:]], "row 6: 0 fields; expected 18"),
        (lambda lines: lines[1:], "row 1, column trial: missing"),
        (lambda lines: [lines[0].replace("answer", "reply"), *lines[1:]], "row 1, column answer: missing"),
        (lambda lines: [lines[0].replace("answer", "reply"), *lines[1:]], "row 1, column reply: not a column"),
        (lambda lines: [line.replace(",", ";") for line in lines], "not separated by commas"),
        (lambda lines: [*lines[:5], 'a "b" ' + lines[5], '"never closed'], "row 7: not CSV"),
    ],
)
def test_missing_duplicate_and_misordered_rows_are_named(
    logs: Path, change: Callable[[list[str]], list[str]], said: str
) -> None:
    path = log_of(logs, 2)
    change_lines(path, change)
    found = problems(logs)
    assert any(line.startswith(str(path)) and said in line for line in found), found


def test_a_row_cut_off_by_a_crash_is_named_and_the_session_is_unfinished(logs: Path) -> None:
    path = log_of(logs, 2)
    content = path.read_bytes()
    path.write_bytes(content[: content.rindex(b",")])
    change_sidecar(path, lambda sidecar: sidecar | {"finished": False})
    found = problems(logs)
    assert found == [f"{path}: row 27: half-written, as by a crash; resume the session, which asks its trial again"]
    path.write_bytes(content[: content.rindex(b"\n", 0, -1) + 1])
    assert problems(logs) == [f"{path}: unfinished: trial 26 of 26 missing; resume the session, or take its files out"]


@pytest.mark.parametrize("content", [b"", b"\xff\xfe\x00", b"\x00\x00\x00\n", b"\n\n\n", b'"' * 400_000 + b"\n"])
def test_bytes_that_are_not_a_table_are_reported_as_a_problem(logs: Path, content: bytes) -> None:
    path = log_of(logs, 1)
    path.write_bytes(content)
    assert any(line.startswith(str(path)) for line in problems(logs))


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "not valid JSON"),
        ("[]", "no sidecar of a study"),
        ("{", "not valid JSON"),
        ("[" * 100_000, "not valid JSON"),
        ('{"format": "haptoflow-study", "version": 2}', "version 2 of the format; this program reads version 1"),
        ('{"format": "haptoflow-study", "version": 1}', "key 'plan' is missing"),
        ('{"format": "haptoflow-study", "version": NaN}', "NaN is not a number of JSON"),
        ('{"format": "haptoflow-study", "format": "x"}', "key 'format' stands twice"),
    ],
)
def test_an_invalid_sidecar_is_named(logs: Path, text: str, said: str) -> None:
    path = log_of(logs, 1).with_suffix(".json")
    path.write_text(text, encoding="utf-8")
    assert any(line.startswith(str(path)) and said in line for line in problems(logs)), problems(logs)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"participant": 9}, "key 'participant' is 9; the file's name says 1"),
        ({"study": "similarity"}, "key 'plan', entry 1: 'material' is missing"),
        ({"study": "taste"}, "key 'study' is \"taste\"; expected latency or similarity"),
        ({"session": "00000000"}, "key 'session' is \"00000000\"; the file's name says"),
        ({"participant": "1"}, "key 'participant' is \"1\"; expected a whole number"),
        ({"simulated": 1}, "key 'simulated' is 1; expected true or false"),
        ({"plan": []}, "key 'plan' has no trial"),
        ({"plan": [{"trial": 1}]}, "key 'plan', entry 1: 'block' is missing"),
        ({"plan": [3]}, "key 'plan', entry 1: 'trial' is missing"),
        (
            {"plan": [{"trial": 2, "block": "main", "condition": "turn-on", "delay_ms": 50}]},
            "key 'plan', entry 1: 'trial' is 2; expected 1",
        ),
        (
            {"plan": [{"trial": 1, "block": "main", "condition": "turn-on", "delay_ms": "50"}]},
            "key 'plan', entry 1, 'delay_ms': \"50\" is not a number",
        ),
        ({"device": {}}, "key 'device.device_delay_source' is null; expected measured or estimated"),
        ({"finished": False}, "every trial is there, but the sidecar does not say that the session ended"),
    ],
)
def test_a_sidecar_that_contradicts_its_log_is_named(logs: Path, change: dict[str, object], said: str) -> None:
    change_sidecar(log_of(logs, 1), lambda sidecar: sidecar | change)
    assert any(said in line for line in problems(logs)), problems(logs)


def test_one_file_without_the_other_is_named(logs: Path) -> None:
    first, second = log_of(logs, 1), log_of(logs, 2).with_suffix(".json")
    first.unlink()
    second.unlink()
    assert sorted(problems(logs)) == [
        f"{first}: the log is missing; a session is a .csv and a .json of one name",
        f"{second}: the sidecar is missing; a session is a .csv and a .json of one name",
    ]


def test_a_copy_under_another_name_is_not_a_second_session(logs: Path) -> None:
    path = log_of(logs, 1)
    copy = path.with_name(f"{path.stem} (1).csv")
    shutil.copy(path, copy)
    assert problems(logs) == [
        f"{copy}: not named as a session, STUDY-PARTICIPANT-SESSION, for example latency-P07-1a2b3c4d; take it out"
    ]


def test_a_copy_in_another_folder_is_named_as_the_same_rows(logs: Path) -> None:
    (logs / "backup").mkdir()
    for path in logs.glob("latency-P01-*"):
        shutil.copy(path, logs / "backup" / path.name)
    assert any("the same rows as" in line for line in problems(logs))


def test_two_sessions_of_one_participant_are_refused(logs: Path, tmp_path: Path) -> None:
    other = latency_study(tmp_path / "other", participants=1, seed=5)
    for path in other.glob("latency-P01-*"):
        shutil.copy(path, logs / path.name)
    found = problems(logs)
    assert len(found) == 1 and "a second session of participant 1 in the latency study, beside latency-P01-" in found[0]


def test_simulated_and_real_logs_are_never_read_together(logs: Path) -> None:
    for study in ("latency", "similarity"):
        for participant in (2, 3):
            change_sidecar(log_of(logs, participant, study), lambda sidecar: sidecar | {"simulated": False})
    found = problems(logs)
    assert len(found) == 2
    assert all("-P01-" in line.split(": ")[0] and "simulated, beside the real" in line for line in found)


def test_differences_between_sessions_are_noted_but_no_problem(logs: Path) -> None:
    change_sidecar(log_of(logs, 2), lambda sidecar: sidecar | {"seed": 8, "models": [{"method": "a"}]})
    read = read_folder(logs)
    assert read.problems == []
    assert any(note.startswith("latency: 2 different values of 'seed'") for note in read.notes)
    assert any(note.startswith("latency: 2 different values of 'models'") for note in read.notes)
    assert any("the device delay of 3 of 3 sessions is an estimate" in note for note in read.notes)


def test_faulty_logs_are_refused_with_every_place_named_up_to_twenty(logs: Path) -> None:
    shortened = {",yes,": ",y,", ",no,": ",n,"}
    for answer, letter in shortened.items():
        change_lines(log_of(logs, 1), lambda lines, old=answer, new=letter: [line.replace(old, new) for line in lines])
    with pytest.raises(InputError) as refused:
        read_faultless(logs)
    words = str(refused.value)
    assert words.count("column answer") == 20 and "and 6 further problems: `haptoflow-training study check" in words


def test_check_ends_with_zero_for_good_logs_and_three_for_bad_ones(
    logs: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["study", "check", str(logs)]) == 0
    assert "latency: 3 sessions, 3 of them simulated, 78 answered trials" in capsys.readouterr().out
    change_field(log_of(logs, 2), 3, "answer", "maybe")
    assert main(["study", "check", str(logs)]) == 3
    assert "1 problem\n" in capsys.readouterr().out


def test_a_missing_or_empty_folder_is_reported_in_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for folder, said in ((tmp_path / "gone", "no folder"), (tmp_path, "no log of a study in it")):
        assert main(["study", "check", str(folder)]) == 3
        assert said in capsys.readouterr().err


def test_merge_writes_one_tidy_table_for_each_study(logs: Path, tmp_path: Path) -> None:
    assert main(["study", "merge", str(logs), "--out", str(tmp_path / "tables")]) == 0
    for study, trials in (("latency", 26), ("similarity", 9)):
        with (tmp_path / "tables" / f"{study}.csv").open(encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        assert len(rows) == 3 * trials
        assert list(rows[0]) == ["participant", "session", "simulated", *(column.name for column in COLUMNS[study])]
        assert {row["participant"] for row in rows} == {"1", "2", "3"} and {row["simulated"] for row in rows} == {"1"}
        own = log_of(logs, 2, study).read_text(encoding="utf-8").splitlines()[1:]
        merged = [",".join(list(row.values())[3:]) for row in rows if row["participant"] == "2"]
        assert merged == own


def test_merge_refuses_faulty_logs_and_a_place_among_the_logs(
    logs: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for out in (logs, logs / "tables"):
        assert main(["study", "merge", str(logs), "--out", str(out)]) == 3
        assert "lies in the folder of the logs" in capsys.readouterr().err
    change_field(log_of(logs, 2), 3, "answer", "maybe")
    assert main(["study", "merge", str(logs), "--out", str(tmp_path / "tables")]) == 3
    assert "row 3, column answer" in capsys.readouterr().err and not (tmp_path / "tables").exists()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--participants", "0"], "--participants 0: expected 1 to 999"),
        (["--seed", "-1"], "--seed -1: expected 0"),
        (["--difference", "nan"], "--difference nan: expected 0 to 5"),
    ],
)
def test_numbers_that_are_invalid_for_a_study_are_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], words: list[str], said: str
) -> None:
    assert main(["study", "simulate", "--study", "similarity", "--out", str(tmp_path / "x"), *words]) == 3
    assert said in capsys.readouterr().err and not (tmp_path / "x").exists()


def test_the_same_seed_simulates_the_same_answers(tmp_path: Path) -> None:
    first, second = (latency_study(tmp_path / name, 2, 9) for name in ("a", "b"))
    for path in sorted(first.glob("*.csv")):
        assert path.read_bytes() == (second / path.name).read_bytes()


@pytest.mark.parametrize("path", sorted(SESSIONS.glob("*.csv")), ids=lambda path: path.stem)
def test_a_session_as_the_unity_samples_write_it_is_read_whole_with_its_interrupted_trial(path: Path) -> None:
    session, found = read_session(path)
    assert found == [] and session is not None
    assert len(session.rows) == len(session.sidecar["plan"]) and session.sidecar["resumptions"] == 1
    assert [row["attempt"] for row in session.rows].count(2) == 1
    plan = session.sidecar["plan"]
    if session.study == "latency":
        levels = session.sidecar["settings"]["levels_ms"]
        expected = [asdict(trial) for trial in latency_plan(session.participant, session.sidecar["seed"], levels)]
    else:
        materials, methods = (listed_names(session.sidecar["settings"], key) for key in ("materials", "methods"))
        plan_of = similarity_plan(session.participant, session.sidecar["seed"], materials, methods)
        expected = [asdict(trial) for trial in plan_of]
    assert plan == expected
