"""All parameters of the preprocessing; a store keeps those it was made with."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import Any

from haptoflow_training.errors import InputError


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

    def __post_init__(self) -> None:
        def expect(holds: bool, key: str, expected: str) -> None:
            if not holds:
                raise InputError(
                    f"preprocessing setting '{key}' is {getattr(self, key)}: expected {expected}"
                )

        expect(self.trim_seconds >= 0, "trim_seconds", "0 or more seconds")
        expect(self.sample_rate_hz >= 1000, "sample_rate_hz", "1000 or more")
        expect(
            self.high_rate_hz % self.sample_rate_hz == 0 and self.high_rate_hz >= 2 * self.sample_rate_hz,
            "high_rate_hz",
            f"a whole multiple of sample_rate_hz ({self.sample_rate_hz}), twice it at least",
        )
        expect(
            0 < self.low_pass_hz < self.high_rate_hz / 2, "low_pass_hz", "between 0 and half of high_rate_hz"
        )
        expect(0 < self.high_pass_hz < self.low_pass_hz, "high_pass_hz", "between 0 and low_pass_hz")
        frame_samples = round(self.dft321_frame_seconds * self.high_rate_hz)
        expect(frame_samples >= 4, "dft321_frame_seconds", "4 samples of high_rate_hz at least")
        expect(self.velocity_window_seconds > 0, "velocity_window_seconds", "more than 0 seconds")
        expect(
            0 < self.force_low_pass_hz < self.sample_rate_hz / 2, "force_low_pass_hz", "below half the rate"
        )
        expect(self.longest_gap_seconds > 0, "longest_gap_seconds", "more than 0 seconds")
        expect(self.segment_samples > 0, "segment_samples", "1 or more")
        expect(0 <= self.padding_probability <= 1, "padding_probability", "0 to 1")
        expect(self.padding_segments_max >= 1, "padding_segments_max", "1 or more")
        expect(self.padding_fade_seconds >= 0, "padding_fade_seconds", "0 or more seconds")
        expect(0 < self.train_share <= 1, "train_share", "more than 0, 1 at most")
        expect(
            0 <= self.validation_share <= 1 - self.train_share + 1e-9,
            "validation_share",
            "at most 1 - train_share",
        )

    def to_json(self) -> dict[str, Any]:
        values = dataclasses.asdict(self).items()
        return {key: list(value) if isinstance(value, tuple) else value for key, value in values}

    @classmethod
    def from_json(cls, values: dict[str, Any]) -> PreprocessingSettings:
        known = {field.name for field in dataclasses.fields(cls)}
        unknown = sorted(set(values) - known)
        if unknown:
            raise InputError(
                f"unknown preprocessing setting '{unknown[0]}': expected one of {', '.join(sorted(known))}"
            )
        return cls(
            **{key: tuple(value) if isinstance(value, list) else value for key, value in values.items()}
        )
