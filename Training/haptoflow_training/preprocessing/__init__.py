"""Preprocessing: from recordings to 2 kHz training arrays, one axis of vibration with the motion that caused it."""
