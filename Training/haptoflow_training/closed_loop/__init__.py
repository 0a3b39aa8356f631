"""Rendering on the network's own output, and the level errors of each label that are measured this way."""
