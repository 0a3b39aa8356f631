"""Trains what ships on the output of a flow model: the same materials, for a small part of its time."""
