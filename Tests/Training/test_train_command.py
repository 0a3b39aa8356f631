"""`train` as a process: two at once, stopped and killed at several moments, refused before recordings are prepared."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest
import torch

from haptoflow_training.cli import main
from haptoflow_training.errors import InputError
from haptoflow_training.preprocessing.store import store_lock
from haptoflow_training.training.processes import Job, run_jobs
from places import TRAINING

CONFIGURATION = """
name = "small"
threads = 1
[data]
source = "synthetic"
labels = ["wood"]
machine_directions = [0]
machine_speeds_mmps = [40]
machine_forces_millinewtons = [500]
hand_recordings_per_label = 8
hand_duration_seconds = {hand_seconds}
[model]
hidden = [16, 16]
[optimiser]
batch_size = 8
level_steps = 20
steps = {steps}
level_polish_steps = 10
warm_up_steps = 5
"""


def started(folder: Path, name: str, *more: str, steps: int = 20, hand_seconds: float = 4.0) -> subprocess.Popen[str]:
    config = folder / f"{name}.toml"
    config.write_text(CONFIGURATION.format(steps=steps, hand_seconds=hand_seconds), encoding="utf-8")
    words = ["train", "--config", str(config), "--out", str(folder / name), "--store", str(folder / "store"), *more]
    environment = {**os.environ, "PYTHONPATH": str(TRAINING), "OPENBLAS_NUM_THREADS": "1"}
    return subprocess.Popen(
        [sys.executable, "-m", "haptoflow_training", *words], env=environment, text=True,
        stdout=subprocess.PIPE, stderr=subprocess.PIPE,
    )  # fmt: skip


def wait_for(process: subprocess.Popen[str], happened: Callable[[], bool]) -> None:
    end = time.monotonic() + 120.0
    while not happened():
        assert process.poll() is None and time.monotonic() < end, process.communicate()
        time.sleep(0.02)


def children_of(process: int) -> list[int]:
    return [int(word) for word in Path(f"/proc/{process}/task/{process}/children").read_text().split()]


def is_running(process: int) -> bool:
    try:
        return Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except FileNotFoundError:
        return False


def test_a_training_that_is_killed_while_preparing_leaves_no_worker_and_no_lock(tmp_path: Path) -> None:
    killed = started(tmp_path, "killed", hand_seconds=60.0)
    wait_for(killed, lambda: (tmp_path / "store.unfinished").exists() and len(children_of(killed.pid)) >= 2)
    workers = children_of(killed.pid)
    killed.kill()
    killed.wait()
    end = time.monotonic() + 30.0
    while any(is_running(worker) for worker in workers) and time.monotonic() < end:
        time.sleep(0.05)
    assert not [worker for worker in workers if is_running(worker)]
    again = started(tmp_path, "again")
    _, said = again.communicate(timeout=240)
    assert again.returncode == 0 and "waiting" not in said, said


def test_a_training_that_is_stopped_between_steps_exits_with_an_error_and_goes_on_from_there(tmp_path: Path) -> None:
    export = tmp_path / "own.haptoflow"
    process = started(tmp_path, "run", "--export", str(export), steps=150)
    log = tmp_path / "run" / "metrics.csv"
    wait_for(process, lambda: log.exists() and len(log.read_text().splitlines()) > 1)
    process.send_signal(signal.SIGTERM)
    _, said = process.communicate(timeout=60)
    assert process.returncode == 143 and not export.exists()
    step = torch.load(tmp_path / "run" / "checkpoint.pt")["step"]
    expected = "no model is written yet; run the same command again to go on from there"
    assert f"stopped at step {step} of 180, {expected}" in said
    again = started(tmp_path, "run", "--export", str(export), steps=150)
    _, said = again.communicate(timeout=240)
    assert again.returncode == 0 and export.exists(), said


@pytest.mark.parametrize(
    ("words", "configuration", "said"),
    [
        (["--minutes", "1"], "", "--minutes works with one process only"),
        ([], "[optimiser]\nbudget_seconds = 60", "optimiser.budget_seconds works with one process only"),
        ([], "[recipe]\nshares_base = true", "--base FOLDER and recipe.shares_base = true go together"),
    ],
)
def test_a_run_that_cannot_begin_is_refused_before_recordings_are_prepared(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], words: list[str],
    configuration: str, said: str,
) -> None:  # fmt: skip
    import importlib
    from contextlib import contextmanager

    from haptoflow_training.commands import train
    from haptoflow_training.training.processes import Processes

    @contextmanager
    def two_processes():  # type: ignore[no-untyped-def]
        yield Processes(rank=0, count=1 if "shares_base" in configuration else 2)

    def refused(*arguments: object) -> None:
        raise AssertionError("recordings were prepared")

    # A budget is a key of the evaluation's configurations.
    importlib.import_module("haptoflow_paper")
    monkeypatch.setattr(train, "join_processes", two_processes)
    monkeypatch.setattr(train, "open_source", refused)
    (tmp_path / "run.toml").write_text(f'name = "run"\n{configuration}\n', encoding="utf-8")
    assert main(["train", "--config", str(tmp_path / "run.toml"), "--out", str(tmp_path / "out"), *words]) == 3
    assert said in capsys.readouterr().err and not (tmp_path / "out").exists()


def test_a_lock_is_held_by_one_program_at_a_time_and_leaves_no_file(tmp_path: Path) -> None:
    holder = (
        "import sys\nfrom pathlib import Path\nfrom haptoflow_training.preprocessing.store import store_lock\n"
        f"with store_lock(Path({str(tmp_path / 'store')!r})):\n"
        "    print('held', flush=True)\n    sys.stdin.readline()\n"
    )
    other = subprocess.Popen(
        [sys.executable, "-c", holder], env={**os.environ, "PYTHONPATH": str(TRAINING)}, text=True,
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
    )  # fmt: skip
    assert other.stderr is not None and other.stdout is not None
    with store_lock(tmp_path / "store"):
        if not other.stderr.readline().startswith("waiting: another program prepares"):
            pytest.fail("it did not wait")
    assert other.stdout.readline() == "held\n"
    assert (tmp_path / "store.lock").exists()
    other.communicate("\n", timeout=30)
    assert other.returncode == 0 and not (tmp_path / "store.lock").exists()


_PYTHON = (sys.executable, "-c")
# Writes that it began, waits, writes its product; when terminated, it writes that too.
_CAREFUL = """
import pathlib, signal, sys, time
folder, name, seconds = pathlib.Path(sys.argv[1]), sys.argv[2], float(sys.argv[3])
def stop(number, frame):
    (folder / f"{name}.stopped").touch()
    sys.exit(1)
