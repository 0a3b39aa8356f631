"""Fits a new material to seconds of recording; the model file stays unchanged."""
