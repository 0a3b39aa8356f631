"""The lines of the report: one question each, its verdict and what to do about it."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import Any

PASS, FAIL, NOT_APPLICABLE = "pass", "FAIL", "does not apply"


@dataclass(frozen=True)
class Line:
    """measured, expected: for people. remedy: what to do if the line fails or does not apply. figures: for programs."""

    part: str
    name: str
    verdict: str
    measured: str
    expected: str
    remedy: str
    figures: dict[str, Any] = field(default_factory=dict)

    def to_json(self) -> dict[str, Any]:
        return asdict(self)


def judged(
    part: str, name: str, passes: bool, measured: str, expected: str, remedy: str, **figures: Any
) -> Line:
    """A line that passes or fails."""
    return Line(part, name, PASS if passes else FAIL, measured, expected, remedy, figures)


def inapplicable(part: str, name: str, why: str, remedy: str) -> Line:
    return Line(part, name, NOT_APPLICABLE, why, "-", remedy)
