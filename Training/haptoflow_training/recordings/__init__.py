"""Readers of recordings (published, own, synthetic) of a tool on a surface."""
