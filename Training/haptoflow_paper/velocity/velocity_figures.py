"""How far an estimated velocity is from the true one."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from haptoflow_paper.velocity.velocity_cases import VelocityCase
from haptoflow_paper.velocity.velocity_estimators import Array

# A ratio of speeds says nothing at rest.
_MOVING_MPS = 0.02
_SLOWEST_MPS = 0.001


@dataclass
class VelocityErrors:
    """Errors of one estimator over cases of one kind, rate and noise."""

    _decibels: list[Array] = field(default_factory=list)
    _vectors_mps: list[Array] = field(default_factory=list)
    _speeds_mps: list[Array] = field(default_factory=list)
    _biases_mps: list[Array] = field(default_factory=list)
    _intervals: list[float] = field(default_factory=list)

    def add(self, case: VelocityCase, velocity_mps: Array, known: NDArray[np.bool_]) -> None:
        """velocity_mps: [n, 2] along the table. known: [n], false where the estimator gave none."""
        counted = case.counted & known
        true, speed = np.linalg.norm(case.velocity_mps, axis=1), np.linalg.norm(velocity_mps, axis=1)
        moving = counted & (true >= _MOVING_MPS)
        self._decibels.append(20.0 * np.log10(np.maximum(speed[moving], _SLOWEST_MPS) / true[moving]))
        self._vectors_mps.append(np.linalg.norm(velocity_mps - case.velocity_mps, axis=1)[counted])
        self._speeds_mps.append(speed[counted])
        self._biases_mps.append((speed - true)[counted])
        for moment, before, after in case.steps:
            half = (before + after) / 2.0
            follows = (case.times_s >= moment) & known & ((speed >= half) if after > before else (speed <= half))
            if follows.any():
                self._intervals.append(float(case.times_s[follows.argmax()] - moment) * case.rate_hz)

    def figures(self) -> dict[str, float]:
        """Speed error in dB over moving samples (RMS), vector error, speed and bias of speed in mm/s, and time to the
        half of a step in pose intervals (mean, 95th percentile); those that there are."""
        found = {
            "speed_error_db": _rms(self._decibels),
            "vector_error_mmps": 1000.0 * _rms(self._vectors_mps),
            "speed_mmps": 1000.0 * _rms(self._speeds_mps),
            "bias_mmps": 1000.0 * _mean(self._biases_mps),
        }
        if self._intervals:
            found["half_intervals"] = float(np.mean(self._intervals))
            found["half_intervals_p95"] = float(np.quantile(self._intervals, 0.95))
        return {name: round(value, 3) for name, value in found.items() if np.isfinite(value)}


def pooled_rms(values: Iterable[float]) -> float:
    """The root of the mean of squares."""
    return float(np.sqrt(np.mean(np.square(list(values)))))


def _rms(parts: Sequence[Array]) -> float:
    everything = np.concatenate(parts)
    return float(np.sqrt(np.mean(everything**2))) if len(everything) else float("nan")


def _mean(parts: Sequence[Array]) -> float:
    everything = np.concatenate(parts)
    return float(everything.mean()) if len(everything) else float("nan")
