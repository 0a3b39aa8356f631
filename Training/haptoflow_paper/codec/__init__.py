"""Waveform codecs whose latents the velocity field can work on instead of samples."""
