"""Parallel trainings: at most the given number, none left behind, failures named."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from haptoflow_training.errors import InputError
from haptoflow_training.training.processes import Job, run_jobs

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
        "import sys\nfrom pathlib import Path\nfrom haptoflow_training.training.job_lanes import Job, run_jobs\n"
        f"folder = Path({str(tmp_path)!r})\n"
        f"words = ({_CAREFUL!r}, str(folder), 'job', '60')\n"
        "run_jobs([Job('job', words, folder / 'log', folder / 'job', program=(sys.executable, '-c'))], 1)\n"
    )
    training = Path(__file__).resolve().parents[2] / "Training"
    process = subprocess.Popen([*_PYTHON, parent], env={**os.environ, "PYTHONPATH": str(training)})
    end = time.monotonic() + 30.0
    while not (tmp_path / "job.began").exists() and time.monotonic() < end:
        time.sleep(0.05)
    process.send_signal(signal.SIGTERM)
    assert process.wait(30.0) != 0
    assert (tmp_path / "job.stopped").exists()
