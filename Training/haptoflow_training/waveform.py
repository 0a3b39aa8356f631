"""The waveform that every network and model file works on (model-format.md)."""

from __future__ import annotations

SAMPLE_RATE_HZ = 2000
SEGMENT_SAMPLES = 200
"""Samples of a segment, 100 ms."""
