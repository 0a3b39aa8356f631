"""Recordings of a tool on a surface: published, synthetic, and prepared for training."""
