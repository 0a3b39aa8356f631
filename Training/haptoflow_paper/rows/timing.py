"""The time of a segment: one at a time through the engine, every row in the same run, in random order.

Two paces: hot (one after the other) and live (one every 1/72 s, with the caches of a machine that does other work in
between). Times about double at the live pace, which is the one that matters in use.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from haptoflow_training.closed_loop.render import SegmentSource
from haptoflow_training.models.surface_waves import PHASES

_WARM_UP_RUNS = 20


@dataclass(frozen=True)
class TimedSource:
    name: str
    source: SegmentSource


@dataclass(frozen=True)
class Milliseconds:
    p50: float
    p99: float


def _once(source: SegmentSource, generator: np.random.Generator) -> float:
    embedding = generator.standard_normal((1, 64)).astype(np.float32)
    previous = generator.standard_normal((1, 200)).astype(np.float32)
    noise = generator.standard_normal((1, 200)).astype(np.float32)
    motion = np.array([[0.1 + 0.4 * generator.random(), 0.0, 1.0]], dtype=np.float32)
    phases = generator.random((1, PHASES)).astype(np.float32)
    begin = time.perf_counter()
    source.generate(embedding, motion, previous, noise, phases)
    return 1e3 * (time.perf_counter() - begin)


def time_sources(
    sources: Sequence[TimedSource],
    *,
    blocks: int,
    runs_per_block: int,
    period_seconds: float,
    seed: int,
    advance: Callable[[int], None] = lambda count: None,
) -> dict[str, Milliseconds]:
    """p50 and p99 of each source; period_seconds 0 for hot, else the time from one segment's start to the next.

    Blocks of all sources are shuffled together, so that a disturbance of the machine affects all of them.
    """
    generator = np.random.default_rng(seed)
    times: dict[str, list[float]] = {entry.name: [] for entry in sources}
    order = np.repeat(np.arange(len(sources)), blocks)
    generator.shuffle(order)
    for index in order:
        entry = sources[index]
        for _ in range(3 if period_seconds else _WARM_UP_RUNS):
            _once(entry.source, generator)
        due = time.perf_counter()
        for _ in range(runs_per_block):
            if period_seconds:
                due += period_seconds
                time.sleep(max(0.0, due - time.perf_counter()))
            times[entry.name].append(_once(entry.source, generator))
        advance(1)
    return {
        name: Milliseconds(float(np.quantile(values, 0.5)), float(np.quantile(values, 0.99)))
        for name, values in times.items()
    }
