"""A run's time on one core, divided among its phases: the slower a network's steps, the fewer it takes."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence


class Budget:
    """The time that each phase may take and has taken, in seconds of a clock.

    clock: by default this process's computing time, which excludes what other programs take; time.monotonic for a run
    with a limit by the wall clock.
    """

    def __init__(
        self,
        allotted_seconds: Sequence[float],
        used_seconds: Sequence[float] = (),
        clock: Callable[[], float] = time.process_time,
    ) -> None:
        self._clock = clock
        self.allotted_seconds = list(allotted_seconds)
        self.used_seconds = list(used_seconds) or [0.0] * len(self.allotted_seconds)
        self._last = clock()

    @classmethod
    def shared_out(
        cls,
        seconds: float,
        steps: Sequence[int],
        seconds_per_step: Sequence[float],
        *,
        kept: Sequence[bool],
        clock: Callable[[], float] = time.process_time,
    ) -> Budget:
        """Divide `seconds` among phases of these numbers of steps. Phases that are `kept` get the time their steps
        take, up to half of everything; the others share the rest, each lengthened or shortened by the same factor."""
        wanted = [count * each for count, each in zip(steps, seconds_per_step, strict=True)]
        fixed = sum(part for part, is_kept in zip(wanted, kept, strict=True) if is_kept)
        scaled = sum(wanted) - fixed
        if not scaled:
            return cls([seconds * part / fixed for part in wanted], clock=clock)
        share = min(1.0, 0.5 * seconds / fixed) if fixed else 1.0
        rest = (seconds - share * fixed) / scaled
        allotted = [part * (share if is_kept else rest) for part, is_kept in zip(wanted, kept, strict=True)]
        return cls(allotted, clock=clock)

    @property
    def left_seconds(self) -> float:
        """The time left of all phases."""
        phases = zip(self.allotted_seconds, self.used_seconds, strict=True)
        return sum(max(0.0, allotted - used) for allotted, used in phases)

    def start(self) -> None:
        """Start counting now; earlier computing time of the process is not charged."""
        self._last = self._clock()

    def spend(self, phase: int) -> None:
        """Charge the time since the last call to `phase`."""
        now = self._clock()
        self.used_seconds[phase] += now - self._last
        self._last = now

    def steps(self, phase: int, done: int) -> int:
        """The estimated steps of the whole phase after `done` of them: done / steps is the share of its time that
        has passed. At least one; no more than `done` once the time is used up."""
        used, allotted = self.used_seconds[phase], self.allotted_seconds[phase]
        if used >= allotted:
            return max(1, done)
        return max(done + 1, round(done * allotted / used)) if done and used > 0.0 else done + 1
