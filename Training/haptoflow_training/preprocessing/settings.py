"""All parameters of the preprocessing; a store keeps those it was made with."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class PreprocessingSettings:
    """The defaults follow the published system; both protocols use the same settings."""

    trim_seconds: float = 0.3
    high_rate_hz: int = 8000
    sample_rate_hz: int = 2000
    high_pass_hz: float = 10.0
    low_pass_hz: float = 1000.0
    dft321_frame_seconds: float = 0.035
    velocity_window_seconds: float = 0.09
    force_low_pass_hz: float = 50.0
    longest_gap_seconds: float = 0.005
    segment_samples: int = 200
    padding_probability: float = 0.3
    padding_segments_max: int = 3
    padding_fade_seconds: float = 0.010
    train_share: float = 0.7
    validation_share: float = 0.1
    held_out_directions: tuple[int, ...] = ()
    held_out_speeds_mmps: tuple[int, ...] = ()

    def to_json(self) -> dict[str, Any]:
        values = dataclasses.asdict(self).items()
        return {key: list(value) if isinstance(value, tuple) else value for key, value in values}

    @classmethod
    def from_json(cls, values: dict[str, Any]) -> PreprocessingSettings:
        return cls(**{key: tuple(value) if isinstance(value, list) else value for key, value in values.items()})
