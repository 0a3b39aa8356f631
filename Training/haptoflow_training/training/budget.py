"""A run's time on one core, shared out among its phases: whoever takes longer for a step makes fewer of them."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence


class Budget:
    """What each phase may take of a clock's time, in seconds, and what it has taken.

    clock: by default this process's computing time, so that what other programs take of the machine is not this run's;
    time.monotonic for a run that somebody waits for.
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
        """`seconds` for phases of these steps. Those that are `kept` get the time that their steps take, as long as that
        is half of all at most; the others share what is left, each lengthened or shortened by the same factor."""
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
        """Of all phases."""
        return sum(max(0.0, all_of_it - used) for all_of_it, used in zip(self.allotted_seconds, self.used_seconds, strict=True))

    def start(self) -> None:
        """Leave out of account what the process has done until now."""
        self._last = self._clock()

    def spend(self, phase: int) -> None:
        """Put to the account of `phase` what the process has done since the last call."""
        now = self._clock()
        self.used_seconds[phase] += now - self._last
        self._last = now

    def steps(self, phase: int, done: int) -> int:
        """Steps of the whole phase, as far as can be told after `done` of them: done / steps is the share of its time
        that is over. At least one; no more than `done` once the time is used."""
        used, allotted = self.used_seconds[phase], self.allotted_seconds[phase]
        if used >= allotted:
            return max(1, done)
        return max(done + 1, round(done * allotted / used)) if done and used > 0.0 else done + 1