signal.signal(signal.SIGTERM, stop)
(folder / f"{name}.began").touch()
time.sleep(seconds)
(folder / name).touch()
"""


def _careful(folder: Path, name: str, seconds: float) -> Job:
    words = [_CAREFUL, str(folder), name, str(seconds)]
    return Job(name, words, folder / f"{name}.log", folder / name, program=_PYTHON)


def test_no_more_jobs_run_at_a_time_than_there_are_lanes_and_progress_counts_them_all(tmp_path: Path) -> None:
    jobs = [_careful(tmp_path, f"job{number}", 0.3) for number in range(5)]
    most, heard = 0, []

    def progress(finished: int) -> None:
        nonlocal most
        heard.append(finished)
        most = max(most, len(list(tmp_path.glob("*.began"))) - finished)

    run_jobs(jobs, 2, progress)
    assert most <= 2 and heard == sorted(heard) and heard[-1] == 5
    assert all(job.product.exists() for job in jobs)


@pytest.mark.parametrize("program", ["raise SystemExit(3)", "print('ended well, made nothing')"])
def test_a_failing_job_is_named_with_its_log_and_the_others_are_terminated(tmp_path: Path, program: str) -> None:
    waits = f"import pathlib, time\nwhile not pathlib.Path({str(tmp_path / 'long.began')!r}).exists(): time.sleep(0.05)\n"
    failing = Job("failing", (waits + program,), tmp_path / "logs" / "failing.log", tmp_path / "never", program=_PYTHON)
    with pytest.raises(InputError, match=r"failing: .*failing\.log says why"):
        run_jobs([_careful(tmp_path, "long", 60.0), failing], 2)
    assert (tmp_path / "long.stopped").exists()


def test_terminating_the_parent_terminates_its_jobs(tmp_path: Path) -> None:
    parent = (
        "import sys\nfrom pathlib import Path\nfrom haptoflow_training.training.processes import Job, run_jobs\n"
        f"folder = Path({str(tmp_path)!r})\n"
        f"words = ({_CAREFUL!r}, str(folder), 'job', '60')\n"
        "run_jobs([Job('job', words, folder / 'log', folder / 'job', program=(sys.executable, '-c'))], 1)\n"
    )
    process = subprocess.Popen([*_PYTHON, parent], env={**os.environ, "PYTHONPATH": str(TRAINING)})
    end = time.monotonic() + 30.0
    while not (tmp_path / "job.began").exists() and time.monotonic() < end:
        time.sleep(0.05)
    process.send_signal(signal.SIGTERM)
    assert process.wait(30.0) != 0
    assert (tmp_path / "job.stopped").exists()
