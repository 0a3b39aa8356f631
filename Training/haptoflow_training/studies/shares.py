"""Shares of simulated studies, with their confidence intervals."""

from __future__ import annotations

from dataclasses import dataclass

from scipy import stats


@dataclass(frozen=True)
class Share:
    """low, high: Wilson's interval of 95 % for the underlying rate."""

    count: int
    of: int
    low: float
    high: float

    @property
    def rate(self) -> float:
        return self.count / self.of

    def covers(self, rate: float) -> bool:
        return self.low <= rate <= self.high

    def as_json(self) -> dict[str, float]:
        return {"rate": round(self.rate, 4), "low": round(self.low, 4), "high": round(self.high, 4), "of": self.of}

    def __str__(self) -> str:
        return f"{100 * self.rate:.1f} % ({100 * self.low:.1f}-{100 * self.high:.1f})"


def share(count: int, of: int) -> Share:
    """The share of `count` among `of` studies; of: at least 1."""
    interval = stats.binomtest(count, of).proportion_ci(0.95, method="wilson")
    return Share(count, of, float(interval.low), float(interval.high))
