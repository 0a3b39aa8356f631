"""Runs several trainings at a time, each a process of its own with a log of its own.

concurrent.futures runs functions of this process; trainings are whole commands that must end and resume on their own.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from haptoflow_training.errors import InputError

_POLL_SECONDS = 0.2


@dataclass(frozen=True, eq=False)
class Job:
    """words: arguments of `program`. log: the file to which its output is appended. product: a file that exists when
    the job is done. folder: working directory, to which relative paths of the configuration refer; None for that of
    this process."""

    name: str
    words: Sequence[str]
    log: Path
    product: Path
    folder: Path | None = None
    program: Sequence[str] = (sys.executable, "-m", "haptoflow_training")


def run_jobs(jobs: Sequence[Job], lanes: int, progress: Callable[[int], None] = lambda finished: None) -> None:
    """Run jobs in order, `lanes` at a time; `progress` is called regularly with the number of finished jobs.

    InputError names job and log if one fails or leaves no product. Then, and when this process is terminated, the other
    jobs are terminated and awaited, so that they can be resumed.
    """
    waiting = list(jobs)
    finished = 0
    running: dict[Job, subprocess.Popen[bytes]] = {}
    # Without a handler, terminating this process would leave its trainings running.
    before = signal.signal(signal.SIGTERM, lambda number, frame: sys.exit(128 + number))
    try:
        while waiting or running:
            while waiting and len(running) < lanes:
                job = waiting.pop(0)
                running[job] = _start(job)
            time.sleep(_POLL_SECONDS)
            for job, process in list(running.items()):
                if process.poll() is None:
                    continue
                del running[job]
                if process.returncode != 0 or not job.product.exists():
                    raise InputError(f"{job.name}: training stopped; {job.log} says why; run the command again to go on")
                finished += 1
            progress(finished)
    finally:
        for process in running.values():
            process.terminate()
        for process in running.values():
            process.wait()
        signal.signal(signal.SIGTERM, before)


def _start(job: Job) -> subprocess.Popen[bytes]:
    job.log.parent.mkdir(parents=True, exist_ok=True)
    environment: Mapping[str, str] = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
    with job.log.open("ab") as log:
        return subprocess.Popen(
            [*job.program, *job.words], stdout=log, stderr=subprocess.STDOUT, env=environment, cwd=job.folder
        )
