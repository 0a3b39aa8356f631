"""Runs of rivals, latents, other recipes and ablations: what they add to configuration, networks, losses and export."""
