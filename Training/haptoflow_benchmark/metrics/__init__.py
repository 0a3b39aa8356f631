"""Measures of a generated waveform beside a recorded one."""
