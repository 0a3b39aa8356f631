"""All parameters of the preprocessing; a store names those it was made with."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class PreprocessingSettings:
    """As in the published system; both protocols use the same."""

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


SETTINGS = PreprocessingSettings()
