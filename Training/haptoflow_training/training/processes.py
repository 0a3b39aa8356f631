"""One or several training processes, according to torchrun's environment (start with `torchrun --redirects 1 --tee
1`)."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import torch
from torch import distributed

from haptoflow_training.errors import InputError

@dataclass(frozen=True)
class Processes:
    """rank 0 writes files and prints; `count` processes share each batch."""

    rank: int
    count: int

    @property
    def is_first(self) -> bool:
        return self.rank == 0

    def mean(self, value: torch.Tensor) -> torch.Tensor:
        """The mean of a scalar over all processes."""
        if self.count == 1:
            return value
        total = value.detach().clone()
        distributed.all_reduce(total)
        return total / self.count

    def any(self, *flags: bool) -> tuple[bool, ...]:
        """Each flag, true if it is true in any process."""
        if self.count == 1:
            return flags
        raised = torch.tensor(flags, dtype=torch.int32)
        distributed.all_reduce(raised, op=distributed.ReduceOp.MAX)
        return tuple(bool(flag) for flag in raised)

    def wait(self) -> None:
        """Wait until every process has reached this call."""
        if self.count > 1:
            distributed.barrier()


@contextmanager
def join_processes() -> Iterator[Processes]:
    """Join the process group of torchrun's environment; without one, a single process."""
    count = int(os.environ.get("WORLD_SIZE", "1"))
    if count == 1:
        yield Processes(rank=0, count=1)
        return
    distributed.init_process_group("gloo")
    try:
        yield Processes(rank=distributed.get_rank(), count=distributed.get_world_size())
    finally:
        distributed.destroy_process_group()


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
